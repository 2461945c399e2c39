"""SGP4 against the tables of AIAA 2006-6753 and PyPI's `sgp4`, whose wheel carries the same files."""

from __future__ import annotations

from collections.abc import Iterator
from importlib import resources
from typing import NamedTuple

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.exceptions import Sgp4Error

sgp4_api = pytest.importorskip("sgp4.api", reason="PyPI's sgp4 is in the test extra")

TOLERANCE = 2e-7  # km and km/s: python-sgp4's own; the tables are printed to 1e-8 km and 1e-9 km/s
WRONG_CHECKSUMS = ("33333", "33334", "33335")


class Case(NamedTuple):
    """An element set and its rows (minutes, km, km/s) in the published table."""

    line1: str
    line2: str
    rows: np.ndarray

    @property
    def satellite(self) -> str:
        return self.line1[2:7]

    def orbit(self) -> oo.Sgp4:
        return oo.Sgp4(self.line1, self.line2, check_checksum=self.satellite not in WRONG_CHECKSUMS)


def cases() -> Iterator[Case]:
    folder = resources.files("sgp4")
    lines = [line for line in (folder / "SGP4-VER.TLE").read_text().splitlines() if line[:1] in ("1", "2")]
    blocks: list[list[list[float]]] = []
    for line in (folder / "tcppver.out").read_text().splitlines():
        if line.endswith("xx"):
            blocks.append([])
        else:
            blocks[-1].append([float(number) for number in line.split()[:7]])
    assert len(blocks) == 33 and len(lines) == 66
    for line1, line2, rows in zip(lines[::2], lines[1::2], blocks, strict=True):
        yield Case(line1[:69], line2[:69], np.array(rows))


CASES = list(cases())
NAMES = [f"{case.satellite}-{index}" for index, case in enumerate(CASES)]


@pytest.mark.parametrize("case", CASES, ids=NAMES)
def test_every_row_of_the_published_table(case: Case) -> None:
    orbit = case.orbit()
    r, v = orbit.state(60.0 * case.rows[:, 0])
    assert np.abs(r / 1e3 - case.rows[:, 1:4]).max() < TOLERANCE
    assert np.abs(v / 1e3 - case.rows[:, 4:7]).max() < TOLERANCE


@pytest.mark.parametrize("case", CASES, ids=NAMES)
def test_states_and_errors_minute_by_minute(case: Case) -> None:
    peer, orbit = sgp4_api.Satrec.twoline2rv(case.line1, case.line2), case.orbit()
    last = case.rows[-1, 0]
    for minutes in np.linspace(-last, last + 200.0, 400):
        code, r, v = peer.sgp4_tsince(minutes)
        try:
            got_r, got_v = orbit.state(60.0 * minutes)
        except Sgp4Error as error:
            assert error.code == code, f"at {minutes} min: {error}"
            assert error.time == 60.0 * minutes
            continue
        assert code == 0, f"at {minutes} min: the reference gives error {code}"
        assert np.abs(got_r / 1e3 - r).max() < TOLERANCE and np.abs(got_v / 1e3 - v).max() < TOLERANCE
