"""The trace of a run whose rows are on the disk."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from onorbit_rs.common.blocks import release
from onorbit_rs.common.decimate import evenly_spaced
from onorbit_rs.output.pickling import PickledTrace
from onorbit_rs.output.saved_trace import SavedTrace
from onorbit_rs.output.saved_world import WORLD_COLUMNS, PickledWorldTrace, SavedWorldTrace, system_in

if TYPE_CHECKING:
    from onorbit_rs._core import Trace, WorldTrace

DRAWN_ROWS = 20_000
"""Largest number of rows of a streamed run that figures and the recording show."""

_ROWS_AT_ONCE = 1000


class _Ending:
    """Base class of streamed traces, with the results that the engine computed from all rows.

    ``ending`` is the trace of the engine, which contains only some of the rows.
    """

    ending: Any

    @property
    def is_complete(self) -> bool:
        """True if the run reached its end."""
        return bool(self.ending.is_complete)

    @property
    def wall_s(self) -> float:
        """Wall-clock time of the simulation loop, s."""
        return float(self.ending.wall_s)

    def certificate(self) -> Any:
        """Return the certificate of all rows."""
        return self.ending.certificate()


@dataclass(frozen=True, repr=False)
class StreamedTrace(_Ending, SavedTrace):
    """Trace with the attributes of :class:`onorbit_rs.Trace`, whose columns are read from files when used.

    ``ending`` is the trace of the engine, which contains the first and the last rows and the certificate of
    all rows.
    """

    ending: Trace

    @property
    def results(self) -> Any:
        """Outcomes of the goals of the controls."""
        return self.ending.results

    @property
    def events(self) -> Any:
        """Events that happened, in order of time."""
        return self.ending.events

    @property
    def rereferenced(self) -> Any:
        """Times at which the run changed to a new reference orbit, s."""
        return self.ending.rereferenced

    def joint_limits_exceeded(self) -> Any:
        """Return the names of the joints beyond their position limits in any row."""
        return self.ending.joint_limits_exceeded()

    def __len__(self) -> int:
        """Return the number of rows."""
        return len(self.arrays["time"])

    def __repr__(self) -> str:
        """Return the number of rows and the last time."""
        return f"<Trace: {len(self)} rows to t = {self.arrays['time'][-1]:g} s, on the disk>"

    def __reduce__(self) -> tuple[Any, ...]:
        """Return the class and arguments that rebuild the trace, with all of its rows, from a pickle."""
        return self.with_rows(slice(None)).__reduce__()

    def read_from(self, arrays: Mapping[str, Any]) -> None:
        """Replace the columns by these arrays, which have the same values."""
        columns = cast("dict[str, Any]", self.arrays)
        columns.update({path: arrays[path] for path in columns})

    def decimated(self) -> PickledTrace:
        """Return the first, the last and evenly spaced rows, in memory, for figures and the recording."""
        return self.with_rows(evenly_spaced(len(self), DRAWN_ROWS))

    def with_rows(self, rows: Any) -> PickledTrace:
        """Return the trace with only some of its rows, in memory."""
        arrays = {path: _rows_of(column, rows) for path, column in self.arrays.items()}
        arrays["rereferenced"] = np.array(self.rereferenced)
        results = {"certificate": self.certificate(), "joint_limits_exceeded": self.joint_limits_exceeded()}
        rest = (list(self.results), results, self.events)
        return PickledTrace(arrays, self.is_complete, self.wall_s, *rest)


@dataclass(frozen=True, repr=False)
class StreamedWorldTrace(_Ending, SavedWorldTrace):
    """Trace of a world whose systems are :class:`StreamedTrace`; ``ending`` is the trace of the engine."""

    ending: WorldTrace

    def __repr__(self) -> str:
        """Return the names of the systems, the number of rows and the last time."""
        names = ", ".join(self.names)
        return f"<WorldTrace of {names}: {len(self)} rows to t = {self.time[-1]:g} s, on the disk>"

    def __reduce__(self) -> tuple[Any, ...]:
        """Return the class and arguments that rebuild the trace, with all of its rows, from a pickle."""
        systems = {name: own.with_rows(slice(None)) for name, own in self.systems.items()}
        return self._with_rows(systems, slice(None)).__reduce__()

    def read_from(self, arrays: Mapping[str, Any]) -> None:
        """Replace all columns by these arrays, which have the same values."""
        for name, own in self.systems.items():
            own.read_from(system_in(arrays, name).arrays)
        for name in WORLD_COLUMNS:
            object.__setattr__(self, name, arrays[name])  # the files of the first values are removed

    def decimated(self) -> PickledWorldTrace:
        """Return the rows at evenly spaced times, which are the same for all systems, in memory."""
        rows = evenly_spaced(len(self), DRAWN_ROWS // len(self.systems))
        systems = {}
        for name, own in self.systems.items():
            # of two rows at one time, the later one is after an event
            at = np.searchsorted(own.time, self.time[rows], side="right") - 1
            release(own.time)
            systems[name] = own.with_rows(at)
        return self._with_rows(systems, rows)

    def _with_rows(self, systems: Mapping[str, PickledTrace], rows: Any) -> PickledWorldTrace:
        time, momentum, energy = (
            np.array(column[rows]) for column in (self.time, self.momentum, self.kinetic_energy)
        )
        return PickledWorldTrace(
            systems, self.events, time, momentum, energy, self.is_complete, self.wall_s, self.certificate()
        )


def _rows_of(column: Any, rows: Any) -> Any:
    """Return rows of a column, read in parts, because memory pages around each row are read too."""
    if isinstance(rows, slice):
        return np.array(column[rows])
    parts = []
    for start in range(0, len(rows), _ROWS_AT_ONCE):
        parts.append(np.array(column[rows[start : start + _ROWS_AT_ONCE]]))
        release(column)
    return np.concatenate(parts)


def mapped_columns(files: Mapping[str, Path], shapes: Mapping[str, tuple[int, ...]]) -> dict[str, Any]:
    """Return columns with these shapes, which are mapped from files of numbers."""
    return {
        path: np.memmap(file, dtype="<f8", mode="r", shape=shapes[path])
        if np.prod(shapes[path], dtype=np.int64)
        else np.empty(shapes[path])
        for path, file in files.items()
    }
