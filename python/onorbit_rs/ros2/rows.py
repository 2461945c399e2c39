"""Rows of the systems of a run, from a stepper while it runs or from its trace."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs._core import WorldTrace

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Model, Trace

    Floats = NDArray[np.float64]

COLUMNS = ("time", "q", "v", "tau", "reference_position_eci", "reference_velocity_eci")
"""Columns that topics require; ``tau`` is missing without joints, those of the orbit without an orbit."""


@dataclass(frozen=True)
class Rows:
    """Consecutive rows of one system: ``columns`` maps names to values (T, width)."""

    columns: Mapping[str, Floats]

    @property
    def time(self) -> Floats:
        """Times (T,), s."""
        return self.columns["time"].reshape(-1)

    def __getitem__(self, name: str) -> Floats:
        return self.columns[name]

    def __contains__(self, name: str) -> bool:
        return name in self.columns

    def __len__(self) -> int:
        return len(self.columns["time"])

    def at(self, rows: slice) -> Rows:
        """Return some of the rows."""
        return Rows({name: values[rows] for name, values in self.columns.items()})


def rows_of_trace(trace: Trace | WorldTrace, models: Mapping[str, Model]) -> dict[str, Rows]:
    """Return the rows of each system of a trace, which may be that of one robot."""
    if isinstance(trace, WorldTrace):
        return {name: _of(trace[name]) for name in models}
    return {name: _of(trace) for name in models}


def _of(trace: Trace) -> Rows:
    held = [name for name in COLUMNS if name in trace.columns()]
    return Rows({name: np.asarray(getattr(trace, name)) for name in held})


def rows_of_columns(columns: Mapping[str, Floats], models: Mapping[str, Model]) -> dict[str, Rows]:
    """Return the rows of each system from the columns of a stepper, whose paths name it in a world."""
    found = {}
    for system in models:
        prefix = f"{system}/" if f"{system}/time" in columns else ""
        found[system] = Rows({name: columns[prefix + name] for name in COLUMNS if prefix + name in columns})
    return found
