"""Applies the commands of a log to a run, which then reproduces the original run bit for bit."""

from __future__ import annotations

import warnings
from collections import deque
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from onorbit_rs.common.numbers import shortest
from onorbit_rs.exceptions import InputError
from onorbit_rs.simulation.command_format import Command, checked, in_order
from onorbit_rs.simulation.commands import give

if TYPE_CHECKING:
    from onorbit_rs._core import Simulation, Stepper

_SAME_INSTANT = 1e-9
"""Largest difference, as a fraction of a step, of two times that are considered equal, as in the engine."""


def replay_commands(
    stepper: Stepper, entries: Iterable[Mapping[str, Any]], until: float | None = None
) -> None:
    """Advance a run and apply the commands of a log at their times.

    Parameters
    ----------
    stepper : Stepper
        Run to be advanced; commands before its current time are omitted.
    entries : iterable of mapping
        Commands in the order of their times, such as those of :func:`read_commands`.
    until : float, optional
        Time to which the run is advanced after the last command, s; default: the time of the last command.

    Raises
    ------
    InputError
        If an entry is invalid or times decrease; in this case no command is applied.
    OnOrbitError
        If the stepper rejects a command, or the run fails.
    """
    queue = Queue(entries, stepper.time)
    while queue.commands:
        if queue.commands[0].time > stepper.time:
            stepper.advance_to(queue.commands[0].time)
        queue.apply_next(stepper)
    if until is not None and until > stepper.time:
        stepper.advance_to(until)


class Queue:
    """Commands of a log that have not been applied to the run yet."""

    def __init__(self, entries: Iterable[Mapping[str, Any]], start: float, *, step: float = 0.0) -> None:
        """Store the commands that are not before ``start``, s; ``step`` is the time step of the run, s.

        A command at the time of a checkpoint may have been applied before the checkpoint was saved. Applying
        the command again changes nothing, because no step lies in between.
        """
        commands = in_order(entry if isinstance(entry, Command) else checked(entry) for entry in entries)
        self._tolerance = max(_SAME_INSTANT * step, 1e-15 * start)
        self.commands = deque(entry for entry in commands if entry.time >= start - self._tolerance)

    def next_time(self, end: float) -> float:
        """Return the time of the next command or ``end``, whichever is earlier, s."""
        return min(self.commands[0].time, end) if self.commands else end

    def apply_due(self, stepper: Stepper) -> None:
        """Apply all commands whose time the run has reached."""
        tolerance = max(self._tolerance, 1e-15 * stepper.time)
        while self.commands and self.commands[0].time <= stepper.time + tolerance:
            self.apply_next(stepper)

    def apply_next(self, stepper: Stepper) -> None:
        """Apply the next command to the run."""
        give(stepper, self.commands.popleft())


def check_commands(simulation: Simulation, commands: Sequence[Command], duration: float) -> None:
    """Raise an error for a command that a run would reject, by applying all commands at time zero.

    Commands after the end of the run, which will not be applied, cause a warning.
    """
    if not commands:
        return
    if late := [command for command in commands if command.time > duration]:
        warnings.warn(
            f"{late[0].where or 'commands'}: commands after the end of the run, {shortest(duration)} s, are "
            f"not applied ({len(late)} of {len(commands)}); to apply all of them, set the duration of the "
            f"scenario to at least {shortest(late[-1].time)} s",
            UserWarning,
            stacklevel=3,
        )
    stepper = simulation.start()
    for command in commands:
        give(stepper, command)
        path = command.get("trajectory")
        end = None if path is None or "start" not in path else path["start"] + path["times"][-1]
        if end is not None and end < command.time:
            raise InputError(
                f"{command.where or 'commands'}: the trajectory ends at t = {shortest(end)} s, before the "
                f"time of the command, {shortest(command.time)} s; give a later 'start'",
                name="commands", got=end, expected=command.time,
            )  # fmt: skip
