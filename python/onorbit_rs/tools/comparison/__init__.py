"""Compares two runs: how much they differ and when they diverge."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.common.coordinates import BASE_NQ
from onorbit_rs.common.counting import count
from onorbit_rs.common.numbers import finite_float
from onorbit_rs.common.printable import json_value
from onorbit_rs.exceptions import CompareError, InputError, OnOrbitError
from onorbit_rs.tools.comparison.alignment import aligned_rows
from onorbit_rs.tools.comparison.quantities import differences_in_quantities
from onorbit_rs.tools.comparison.recorded import Recorded, Source, on_the_other_engine, recorded
from onorbit_rs.tools.comparison.settings import differing_settings
from onorbit_rs.tools.comparison.text import as_text

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

TOLERANCE = 1e-6
"""Difference allowed, relative to the largest value or to 1 in the unit of the quantity."""


@dataclass(frozen=True)
class Difference:
    """Difference of two runs in one quantity; ``values`` (T,) at the compared instants, in ``unit``."""

    name: str
    unit: str
    values: Floats
    largest: float
    largest_at: float
    """Time of the largest difference, s."""
    final: float
    allowed: float
    """Difference allowed: the tolerance times the scale (at least 1), plus the error of interpolated rows.

    The scale is the largest finite value of both runs; for inertial positions, the largest distance from
    the reference.
    """
    parts_at: float | None
    """First time at which the difference exceeds ``allowed``, s; None if it never does."""


@dataclass(frozen=True)
class Comparison:
    """Differences of run ``b`` from run ``a``."""

    a: str
    b: str
    tolerance: float
    time: Floats
    """Instants at which the runs are compared, (T,), s."""
    differences: tuple[Difference, ...]
    notes: tuple[str, ...]
    """Differing robots and settings, how times were matched, and quantities that were not compared."""

    @property
    def agrees(self) -> bool:
        """True if no quantity exceeds the tolerance at any time."""
        return self.parts_at is None

    @property
    def parts_at(self) -> float | None:
        """First time at which a quantity exceeds its tolerance, s; None if the runs agree."""
        return min((d.parts_at for d in self.differences if d.parts_at is not None), default=None)

    def __getitem__(self, name: str) -> Difference:
        """Return the difference in the named quantity, such as ``base attitude``."""
        for difference in self.differences:
            if difference.name == name:
                return difference
        known = ", ".join(difference.name for difference in self.differences)
        raise CompareError(
            f"{name!r} is not a compared quantity; available: {known}", name=name, expected=known
        )

    def __str__(self) -> str:
        """Return the text that ``onorbit compare`` prints."""
        return as_text(self)

    def as_dict(self) -> dict[str, Any]:
        """Return plain data without the rows, as printed by ``onorbit compare --json``."""
        names = ("name", "unit", "largest", "largest_at", "final", "allowed", "parts_at")
        measured = [
            {name: json_value(getattr(difference, name)) for name in names} for difference in self.differences
        ]
        return {
            "a": self.a,
            "b": self.b,
            "tolerance": self.tolerance,
            "agrees": self.agrees,
            "parts_at": self.parts_at,
            "rows": len(self.time),
            "start": float(self.time[0]),
            "end": float(self.time[-1]),
            "differences": measured,
            "notes": list(self.notes),
        }


def compare(
    a: Source,
    b: Source | None = None,
    *,
    tolerance: float = TOLERANCE,
) -> Comparison:
    """Compare two runs of the same robot row by row.

    Parameters
    ----------
    a, b : str, path, mapping, Scenario or Run
        The output folder of a run, a :class:`onorbit_rs.Run`, or a scenario as accepted by
        :func:`onorbit_rs.run`, which is then run. Default of ``b``: the scenario of ``a`` on the other
        engine (MuJoCo or the built-in equations of motion).
    tolerance : float
        Runs diverge where a difference exceeds this fraction of the quantity's largest value, or of 1 in
        its unit (m, rad, N m) if that is larger. For inertial positions it is a fraction of the largest
        distance from the reference.

    Returns
    -------
    Comparison
        Differences at the instants that both runs recorded. If there are too few of these, the second run
        is interpolated, which is stated in ``notes``.

    Raises
    ------
    CompareError
        If the robots' joints differ in number, name or order, or the runs do not overlap in time.
    InputError
        If the tolerance is not positive and finite.
    DtypeError
        If an argument has another type, such as a trace.
    OnOrbitError
        As raised by :func:`onorbit_rs.run`, and for folders without a run.
    """
    allowed = finite_float(tolerance)
    if allowed is None or allowed <= 0.0:
        raise InputError(
            f"tolerance is {tolerance!r}; it must be positive and finite", name="tolerance", got=tolerance
        )
    first = recorded(a)
    second = on_the_other_engine(first) if b is None else recorded(b)
    notes = [*_same_robot(first, second), *differing_settings(first.scenario, second.scenario)]
    rows_a, rows_b, time, remarks = aligned_rows(first, second)
    found, missing = differences_in_quantities(rows_a, rows_b)
    differences = tuple(
        _difference(name, unit, values, allowed * max(1.0, scale) + error, time)
        for name, unit, values, scale, error in found
    )
    return Comparison(first.name, second.name, allowed, time, differences, (*notes, *remarks, *missing))


def _difference(name: str, unit: str, values: Floats, allowed: float, time: Floats) -> Difference:
    beyond = np.flatnonzero(~(np.isfinite(values) & (values <= allowed)))
    worst = int(np.argmax(np.where(np.isnan(values), np.inf, values)))
    parts_at = float(time[beyond[0]]) if beyond.size else None
    return Difference(
        name, unit, values, float(values[worst]), float(time[worst]), float(values[-1]), allowed, parts_at
    )


def _same_robot(a: Recorded, b: Recorded) -> list[str]:
    """Raise CompareError if the robots' joints differ; return notes about other differences."""
    if a.columns["q"].shape[1] != b.columns["q"].shape[1]:
        joints = [run.columns["q"].shape[1] - BASE_NQ for run in (a, b)]
        raise CompareError(
            f"the robot of {a.name} has {count(joints[0], 'joint', 'joints')} and that of {b.name} "
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
        return [*notes, f"cannot check whether their joints are equal: {error}"]
    if names[0] != names[1]:
        joints_a, joints_b = map(", ".join, names)
        raise CompareError(
            f"the robot of {a.name} has the joints {joints_a} and that of {b.name} {joints_b}; only runs of "
            "the same robot can be compared",
            name="robot", got=names[1], expected=names[0],
        )  # fmt: skip
    return notes
