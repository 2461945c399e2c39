"""Passes commands to the stepper of a run, and logs them."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

from onorbit_rs.common.counting import count
from onorbit_rs.common.files import output_errors
from onorbit_rs.exceptions import OnOrbitError
from onorbit_rs.simulation.command_format import SETPOINT, Command, as_line, checked, invalid

if TYPE_CHECKING:
    from onorbit_rs._core import Stepper, SystemStepper


def apply(stepper: Stepper, entry: Mapping[str, Any]) -> None:
    """Give a stepper one command, at the current time of the stepper.

    Parameters
    ----------
    stepper : Stepper
        Run that receives the command.
    entry : mapping
        Command; ``time`` is ignored.

    Raises
    ------
    InputError
        If the entry has unknown or missing keys, or wrong values; the run is unchanged.
    OnOrbitError
        If the stepper rejects the command; the run is unchanged.
    """
    give(stepper, checked({"time": stepper.time, **entry}))


def give(stepper: Stepper, entry: Command, *, check_only: bool = False) -> None:
    """Give a stepper a checked command; error messages contain its location in the file.

    With ``check_only``, a constant command to joints is only checked; other commands are given regardless.
    """
    if "trigger" not in entry and "system" not in entry and len(stepper.systems) > 1:
        names = ", ".join(stepper.systems)
        raise invalid(
            entry.where, f"'system' is missing; the run has several systems, so give one of: {names}"
        )
    try:
        if "trigger" in entry:
            stepper.trigger(entry["trigger"])
            return
        target: Stepper | SystemStepper = stepper[entry["system"]] if "system" in entry else stepper
        if "body" in entry:
            target.wrench(entry["body"], entry.get("force"), entry.get("torque"), entry.get("frame", "world"))
        elif "trajectory" in entry:
            path = dict(entry["trajectory"])
            target.send_trajectory(entry["control"], path.pop("times"), path.pop("positions"), **path)
        else:
            target.send(entry["control"], **_setpoint(target, entry), check_only=check_only)
    except OnOrbitError as error:
        if entry.where:
            error.message = f"{entry.where}: {error.message}"
        raise


def _check(stepper: Stepper, command: Command) -> None:
    """Raise an error unless a command is a constant command to joints that the stepper would accept."""
    if "control" not in command or "trajectory" in command:
        given = f"{dict(command)!r:.80}"
        raise invalid(
            "",
            "only commands with 'control' and without 'trajectory' can be given together; give this command "
            f"alone: {given}",
        )
    give(stepper, command, check_only=True)


def _setpoint(target: Stepper | SystemStepper, entry: Command) -> dict[str, Any]:
    """Return the setpoints of a constant command to joints, as keyword arguments of ``send``."""
    if "values" in entry:
        return {target.interfaces.get(entry["control"], "effort"): entry["values"]}
    return {name: entry[name] for name in SETPOINT if name in entry}


class CommandLog:
    """Log of the commands that a program gives to a run; ``onorbit run --commands`` repeats them.

    A log is a context manager: leaving the block closes its file.

    Parameters
    ----------
    file : str or path, optional
        File to which each command is written immediately, one JSON object per line; an existing file is
        overwritten. Default: the commands are kept in memory only.

    Attributes
    ----------
    entries : list of dict
        Commands so far.
    """

    def __init__(self, file: str | os.PathLike[str] | None = None) -> None:
        """Create an empty log, and open its file if one is given; raise OutputFolderError if that fails."""
        self.entries: list[Command] = []
        self._path = None if file is None else Path(file)
        self._stream = None
        if self._path is not None:
            with output_errors(self._path):
                self._stream = self._path.open("w", encoding="utf-8")

    def __repr__(self) -> str:
        """Return a line with the number of commands and the file."""
        where = "" if self._path is None else f", in {self._path}"
        return f"<CommandLog: {count(len(self.entries), 'command', 'commands')}{where}>"

    def apply(self, stepper: Stepper, *entries: Mapping[str, Any]) -> None:
        """Give a stepper a command, and add it to the log with the current time of the stepper.

        Several commands are given and logged together, or none of them if one is rejected.

        Parameters
        ----------
        stepper : Stepper
            Run that receives the command.
        *entries : mapping
            Command; its ``time`` is replaced by that of the stepper. If there are several, they must be
            constant commands to joints, that is, with ``control`` and without ``trajectory``.

        Raises
        ------
        OnOrbitError
            If a command is rejected, as for :func:`apply`; no command has then been given or logged.
        OutputFolderError
            If the file cannot be written; the commands have then been given.
        """
        commands = [checked({**entry, "time": stepper.time}) for entry in entries]
        if len(commands) > 1:
            for command in commands:
                _check(stepper, command)
        for command in commands:
            give(stepper, command)
        for command in commands:
            self._add(command)

    def _add(self, command: Command) -> None:
        """Add a command to the log, after it was given to the stepper."""
        self.entries.append(command)
        if self._stream is not None and self._path is not None:
            with output_errors(self._path):
                self._stream.write(as_line(command))
                self._stream.flush()

    def close(self) -> None:
        """Close the file; raise OutputFolderError if its last command cannot be written."""
        stream, self._stream = self._stream, None
        if stream is not None and self._path is not None:
            with output_errors(self._path):
                stream.close()

    def __enter__(self) -> Self:
        """Return the log."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close the file."""
        self.close()

    def __len__(self) -> int:
        """Return the number of commands."""
        return len(self.entries)
