"""Measures of what two runs differ by, each in one number per instant."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs.rotations import angle_between

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Rows = dict[str, Floats]

Pick = Callable[["Rows"], "Floats"]

# name, unit, column it needs, what is compared of it; a quaternion's difference is its angle
_MEASURES: tuple[tuple[str, str, str, Pick], ...] = (
    ("base position", "m", "q", lambda rows: rows["q"][:, :3]),
    ("base attitude", "rad", "base_quat", lambda rows: rows["base_quat"]),
    ("inertial position", "m", "position_eci", lambda rows: rows["position_eci"]),
    ("joints", "rad, m", "q", lambda rows: rows["q"][:, 7:]),
    ("joint rates", "rad/s, m/s", "v", lambda rows: rows["v"][:, 6:]),
    ("joint torques", "N m, N", "tau", lambda rows: rows["tau"]),
    ("tool position", "m", "tool_position", lambda rows: rows["tool_position"]),
    ("tool attitude", "rad", "tool_quat", lambda rows: rows["tool_quat"]),
    ("linear momentum", "N s", "momentum", lambda rows: rows["momentum"][:, :3]),
    ("angular momentum", "N m s", "momentum", lambda rows: rows["momentum"][:, 3:]),
    ("kinetic energy", "J", "kinetic_energy", lambda rows: rows["kinetic_energy"][:, None]),
)
_BY_ENTRY = ("joints", "joint rates", "joint torques")
"""Measured by the joint that is furthest off, not by the length of a vector of joints."""
_ROUNDING = 64.0 * np.finfo(np.float64).eps
"""Of an inertial position, as a share of the distance from the planet: 0.1 µm in low orbit."""


def measures(a: Rows, b: Rows) -> tuple[list[tuple[str, str, Floats, float, float]], list[str]]:
    """Name, unit, difference (T,), scale and error of every measure that both have; and what one lacks.

    The scale is the largest value, but of inertial positions the robot's distance from its reference: seven
    thousand kilometres of orbit say nothing of how well two robots agree. The error is that of the rows.
    """
    found, missing = [], []
    for name, unit, column, pick in _MEASURES:
        if (column in a) != (column in b):
            missing.append(f"{name}: only one of the two has it")
        if column not in a or column not in b:
            continue
        first, second = pick(a), pick(b)
        if first.shape[1] == 0:
            continue
        values, largest = _measured(name, column, first, second)
        if column != "position_eci":
            found.append((name, unit, values, largest, 0.0))
            continue
        _, drift = _measured("base position", "q", a["q"][:, :3], b["q"][:, :3])
        found.append(
            (name, unit, values, drift, _ROUNDING * largest + b.get("bend_error", np.zeros(1)).max())
        )
    return found, missing


def _measured(name: str, column: str, first: Floats, second: Floats) -> tuple[Floats, float]:
    if column.endswith("quat"):
        return angle_between(first, second), 0.0  # no angle is larger than another
    size = _largest_entry if name in _BY_ENTRY else _length
    with np.errstate(over="ignore", invalid="ignore"):  # of runs that diverged
        sizes = np.concatenate([size(first), size(second)])
        # what is not finite is beyond any tolerance, and no scale for the others
        return size(first - second), float(sizes.max(where=np.isfinite(sizes), initial=0.0))


def _length(rows: Floats) -> Floats:
    """Of each row, also where squares are beyond the range of floats: `s |x / s|`, `s` a power of two."""
    _, exponent = np.frexp(np.abs(rows).max(axis=1))
    scale = np.ldexp(1.0, exponent - 1)  # exact: the digits stay as they are
    length: Floats = scale * np.linalg.norm(rows / scale[:, None], axis=1)
    return length


def _largest_entry(rows: Floats) -> Floats:
    largest: Floats = np.abs(rows).max(axis=1)
    return largest
