"""Two runs side by side: by how much they differ, and where they part."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.comparison.measures import measures
from onorbit_rs.comparison.recorded import Recorded, Source, on_the_other_plant, recorded
from onorbit_rs.comparison.rows import common_rows
from onorbit_rs.comparison.settings import settings_apart
from onorbit_rs.comparison.words import as_text
from onorbit_rs.counting import count
from onorbit_rs.exceptions import CompareError, InputError, OnOrbitError
from onorbit_rs.printable import json_value
from onorbit_rs.reals import real

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

TOLERANCE = 1e-6
"""What two runs may differ by, as a share of the largest value, or of 1 in the measure's unit."""


@dataclass(frozen=True)
class Difference:
    """What two runs differ by in one measure; ``values`` (T,) at the times of the comparison, in ``unit``."""

    name: str
    unit: str
    values: Floats
    largest: float
    largest_at: float
    """Time of the largest, s."""
    final: float
    allowed: float
    """The tolerance times the scale of either run, which counts as 1 at least, and what the rows err by.

    The scale is the largest finite value; of inertial positions, the largest distance from the reference.
    """
    parts_at: float | None
    """First time beyond what is allowed, s; None where there is none."""


@dataclass(frozen=True)
class Comparison:
    """Two runs side by side, ``b`` against ``a``."""

    a: str
    b: str
    tolerance: float
    time: Floats
    """Instants at which they are compared, (T,), s."""
    differences: tuple[Difference, ...]
    notes: tuple[str, ...]
    """What could not be compared, and why; which settings are not the same."""

    @property
    def agrees(self) -> bool:
        """Whether no measure is beyond the tolerance at any time."""
        return self.parts_at is None

    @property
    def parts_at(self) -> float | None:
        """First time at which any measure is beyond the tolerance, s; None where there is none."""
        return min((d.parts_at for d in self.differences if d.parts_at is not None), default=None)

    def __getitem__(self, name: str) -> Difference:
        """The measure of that name, such as ``base attitude``."""
        for difference in self.differences:
            if difference.name == name:
                return difference
        known = ", ".join(difference.name for difference in self.differences)
        raise CompareError(
            f"nothing compared is named {name!r}; there are: {known}", name=name, expected=known
        )

    def __str__(self) -> str:
        """As ``onorbit compare`` prints it."""
        return as_text(self)

    def as_dict(self) -> dict[str, Any]:
        """Plain data without the rows, as ``onorbit compare --json`` prints it."""
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
    """Compare two runs of one robot, row by row.

    Parameters
    ----------
    a, b : str, path, mapping, Scenario or Run
        A folder that a run has written, a scenario (as :func:`onorbit_rs.run` takes it), which is run now, or
        the :class:`onorbit_rs.Run` itself. Without ``b``: the scenario of ``a`` on the other plant.
    tolerance : float
        What counts as parted: a share of the largest value of a measure, or of 1 in its unit (m, rad, N m);
        of inertial positions, of the largest distance from the reference.

    Returns
    -------
    Comparison
        At the instants that both runs have a row for; where these are few, between rows by interpolation,
        which ``notes`` tells.

    Raises
    ------
    CompareError
        Robots whose joints are others, by number, name or order, or runs without a time in common.
    DtypeError
        What is none of these, such as a trace without its run.
    OnOrbitError
        As :func:`onorbit_rs.run`, and for folders without a run.
    """
    share = real(tolerance)
    if share is None or share <= 0.0:
        raise InputError(
            f"tolerance is {tolerance!r}, it must be a positive number", name="tolerance", got=tolerance
        )
    first = recorded(a)
    second = on_the_other_plant(first) if b is None else recorded(b)
    notes = [*_same_robot(first, second), *settings_apart(first.scenario, second.scenario)]
    rows_a, rows_b, time, remarks = common_rows(first, second)
    found, missing = measures(rows_a, rows_b)
    differences = tuple(
        _difference(name, unit, values, share * max(1.0, scale) + error, time)
        for name, unit, values, scale, error in found
    )
    return Comparison(first.name, second.name, share, time, differences, (*notes, *remarks, *missing))


def _difference(name: str, unit: str, values: Floats, allowed: float, time: Floats) -> Difference:
    beyond = np.flatnonzero(~(np.isfinite(values) & (values <= allowed)))
    worst = int(np.argmax(np.where(np.isnan(values), np.inf, values)))
    parts_at = float(time[beyond[0]]) if beyond.size else None
    return Difference(
        name, unit, values, float(values[worst]), float(time[worst]), float(values[-1]), allowed, parts_at
    )


def _same_robot(a: Recorded, b: Recorded) -> list[str]:
    """Refuse robots whose joints are not the same; tell what else of them differs."""
    if a.columns["q"].shape[1] != b.columns["q"].shape[1]:
        joints = [run.columns["q"].shape[1] - 7 for run in (a, b)]
        raise CompareError(
            f"{a.name} has a robot with {count(joints[0], 'joint', 'joints')}, {b.name} one with "
            f"{joints[1]}: only runs of one robot compare",
            name="robot", got=joints[1], expected=joints[0],
        )  # fmt: skip
    prints = a.fingerprint, b.fingerprint
    if prints[0] == prints[1] if None not in prints else a.robot == b.robot:
        return []
    if a.robot == b.robot:
        notes = [f"the robot {a.robot} was changed between the two runs ({prints[0]} and {prints[1]})"]
    else:
        notes = [f"the robots are not the same: {a.robot} and {b.robot}"]
    try:
        names = a.joint_names(), b.joint_names()
    except OnOrbitError as error:  # a folder whose robot has moved away: the rows are still there
        return [*notes, f"nobody knows whether their joints are the same: {error}"]
    if names[0] != names[1]:
        ours, theirs = map(", ".join, names)
        raise CompareError(
            f"{a.name} has a robot with the joints {ours}, {b.name} one with {theirs}: only runs of one "
            "robot compare",
            name="robot", got=names[1], expected=names[0],
        )  # fmt: skip
    return notes
