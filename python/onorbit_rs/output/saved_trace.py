"""Columns of a trace that was saved, and whether their shapes fit each other."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np


@dataclass(frozen=True)
class SavedTrace:
    """Columns under their names, as a :class:`onorbit_rs.Trace` has them."""

    arrays: Mapping[str, Any]

    def __getattr__(self, name: str) -> Any:
        """A column; None where the run had nothing for it."""
        if name in _COLUMNS:
            return self.arrays.get(name)
        if name.startswith("__") or name == "arrays" or name not in self.arrays:
            raise AttributeError(f"the trace has no column {name!r}")
        return self.arrays[name]

    def columns(self) -> list[str]:
        """Names of the columns."""
        return [name for name in self.arrays if not name.startswith(("tracking_", "wrench_", "rereferenced"))]

    @property
    def tracking(self) -> dict[str, Any]:
        """Errors of each controller."""
        return self._named("tracking_")

    @property
    def wrenches(self) -> dict[str, Any]:
        """(T, bodies, 6) of each effect."""
        return self._named("wrench_")

    def _named(self, kind: str) -> dict[str, Any]:
        return {name.removeprefix(kind): rows for name, rows in self.arrays.items() if name.startswith(kind)}


def check_shapes(arrays: Mapping[str, Any]) -> None:
    """Every column has a row per instant, and is as wide as the robot: (7 + n) and (6 + n) for n joints."""
    rows, n = np.shape(arrays["time"]), max((np.shape(arrays["q"]) or (7,))[-1] - 7, 0)
    if len(rows) != 1 or rows[0] == 0:
        raise ValueError(f"column 'time' has shape {rows}, expected (T,) with a row at least")
    widths = {name: width for name, width in _widths(n).items() if name in arrays}
    for name, values in arrays.items():
        if name.startswith("rereferenced"):
            continue
        shape, expected = np.shape(values), (*rows, *widths.get(name, np.shape(values)[1:]))
        if shape != expected:
            raise ValueError(f"column {name!r} has shape {shape}, expected {expected}")


def _widths(n: int) -> dict[str, tuple[int, ...]]:
    """Shapes of a row of the columns, for ``n`` joints."""
    three, six, pose = (3,), (6,), (4, 4)
    return {
        "q": (7 + n,), "v": (6 + n,), "acceleration": (6 + n,), "tau": (n,), "momentum": six,
        "friction_compensation": (n,), "impulse": six,
        "kinetic_energy": (), "work": (), "dissipated": (), "center_of_mass": three,
        "tool_pose": pose, "reference_pose": pose, "position_error": three, "attitude_error": three,
        "position_eci": three, "velocity_eci": three, "reference_residual": three,
    }  # fmt: skip


_COLUMNS = ("time", *_widths(0))
