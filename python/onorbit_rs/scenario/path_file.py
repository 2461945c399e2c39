"""Files that an orbit is read from: points of a path, element sets."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs.counting import count
from onorbit_rs.exceptions import ElementSetError
from onorbit_rs.satellites import select_set
from onorbit_rs.scenario.table import read_table

if TYPE_CHECKING:
    from numpy.typing import NDArray

GROUPS = {
    "times": ("t",),
    "positions": ("x", "y", "z"),
    "velocities": ("vx", "vy", "vz"),
    "accelerations": ("ax", "ay", "az"),
    "attitudes": ("qx", "qy", "qz", "qw"),
}
"""Columns of a file of points; SI."""


def two_lines(text: str, where: str, satellite: str | None = None) -> tuple[str, str]:
    """Return the two lines of the only TLE, or of that of ``satellite`` (name or catalogue number).

    A line with a name may precede them; comments (#) and blank lines are skipped.

    Raises
    ------
    ElementSetError
        If the text does not hold exactly one such TLE.
    """
    lines = [line for line in text.splitlines() if line.strip() and not line.startswith("#")]
    if satellite is not None:
        return select_set(_sets(lines), satellite, where)
    if len(lines) == 3:
        lines = lines[1:]
    if len(lines) != 2:
        found = count(len(lines), "line", "lines")
        raise ElementSetError(
            f"{where} holds {found}: give the two lines of one TLE, with a name before them or not,"
            " or select one of several by 'satellite': its name or catalogue number"
        )
    return lines[0], lines[1]


def _sets(lines: list[str]) -> Iterator[tuple[str, str, tuple[str, str]]]:
    """Yield the name (empty if missing), catalogue number and lines of every TLE."""
    name = ""
    for line, after in pairwise([*lines, ""]):
        if line.startswith("1 ") and after.startswith("2 "):
            yield name, line[2:7], (line, after)
        name = "" if line.startswith(("1 ", "2 ")) else line.removeprefix("0 ").strip()


def read_points(file: Path) -> dict[str, NDArray[np.float64]]:
    """Points of a path from a CSV file with a header, by the names of :class:`onorbit_rs.CustomPath`."""
    points = read_table(file, GROUPS, ("times", "positions"))
    return points | {"times": points["times"].ravel()}
