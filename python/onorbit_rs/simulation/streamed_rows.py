"""Moves the rows of a run from memory to the files of its checkpoint."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.exceptions import ControlError
from onorbit_rs.output.pickling import arrays_of
from onorbit_rs.output.streamed_trace import StreamedTrace, StreamedWorldTrace, mapped_columns
from onorbit_rs.scenario.build_world import BuiltWorld
from onorbit_rs.simulation.world_columns import KEPT_BY_RESUME, WorldColumns

if TYPE_CHECKING:
    from onorbit_rs._core import Stepper
    from onorbit_rs.output import CheckpointWriter
    from onorbit_rs.scenario.build import Built

KEPT = 64
"""Number of last rows of each system that remain in memory when rows are written."""


class StreamedRows:
    """Moves the rows of a run from memory to the files of its checkpoint.

    The first row of each system and its last rows remain in memory. Of the other rows, the engine keeps only
    the sums from which it computes the certificate.
    """

    def __init__(self, stepper: Stepper, writer: CheckpointWriter, built: Built | BuiltWorld) -> None:
        """Store the stepper, which has the first and the last of the rows that ``writer`` has written."""
        self._stepper, self._writer = stepper, writer
        self._prefixes = {f"{name}/": name for name in built.systems} if isinstance(built, BuiltWorld) else {}
        in_memory = _counts(stepper.columns(), self._names)
        self._dropped = {name: writer.rows_of(name) - in_memory[name] for name in self._names}
        self._can_save = True
        self._world = WorldColumns(stepper, writer) if self._prefixes else None

    @property
    def _names(self) -> list[str]:
        """Prefixes of the columns of the systems; that of a single robot is empty."""
        return list(self._prefixes) or [""]

    def _saved(self) -> dict[str, int]:
        """Return, by prefix, how many of the rows in memory, from the first on, are also in the files."""
        return {prefix: self._writer.rows_of(prefix) - self._dropped[prefix] for prefix in self._names}

    def _since(self) -> int | dict[str, int]:
        """Return the index of the first row in memory that is not in the files; in a world, by system."""
        saved = self._saved()
        return {name: saved[prefix] for prefix, name in self._prefixes.items()} or saved[""]

    def move(self) -> None:
        """Write the new rows, then remove all but the first and the last rows of each system from memory.

        If the new rows cannot be written, no rows are removed.
        """
        if not self._writer.append(self._stepper.columns(since=self._since())):
            return
        in_memory = self._saved()
        if self._world is not None and not self._world.write(in_memory, KEPT):
            return
        dropped = {prefix: self._writer.rows_of(prefix) - min(rows, KEPT + 1)
                   for prefix, rows in in_memory.items()}  # fmt: skip
        try:
            self._stepper.drop_rows(KEPT, checked=True)
        finally:
            self._dropped = dropped

    def save(self) -> None:
        """Write the new rows and a checkpoint; if the controller cannot be saved, warn once."""
        if not self._can_save:
            return
        try:
            checkpoint = self._stepper.checkpoint(since=self._since())
        except ControlError as error:
            self._can_save = False
            warnings.warn(f"checkpoints are disabled for this run: {error}", UserWarning, stacklevel=2)
            return
        if self._world is not None:  # a resumed run has only the last rows of the systems in memory
            saved = self._saved()
            new = _counts(checkpoint.columns, self._names)
            self._world.write({name: saved[name] + new[name] for name in self._names}, KEPT_BY_RESUME)
        self._writer(checkpoint)

    def trace_of(self, ending: Any) -> StreamedTrace | StreamedWorldTrace:
        """Write the last rows, and return the trace of all rows; ``ending`` is the trace of the engine.

        Raises
        ------
        OutputFolderError, CheckpointError
            If the rows cannot be written.
        """
        traces: dict[str, Any] = {prefix: ending[name] for prefix, name in self._prefixes.items()}
        traces = traces or {"": ending}
        arrays = {prefix: arrays_of(trace) for prefix, trace in traces.items()}
        new, saved = {}, self._saved()
        for prefix, columns in arrays.items():
            for path, rows in columns.items():
                if np.size(rows):
                    last = rows[saved[prefix] :]
                    new[f"{prefix}{path}"] = last.reshape(len(last), -1)
        self._writer.append(new, must=True)
        found = {}
        for prefix, columns in arrays.items():
            count = self._writer.rows_of(prefix)
            files = {path: self._writer.file_of(f"{prefix}{path}") for path in columns}
            shapes = {path: (count, *np.shape(rows)[1:]) for path, rows in columns.items()}
            found[prefix] = StreamedTrace(mapped_columns(files, shapes), traces[prefix])
        if self._world is None:
            return found[""]
        systems = {name: found[prefix] for prefix, name in self._prefixes.items()}
        time, momentum, energy = self._world.with_last(ending)
        return StreamedWorldTrace(systems, list(ending.events), time, momentum, energy, ending)


def _counts(columns: Any, prefixes: list[str]) -> dict[str, int]:
    """Return the number of rows of each system, given columns by path."""
    return {prefix: len(columns.get(f"{prefix}time", ())) for prefix in prefixes}
