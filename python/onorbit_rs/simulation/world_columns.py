"""Columns of a world, computed from the rows of its systems before those rows are removed from memory."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.output.saved_world import WORLD_COLUMNS
from onorbit_rs.output.streamed_trace import mapped_columns

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from onorbit_rs._core import Stepper, WorldTrace
    from onorbit_rs.output import CheckpointWriter

KEPT_BY_RESUME = 16
"""Number of last rows of each system that are in memory after a run was resumed with bounded memory."""

_SHAPES: dict[str, tuple[int, ...]] = {"time": (), "momentum": (6,), "kinetic_energy": ()}


class WorldColumns:
    """Computes the columns of a world block by block, and writes them to the files of the checkpoint."""

    def __init__(self, stepper: Stepper, writer: CheckpointWriter) -> None:
        """Continue after the rows that the files contain."""
        self._stepper, self._writer = stepper, writer
        written = writer.rows_of("")
        self._since = -np.inf
        if written:
            time = np.fromfile(writer.file_of("time"), "<f8", 1, offset=8 * (written - 1))
            self._since = float(np.nextafter(time[0], np.inf))

    def write(self, in_memory: Mapping[str, int], kept: int) -> bool:
        """Write the columns before the time from which the last ``kept`` rows of each system are sufficient.

        Return False if the rows must stay in memory, because too many of them have the same time, or because
        the columns cannot be written. ``in_memory`` contains the number of rows of each system by prefix.
        """
        first = {prefix[:-1]: max(rows - kept, 0) for prefix, rows in in_memory.items()}
        last = self._stepper.columns(since=first)
        until = _first_time([last[f"{prefix}time"][:, 0] for prefix in in_memory])
        if until is None:
            return False
        if until > self._since:
            found = self._stepper.world_columns(self._since, until)
            if not self._writer.append(_as_rows(found)):
                return False
            self._since = until
        return True

    def with_last(self, ending: WorldTrace) -> list[Any]:
        """Write the last rows of the run, and return the columns, mapped from their files.

        ``ending`` is the trace of the engine, which contains the first and the last rows.
        """
        last = np.asarray(ending.time) >= self._since
        self._writer.append(
            _as_rows({name: np.asarray(getattr(ending, name))[last] for name in WORLD_COLUMNS}), must=True
        )
        count = self._writer.rows_of("")
        files = {name: self._writer.file_of(name) for name in WORLD_COLUMNS}
        found = mapped_columns(files, {name: (count, *shape) for name, shape in _SHAPES.items()})
        return [found[name] for name in WORLD_COLUMNS]


def is_continued(columns: Mapping[str, Any], systems: Iterable[str]) -> bool:
    """Return True if a run can be resumed from these columns with the last rows of the systems in memory.

    The columns of the world must be complete up to these rows, which holds for the checkpoints of runs that
    wrote their rows while they were computed.
    """
    if any(name not in columns for name in WORLD_COLUMNS) or not len(columns["time"]):
        return False
    until = columns["time"][-1:][0, 0]
    return all(_is_kept(columns.get(f"{name}/time"), until) for name in systems)


def _is_kept(time: Any, until: float) -> bool:
    """Return True if all rows after the time ``until`` are among those that a resumed run has in memory."""
    if time is None:
        return False
    before = len(time) - KEPT_BY_RESUME - 1
    return before <= 0 or bool(time[before : before + 1][0, 0] <= until)


def _first_time(times: list[Any]) -> float | None:
    """Return the time from which the given last rows of every system are complete; None if there is none."""
    later = [own[own > own[0]] for own in times]
    return max(float(own[0]) for own in later) if all(len(own) for own in later) else None


def _as_rows(columns: Mapping[str, Any]) -> dict[str, Any]:
    return {name: np.asarray(values).reshape(len(values), -1) for name, values in columns.items()}
