"""Quantities compared between two runs, each reduced to one number per instant."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs._core import COLUMNS
from onorbit_rs.common.coordinates import POSITION
from onorbit_rs.common.rotations import angle_between

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Rows = dict[str, Floats]

Pick = Callable[["Rows"], "Floats"]

Quantity = tuple[str, str, str, Pick]
"""Name, unit, required column, and the function that selects the compared entries."""


def _column(name: str, column: str, part: str | None = None) -> Quantity:
    """Return the quantity stored in a column of the trace or in a part of it."""
    if part is None:
        return name, COLUMNS[column].unit, column, lambda rows: rows[column].reshape(len(rows[column]), -1)
    entries, unit = COLUMNS[column].parts[part]
    return name, unit, column, lambda rows: rows[column][:, entries]


def _pose(name: str, column: str, unit: str) -> Quantity:
    return name, unit, column, lambda rows: rows[column]


# the difference between two attitudes is the angle between their quaternions
_QUANTITIES: tuple[Quantity, ...] = (
    _column("base position", "q", "position"),
    _pose("base attitude", "base_quat", "rad"),
    _column("inertial position", "position_eci"),
    _column("joints", "q", "joints"),
    _column("joint rates", "v", "joints"),
    _column("joint torques", "tau"),
    _pose("tool position", "tool_position", "m"),
    _pose("tool attitude", "tool_quat", "rad"),
    _column("linear momentum", "momentum", "linear"),
    _column("angular momentum", "momentum", "angular"),
    _column("kinetic energy", "kinetic_energy"),
)
_BY_ENTRY = ("joints", "joint rates", "joint torques")
"""Quantities whose difference is the largest entry over the joints instead of the norm of the vector."""
_ROUNDING = 64.0 * np.finfo(np.float64).eps
"""Rounding error of an inertial position, relative to the distance from the planet: 0.1 µm in low orbit."""


def differences_in_quantities(
    a: Rows, b: Rows
) -> tuple[list[tuple[str, str, Floats, float, float]], list[str]]:
    """Return the name, unit, difference (T,), scale and error of each quantity, and notes on missing ones.

    The scale is the largest value, and 0 for attitudes, whose differences are angles; for inertial positions
    it is the robot's largest distance from its reference, because the much larger orbital radius would hide
    differences. The error is that of rounding and interpolation for inertial positions, otherwise 0.
    """
    found, missing = [], []
    for name, unit, column, pick in _QUANTITIES:
        if (column in a) != (column in b):
            missing.append(f"{name}: recorded in only one of the two runs")
        if column not in a or column not in b:
            continue
        first, second = pick(a), pick(b)
        if first.shape[1] == 0:
            continue
        values, largest = _measured(name, column, first, second)
        if column != "position_eci":
            found.append((name, unit, values, largest, 0.0))
            continue
        _, drift = _measured("base position", "q", a["q"][:, POSITION], b["q"][:, POSITION])
        found.append(
            (name, unit, values, drift, _ROUNDING * largest + b.get("hermite_error", np.zeros(1)).max())
        )
    return found, missing


def _measured(name: str, column: str, first: Floats, second: Floats) -> tuple[Floats, float]:
    if column.endswith("quat"):
        return angle_between(first, second), 0.0  # angles are compared absolutely
    size = _largest_entry if name in _BY_ENTRY else _length
    with np.errstate(over="ignore", invalid="ignore"):  # diverged runs contain huge values
        sizes = np.concatenate([size(first), size(second)])
        # non-finite values exceed any tolerance and do not contribute to the scale
        return size(first - second), float(sizes.max(where=np.isfinite(sizes), initial=0.0))


def _length(rows: Floats) -> Floats:
    """Return the length of each row without overflow: `s |x / s|`, `s` a power of two."""
    _, exponent = np.frexp(np.abs(rows).max(axis=1))
    scale = np.ldexp(1.0, exponent - 1)  # scaling by a power of two is exact
    length: Floats = scale * np.linalg.norm(rows / scale[:, None], axis=1)
    return length


def _largest_entry(rows: Floats) -> Floats:
    largest: Floats = np.abs(rows).max(axis=1)
    return largest
