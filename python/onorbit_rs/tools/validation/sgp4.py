"""Tests SGP4 on the element sets of its verification report, in km, km/s and minutes as published."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Any, Final, NamedTuple

import numpy as np

import onorbit_rs as oo
from onorbit_rs.exceptions import Sgp4Error
from onorbit_rs.tools.validation.case import Case, Gate, table, worst

SOURCE = "Vallado and others, Revisiting Spacetrack Report 3, AIAA 2006-6753"
GRAVITY: Final = "wgs72"
CODES = [1, 1, 6, 6, 4, 3, 6]
"""Error codes of the sets that end with an error, in file order (from python-sgp4's tests)."""


class ElementSet(NamedTuple):
    """Element set of the report: two lines, times (start, stop and step, min), and rows of the output."""

    regime: str
    span: tuple[float, float, float]
    line1: str
    line2: str
    rows: list[list[float]]

    def orbit(self) -> oo.Sgp4:
        """Return the orbit; the checksums of sets that SGP4 refuses are wrong, and therefore ignored."""
        is_sound = self.regime != "refused"
        return oo.Sgp4(self.line1, self.line2, gravity=GRAVITY, check_checksum=is_sound)


def sets() -> list[ElementSet]:
    """Return all 33 sets of the report with their first, middle and last rows; refused sets have no rows."""
    rows: dict[int, list[list[float]]] = {}
    for row in table("sgp4_states"):
        number, *values = row.values()
        rows.setdefault(int(number), []).append([float(value) for value in values])
    return [
        ElementSet(
            row["regime"], (float(row["start_min"]), float(row["stop_min"]), float(row["step_min"])),
            row["line1"], row["line2"], rows.get(index, []),
        )
        for index, row in enumerate(table("sgp4_sets"))
    ]  # fmt: skip


def off(elements: ElementSet, rows: Any) -> tuple[float, float]:
    """Return the largest components of the error, km and km/s, at the given rows (min, km, km/s)."""
    r, v = elements.orbit().state(60.0 * rows[:, 0])
    return np.abs(r / 1e3 - rows[:, 1:4]).max(), np.abs(v / 1e3 - rows[:, 4:]).max()


def of_regime(regime: str) -> Any:
    """Return the largest components of the error over the sets of a regime, km and km/s."""
    return worst(off(elements, np.array(elements.rows)) for elements in sets() if elements.regime == regime)


def codes() -> Iterator[int]:
    """Yield the error codes of the sets that end with an error."""
    for elements in sets():
        start, stop, step = elements.span
        try:
            orbit = elements.orbit()
            orbit.state(0.0)
            for minutes in np.arange(start, stop + step, step):
                orbit.state(60.0 * min(minutes, stop))
        except Sgp4Error as error:
            yield error.code


def wrong_codes() -> tuple[float]:
    """Return the number of error codes that are wrong or missing."""
    found = list(codes())
    wrong = sum(a != b for a, b in zip(found, CODES, strict=False))
    return (float(wrong + abs(len(found) - len(CODES))),)


REGIMES = {
    "near Earth": "5 sets near the Earth",
    "low perigee and decay": "4 sets of decaying orbits with a low perigee",
    "half a day": "6 sets with a period of half a day",
    "a day": "7 sets with a period of a day",
    "deep space": "8 other sets in deep space",
}

CASES = (
    *(
        Case(
            "sgp4", f"{name}, three rows each", SOURCE,
            (Gate("position", 2e-7, "km"), Gate("velocity", 2e-7, "km/s")), partial(of_regime, regime),
        )
        for regime, name in REGIMES.items()
    ),
    Case(
        "sgp4", "33 sets: error codes", f"{SOURCE}; brandon-rhodes/python-sgp4, tests",
        (Gate("wrong error codes", 0.0),), wrong_codes,
    ),
)  # fmt: skip
