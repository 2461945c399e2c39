"""The run of a live node: its stepper, its new rows and events, and the commands that it is given."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.exceptions import ControlError, InputError
from onorbit_rs.ros2.entries import Entry
from onorbit_rs.ros2.live_rows import LiveRows
from onorbit_rs.ros2.wrench_timeouts import WrenchTimeouts
from onorbit_rs.simulation.commands import CommandLog

if TYPE_CHECKING:
    from onorbit_rs._core import Checkpoint, EventRecord, Model, Simulation, Stepper, Trace, WorldTrace

_LONGEST_TICK = 1e-3
"""Longest simulated time between two readings of the topics, s, unless the time step is longer."""


class LiveRun:
    """A run that is advanced to given times and executes commands at its current time.

    Attributes
    ----------
    models : mapping of str to Model
        Robots by the name of the system.
    tick : float
        Simulated time between two readings of the topics, s: the time between two rows, at most about 1 ms,
        but at least one time step.
    end : float
        Time beyond which the run is not advanced, s.
    log : CommandLog
        Commands that were given.
    """

    def __init__(
        self, simulation: Simulation, wrench_timeout: float | None = None, keep_rows: int | None = None
    ) -> None:
        """Start the run.

        A wrench ends ``wrench_timeout``, s, after its last command (None: never). The first row and the last
        ``keep_rows``, up to twice as many, remain in memory (None: all rows). Raises InputError if either is
        invalid.
        """
        is_count = isinstance(keep_rows, int) and not isinstance(keep_rows, bool) and keep_rows >= 1
        if keep_rows is not None and not is_count:
            raise InputError(
                f"the number of rows to keep is {keep_rows!r}; it must be an integer of at least 1",
                name="keep_rows", got=keep_rows, expected="a positive integer",
            )  # fmt: skip
        self._keep_rows = keep_rows
        self._simulation = simulation
        self.models: Mapping[str, Model] = simulation.models
        steps = max(1, min(simulation.record_every, round(_LONGEST_TICK / simulation.time_step)))
        self.tick = simulation.time_step * steps
        self.end = np.inf
        self.log = CommandLog()
        self._wrench_timeout = wrench_timeout
        self._start(None)

    def _start(self, planned: float | None) -> None:
        """Start the run with a planned end, s; None for an open end."""
        self._planned = planned
        try:  # the state at the start, with that of controllers in Python
            self._beginning: Checkpoint | None = self._simulation.start(duration=planned).checkpoint()
        except ControlError:
            self._beginning = None
        self.restart()

    def restart(self) -> None:
        """Restart at time zero; controllers in Python are reset if their initial state could be saved."""
        self._stepper: Stepper = self._simulation.start(duration=self._planned, resume=self._beginning)
        self._rows = LiveRows(self._stepper, self.models)
        self._event_count = 0
        self._wrenches = WrenchTimeouts(self._wrench_timeout)

    def reset(self) -> None:
        """Return to the start, with an empty log of commands that has no file."""
        self.restart()
        self.log = CommandLog()

    def plan(self, end: float) -> bool:
        """Set the end of the run, s; return False if this requires a restart that is not possible.

        The steps of an adaptive run depend on its planned end. Such a run is restarted, which requires that
        the initial state of its controllers in Python could be saved.
        """
        self.end = end
        if self._simulation.integrator != "dormand_prince" or not np.isfinite(end):
            return True
        if not self.can_restart:
            return False
        self.restart()  # resets controllers in Python
        self._start(end)
        return True

    @property
    def can_restart(self) -> bool:
        """True if the run can begin again, that is, if the states of all its controllers could be saved."""
        return self._beginning is not None

    @property
    def time(self) -> float:
        """Current simulated time, s."""
        return self._stepper.time

    def controls_of(self, system: str) -> dict[str, list[str]]:
        """Return the external controls of a system with their joints."""
        own = self._stepper[system] if len(self.models) > 1 else self._stepper
        return own.external

    def next_time(self, shortest: float) -> float:
        """Return a time, s, on the grid of ticks: ``shortest``, s, ahead, rounded to at least one tick.

        The time is not later than the end of the run.
        """
        ticks = max(1, round(shortest / self.tick))
        return min(self.tick * (round(self.time / self.tick) + ticks), self.end)

    def advance_to(self, t: float) -> list[Entry]:
        """Advance to a simulated time, s; return the commands that ended wrenches on the way."""
        given: list[Entry] = []
        while self._wrenches.next <= t:
            end = max(self._wrenches.next, self.time)
            self._stepper.advance_to(end)
            for entry in self._wrenches.take(end):  # rounding may end the advance just before the timeout
                self.log.apply(self._stepper, entry)
                given.append(entry)
        self._stepper.advance_to(t)
        return given

    def command(self, entries: Sequence[Entry]) -> None:
        """Apply commands at the current time; if one is invalid, apply none and raise an OnOrbitError."""
        self.log.apply(self._stepper, *entries)
        self._wrenches.note(entries, self.time)

    def rows(self) -> Any:
        """Return the rows of each system recorded since the last call."""
        new = self._rows.take()
        if self._keep_rows is not None:
            self._rows.keep_last(self._keep_rows)
        return new

    def events(self) -> Sequence[EventRecord]:
        """Return the events that have happened since the last call."""
        found = self._stepper.events
        new = found[self._event_count :]
        self._event_count = len(found)
        return new

    def present(self) -> Any:
        """Return the row of each system at the current time, which :meth:`rows` may return too."""
        return self._rows.present()

    def take_present(self) -> Any:
        """Return the row of each system at the current time, which :meth:`rows` then omits."""
        return self._rows.take_present()

    def finish(self) -> tuple[Trace | WorldTrace, Any]:
        """End the run; return its trace, and the rows of each system since the last call of :meth:`rows`."""
        trace = self._stepper.finish()
        self.log.close()
        return trace, self._rows.take_last(trace)
