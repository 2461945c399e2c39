"""Compares SGP4 with the reference code, PyPI's ``sgp4``, in and beyond the time spans of published sets."""

from __future__ import annotations

from importlib import resources
from typing import TYPE_CHECKING, Any

import numpy as np
from sgp4.api import Satrec

from onorbit_rs.exceptions import Sgp4Error
from onorbit_rs.tools.validation.case import Case, Gate, worst
from onorbit_rs.tools.validation.sgp4 import SOURCE, ElementSet, off, sets

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

TIMES = 60


def compare(elements: ElementSet) -> tuple[float, float]:
    """Return the largest difference, km and km/s, and the number of differing error codes of a set."""
    peer, orbit = Satrec.twoline2rv(elements.line1, elements.line2), elements.orbit()
    stop = elements.rows[-1][0]
    found, disagreements = [], 0
    for seconds in 60.0 * np.linspace(-stop, stop + 200.0, TIMES):
        code, r, v = peer.sgp4_tsince(seconds / 60.0)
        try:
            ours = orbit.state(seconds)
        except Sgp4Error as error:
            disagreements += error.code != code
            continue
        disagreements += code != 0
        found.append(np.abs(np.array(ours) / 1e3 - (r, v)).max())
    return float(worst(found)), float(disagreements)


def published() -> list[tuple[str, Floats]]:
    """Return the satellite and rows (min, km, km/s) of each published set, from files of PyPI's ``sgp4``."""
    folder = resources.files("sgp4")
    lines = (folder / "SGP4-VER.TLE").read_text(encoding="utf-8").splitlines()
    blocks: list[list[list[float]]] = []
    for line in (folder / "tcppver.out").read_text(encoding="utf-8").splitlines():
        if line.endswith("xx"):
            blocks.append([])
        else:
            blocks[-1].append([float(number) for number in line.split()[:7]])
    satellites = [line[2:7] for line in lines if line.startswith("1 ")]
    return [(name, np.array(rows)) for name, rows in zip(satellites, blocks, strict=True)]


def every_row() -> Any:
    """Return the largest components of the error over all published rows, km and km/s."""
    pairs = zip(sets(), published(), strict=True)
    return worst(off(elements, rows) for elements, (_, rows) in pairs if elements.rows)


def all_sets() -> Any:
    """Return the largest difference, km and km/s, and the number of differing codes over all valid sets."""
    found = [compare(elements) for elements in sets() if elements.rows]
    return worst(difference for difference, _ in found), sum(number for _, number in found)


CASES = (
    Case(
        "engines", "SGP4: every published row of 30 sets", f"{SOURCE}, files in PyPI's sgp4",
        (Gate("position", 2e-7, "km"), Gate("velocity", 2e-7, "km/s")), every_row,
    ),
    Case(
        "engines", f"SGP4: 30 sets, {TIMES} times each", "PyPI's sgp4, the reference code",
        (Gate("position and velocity", 1e-8, "km, km/s"), Gate("error codes that differ", 0.0)),
        all_sets,
    ),
)  # fmt: skip
