"""Comparison of two runs of one robot: differences of its quantities over time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.common.coordinates import BASE_NQ
from onorbit_rs.common.counting import count
from onorbit_rs.common.printable import json_value
from onorbit_rs.exceptions import CompareError, OnOrbitError
from onorbit_rs.tools.comparison.alignment import aligned_rows
from onorbit_rs.tools.comparison.quantities import differences_in_quantities
from onorbit_rs.tools.comparison.text import as_text
from onorbit_rs.tools.comparison.verdict import Verdict, entry

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs.tools.comparison.recorded import Recorded

    Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Difference:
    """Difference between two runs in one quantity: ``values`` (T,) in ``unit``, at the compared instants."""

    name: str
    unit: str
    values: Floats
    largest: float
    largest_at: float
    """Time of the largest difference, s."""
    final: float
    allowed: float
    """Allowed difference: the tolerance times the scale (at least 1).

    The scale is the largest finite value of both runs; 0 for attitudes; for inertial positions, the largest
    distance from the reference. For inertial positions, the error of rounding and interpolation is added.
    """
    parts_at: float | None
    """First time at which the difference exceeds ``allowed``, s; None if this never happens."""


@dataclass(frozen=True)
class Comparison(Verdict):
    """Differences between run ``b`` and run ``a``."""

    time: Floats
    """Instants at which the runs are compared, (T,), s."""
    differences: tuple[Difference, ...]
    notes: tuple[str, ...]
    """Notes on differing robots and settings, on the openings of loops, on interpolated rows, and on
    quantities not compared.
    """

    @property
    def parts_at(self) -> float | None:
        """First time at which a quantity exceeds its tolerance, s; None if the runs agree."""
        return min((d.parts_at for d in self.differences if d.parts_at is not None), default=None)

    def __getitem__(self, name: str) -> Difference:
        """Return the difference in a quantity; raise CompareError for one that was not compared."""
        return entry({one.name: one for one in self.differences}, name, "compared quantity")

    def __str__(self) -> str:
        """Return the text that ``onorbit compare`` prints."""
        return as_text(self)

    def as_dict(self) -> dict[str, Any]:
        """Return plain data without the rows, as printed by ``onorbit compare --json``."""
        names = ("name", "unit", "largest", "largest_at", "final", "allowed", "parts_at")
        measured = [
            {name: json_value(getattr(difference, name)) for name in names} for difference in self.differences
        ]
        return super().as_dict() | {
            "rows": len(self.time),
            "start": float(self.time[0]),
            "end": float(self.time[-1]),
            "differences": measured,
            "notes": list(self.notes),
        }


def compared_robots(a: Recorded, b: Recorded, tolerance: float, settings: Sequence[str] = ()) -> Comparison:
    """Compare two runs of one robot row by row; ``settings`` are notes about differing settings.

    Raises
    ------
    CompareError
        If the robots' joints differ in number, name or order, or the runs do not overlap in time.
    """
    notes = [*_same_robot(a, b), *settings, *_openings(a, b)]
    rows_a, rows_b, time, remarks = aligned_rows(a, b)
    found, missing = differences_in_quantities(rows_a, rows_b)
    differences = tuple(
        _difference(name, unit, values, tolerance * max(1.0, scale) + error, time)
        for name, unit, values, scale, error in found
    )
    return Comparison(a.name, b.name, tolerance, time, differences, (*notes, *remarks, *missing))


def _difference(name: str, unit: str, values: Floats, allowed: float, time: Floats) -> Difference:
    beyond = np.flatnonzero(~(np.isfinite(values) & (values <= allowed)))
    worst = int(np.argmax(np.where(np.isnan(values), np.inf, values)))
    parts_at = float(time[beyond[0]]) if beyond.size else None
    return Difference(
        name, unit, values, float(values[worst]), float(time[worst]), float(values[-1]), allowed, parts_at
    )


def _openings(a: Recorded, b: Recorded) -> list[str]:
    """Return a note on the largest opening of loops and mimic joints in each run; empty without any."""
    found = [f"{run.opening:.1e} in {run.name}" for run in (a, b) if run.opening is not None]
    return [f"largest opening of loops and mimic joints, m or rad: {', '.join(found)}"] if found else []


def _same_robot(a: Recorded, b: Recorded) -> list[str]:
    """Raise CompareError if the robots' joints differ; return notes about other differences."""
    if a.columns["q"].shape[1] != b.columns["q"].shape[1]:
        joints = [run.columns["q"].shape[1] - BASE_NQ for run in (a, b)]
        raise CompareError(
            f"the robot of {a.name} has {count(joints[0], 'joint', 'joints')}, but that of {b.name} has "
            f"{joints[1]}; only runs of the same robot can be compared",
            name="robot", got=joints[1], expected=joints[0],
        )  # fmt: skip
    prints = a.fingerprint, b.fingerprint
    if prints[0] == prints[1] if None not in prints else a.robot == b.robot:
        return []
    if a.robot == b.robot:
        notes = [f"the robot {a.robot} was changed between the two runs ({prints[0]} and {prints[1]})"]
    else:
        notes = [f"the robots differ: {a.robot} and {b.robot}"]
    try:
        names = a.joint_names(), b.joint_names()
    except OnOrbitError as error:  # the robot's file is missing, but the rows can be compared
        return [*notes, f"cannot check whether the joints of both robots are equal: {error}"]
    if names[0] != names[1]:
        joints_a, joints_b = map(", ".join, names)
        raise CompareError(
            f"the names of the joints differ: {joints_a} in {a.name}, and {joints_b} in {b.name}; only runs "
            "of the same robot can be compared",
            name="robot", got=names[1], expected=names[0],
        )  # fmt: skip
    return notes
