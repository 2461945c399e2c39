"""Rows of a running simulation, each of which is returned once."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs.ros2.rows import Rows, rows_of_columns, rows_of_trace

if TYPE_CHECKING:
    from onorbit_rs._core import Model, Stepper, Trace, WorldTrace


class LiveRows:
    """Reads the recorded rows of a stepper, each of them once."""

    def __init__(self, stepper: Stepper, models: Mapping[str, Model]) -> None:
        """Store the stepper and the model of each system by the name of the system."""
        self._stepper, self._models = stepper, models
        self._counts = dict.fromkeys(models, 0)
        self._taken_until = -np.inf

    def take(self) -> dict[str, Rows]:
        """Return the rows of each system since the last call, without a row at the current time."""
        since = self._counts if len(self._models) > 1 else next(iter(self._counts.values()))
        columns = self._stepper.columns(since)
        for system in self._models:
            # without a new row the columns are missing
            self._counts[system] += len(columns.get(f"{system}/time", columns.get("time", ())))
        return self._after(rows_of_columns(columns, self._models))

    def take_present(self) -> dict[str, Rows]:
        """Return the row of each system at the current time, which :meth:`take` will not return again."""
        rows = self._after(self.present())
        self._taken_until = self._stepper.time
        return rows

    def keep_last(self, count: int) -> None:
        """Drop rows that :meth:`take` has returned, if more than twice ``count`` are in memory.

        The first row and at least the last ``count`` remain.
        """
        if max(self._counts.values()) > 2 * count:
            self._stepper.drop_rows(count)
            self._counts = {system: min(rows, count + 1) for system, rows in self._counts.items()}

    def present(self) -> dict[str, Rows]:
        """Return the row of each system at the current time, which :meth:`take` may return later."""
        return rows_of_columns(self._stepper.present(), self._models)

    def take_last(self, trace: Trace | WorldTrace) -> dict[str, Rows]:
        """Return the rows of the final trace that :meth:`take` and :meth:`take_present` have not returned."""
        return self._after(rows_of_trace(trace, self._models, self._counts))

    def _after(self, rows: dict[str, Rows]) -> dict[str, Rows]:
        """Return those rows that are later than the last one returned by :meth:`take_present`."""
        if np.isinf(self._taken_until):
            return rows
        return {system: own.after(self._taken_until) for system, own in rows.items()}
