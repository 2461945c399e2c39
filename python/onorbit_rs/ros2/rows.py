"""Rows of the systems of a run, from a stepper while it runs or from its trace."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs._core import WorldTrace
from onorbit_rs.common.rotations import local_orbital_axes, quaternion_from_matrix
from onorbit_rs.output.columns import path_of
from onorbit_rs.output.saved_world import SavedWorldTrace

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Model, Trace

    Floats = NDArray[np.float64]

COLUMNS = ("time", "q", "v", "tau", "reference_position_eci", "reference_velocity_eci")
"""Columns that topics require; ``tau`` is missing without joints, those of the orbit without an orbit."""


@dataclass(frozen=True)
class Rows:
    """Consecutive rows of one system, at different times."""

    columns: Mapping[str, Floats]
    """Values (T, width) by the name of the column."""
    wrenches: Mapping[str, Floats] = field(default_factory=dict)
    """Wrenches (T, 6 n) on n bodies, by effect: force, N, and torque, N m, at the centre of mass, in W."""

    @classmethod
    def at_distinct_times(cls, columns: Mapping[str, Floats], wrenches: Mapping[str, Floats]) -> Rows:
        """Return the rows without those that a later row at the same time replaces, as at a capture."""
        time = columns["time"].reshape(-1)
        chosen = np.append(time[1:] != time[:-1], np.ones(min(1, len(time)), dtype=bool))
        rows = cls(columns, wrenches)
        return rows if chosen.all() else rows.at(chosen)

    def at(self, chosen: NDArray[np.bool_] | slice) -> Rows:
        """Return the rows that a mask or a slice selects."""
        parts = (self.columns, self.wrenches)
        return Rows(*({name: held[chosen] for name, held in part.items()} for part in parts))

    def after(self, time: float) -> Rows:
        """Return the rows after a time, s."""
        return self.at(self.time > time)

    @property
    def time(self) -> Floats:
        """Times (T,), s."""
        return self.columns["time"].reshape(-1)

    @cached_property
    def orbit_attitude(self) -> Floats:
        """Quaternions xyzw (T, 4) of the attitude of the local orbital frame in inertial axes."""
        r, v = self["reference_position_eci"], self["reference_velocity_eci"]
        return quaternion_from_matrix(local_orbital_axes(r, v))

    @classmethod
    def joined(cls, parts: Sequence[Rows]) -> Rows:
        """Return consecutive parts as one object; without parts, an object without rows."""
        parts = [part for part in parts if len(part)]
        if not parts:
            return cls({"time": np.empty(0)})

        def column(held: Sequence[Floats]) -> Floats:
            return np.concatenate([values.reshape(len(values), -1) for values in held])

        return cls(
            {name: column([part.columns[name] for part in parts]) for name in parts[0].columns},
            {name: column([part.wrenches[name] for part in parts]) for name in parts[0].wrenches},
        )

    def between(self, start: float, end: float) -> Rows:
        """Return the rows with times in ``[start, end)``, s."""
        return self.at(slice(*np.searchsorted(self.time, [start, end])))

    def __getitem__(self, name: str) -> Floats:
        """Return the column ``name``, (T, width)."""
        return self.columns[name]

    def __contains__(self, name: str) -> bool:
        """Return True if the run recorded a column."""
        return name in self.columns

    def __len__(self) -> int:
        """Return the number of rows."""
        return len(self.columns["time"])


def rows_of_trace(
    trace: Trace | WorldTrace | SavedWorldTrace,
    models: Mapping[str, Model],
    since: Mapping[str, int] | None = None,
) -> dict[str, Rows]:
    """Return the rows of each system of a trace, beginning for each system at its row in ``since``."""
    found = {}
    for system in models:
        own: Any = trace[system] if isinstance(trace, WorldTrace | SavedWorldTrace) else trace
        rows = slice(0 if since is None else since[system], None)
        columns = {name: np.asarray(getattr(own, name))[rows] for name in COLUMNS if name in own.columns()}
        wrenches = {
            name: np.asarray(held)[rows].reshape(len(columns["time"]), -1)
            for name, held in own.wrenches.items()
        }
        found[system] = Rows.at_distinct_times(columns, wrenches)
    return found


def rows_of_columns(columns: Mapping[str, Floats], models: Mapping[str, Model]) -> dict[str, Rows]:
    """Return the rows of each system from the columns of a stepper.

    In a world, the names of the columns begin with the name of the system.
    """
    found = {}
    for system in models:
        prefix = f"{system}/" if f"{system}/time" in columns else ""
        own = {name: columns[prefix + name] for name in COLUMNS if prefix + name in columns}
        start = prefix + path_of("wrenches", "")
        wrenches = {
            path.removeprefix(start): held for path, held in columns.items() if path.startswith(start)
        }
        own.setdefault("time", np.empty((0, 1)))  # columns without rows are missing
        found[system] = Rows.at_distinct_times(own, wrenches)
    return found
