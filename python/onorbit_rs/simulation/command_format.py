"""Format of the commands of a run: entries of a file with one JSON object per line.

An entry has the simulated ``time``, s, and, in a world of several systems, the ``system``. The other keys are

- ``control`` with ``position``, ``velocity``, ``acceleration`` or ``effort``: :meth:`Stepper.send`; or with
  ``values``, the setpoints of the quantity that the control tracks (:attr:`Stepper.interfaces`);
- ``control`` with ``trajectory``, a mapping of ``times``, ``positions``, ``velocities``, ``accelerations``
  and ``start``: :meth:`Stepper.send_trajectory`;
- ``body`` with ``force``, ``torque`` and ``frame``: :meth:`Stepper.wrench`;
- ``trigger``, the name of an event (without ``system``): :meth:`Stepper.trigger`.
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from onorbit_rs.common.input_files import read_bytes
from onorbit_rs.common.suggestions import did_you_mean
from onorbit_rs.exceptions import InputError, NotFoundError

SETPOINT = ("position", "velocity", "acceleration", "effort")
TRAJECTORY = ("times", "positions", "velocities", "accelerations", "start")
_KINDS: dict[str, tuple[str, ...]] = {
    "control": ("system", "control", *SETPOINT, "values", "trajectory"),
    "body": ("system", "body", "force", "torque", "frame"),
    "trigger": ("trigger",),
}
_TRAJECTORY_KINDS = {"start": "a finite number of seconds", "times": "a list of finite numbers"}
_LARGEST = sys.float_info.max
_MOST = 1 << 30
"""Largest size of a file of commands, bytes."""


class Command(dict[str, Any]):
    """A valid command; ``where`` is its location in a file, such as ``commands.jsonl:3``."""

    where: str = ""

    @property
    def time(self) -> float:
        """Simulated time of the command, s."""
        return float(self["time"])


def checked(entry: Mapping[str, Any], where: str = "") -> Command:
    """Return an entry as a command with plain numbers; raise InputError for invalid keys or values."""
    if not isinstance(entry, Mapping):
        raise invalid(where, f'a command must be a mapping such as {{"time": 1.0, …}}, not {entry!r:.40}')
    command = Command({key: _plain(value) for key, value in entry.items()})
    command.where = where
    kinds = [kind for kind in _KINDS if kind in command]
    if len(kinds) != 1:
        given = " and ".join(repr(kind) for kind in kinds) or "none of them"
        keys = "'control', 'body' and 'trigger'"
        raise invalid(where, f"a command must have exactly one of the keys {keys}, but this one has {given}")
    known = ("time", *_KINDS[kinds[0]])
    for key in command:
        if key not in known:
            raise invalid(
                where, f"{key!r} is not a key of a command with '{kinds[0]}'{did_you_mean(key, known)}"
            )
    for key in ("system", "control", "body", "trigger", "frame"):
        if not isinstance(command.get(key, ""), str):
            raise invalid(where, f"'{key}' is {command[key]!r:.60}; it must be a name (text)")
    time: Any = command.get("time")
    if not _is_number(time) or time < 0.0:
        given = f"is {time!r}" if "time" in command else "is missing"
        raise invalid(where, f"'time' {given}; it must be a finite number of seconds, at least 0")
    for key in (*SETPOINT, "values", "force", "torque"):
        if key in command and not _is_array(command[key]):
            raise invalid(where, f"'{key}' must be a list of finite numbers, not {command[key]!r:.60}")
    if "trajectory" in command:
        _check_trajectory(command)
    content = [name for name in (*SETPOINT, "values", "trajectory") if name in command]
    if "control" in command and not content:
        options = ", ".join((*SETPOINT, "values"))
        raise invalid(where, f"the command has no setpoint; give {options} or trajectory")
    if len(content) > 1 and not set(content) <= set(SETPOINT):
        raise invalid(where, f"the command has both {content[0]!r} and {content[-1]!r}; give one of them")
    return command


def _check_trajectory(command: Command) -> None:
    path, where = command["trajectory"], command.where
    if not isinstance(path, dict) or not {"times", "positions"} <= path.keys():
        message = f"'trajectory' must be a mapping with 'times' and 'positions', not {path!r:.60}"
        raise invalid(where, message)
    for key, value in path.items():
        if key not in TRAJECTORY:
            raise invalid(where, f"{key!r} is not a key of 'trajectory'{did_you_mean(key, TRAJECTORY)}")
        fits = _is_number(value) if key == "start" else _is_array(value)
        if not fits:
            kind = _TRAJECTORY_KINDS.get(key, "a list with one row of finite numbers per time")
            raise invalid(where, f"'{key}' of the trajectory must be {kind}, not {value!r:.60}")


def read_commands(file: str | os.PathLike[str]) -> list[Command]:
    """Read a file of commands, one JSON object per line; empty lines are ignored.

    Parameters
    ----------
    file : str or path
        File with one command per line.

    Returns
    -------
    list of dict
        Commands in the order of their times.

    Raises
    ------
    NotFoundError, ReadError
        If the file does not exist or cannot be read.
    InputError
        If the file is not UTF-8 text, a line is not a valid command, or times decrease; for an error in a
        line, the message contains the number of the line.
    """
    path = Path(file)
    if not path.is_file():
        raise NotFoundError(
            f"the command file {path} does not exist or is not a regular file; check the path",
            path=str(path),
            kind="commands",
        )
    content = read_bytes(path, _MOST, "commands")
    try:
        text = content.decode()
    except UnicodeDecodeError as error:
        raise invalid(
            str(path), f"the file is not UTF-8 text (byte {error.start} is invalid); save it as UTF-8"
        ) from None
    return parse_commands(text, str(path))


def parse_commands(text: str, name: str) -> list[Command]:
    """Return the commands in ``text``, the content of the file ``name``; error messages contain the name."""
    commands: list[Command] = []
    for number, line in enumerate(text.splitlines(), 1):
        if not line.strip():
            continue
        where = f"{name}:{number}"
        try:
            entry = json.loads(line, parse_constant=_not_finite)
        except (ValueError, RecursionError) as error:
            reason = str(error)
            if isinstance(error, json.JSONDecodeError):
                reason = f"{error.msg} at column {error.colno}"
            raise invalid(where, f"the line is not valid JSON: {reason}; correct it") from None
        if not isinstance(entry, dict) or "time" not in entry:
            message = "each line must be a JSON object with the key 'time', the simulated time in s"
            raise invalid(where, f"{message}, not {line.strip()!r:.60}")
        commands.append(checked(entry, where))
    return in_order(commands)


def in_order(commands: Iterable[Command]) -> list[Command]:
    """Return the commands as a list; raise InputError if a time is earlier than the previous one."""
    found: list[Command] = []
    for command in commands:
        if found and command.time < found[-1].time:
            raise invalid(
                command.where,
                f"time {command.time!r} s is before that of the previous command, {found[-1].time!r} s; sort "
                "the commands by time",
            )
        found.append(command)
    return found


def as_line(command: Mapping[str, Any]) -> str:
    """Return a command as a line of a file, with enough digits to read every float back exactly."""
    return json.dumps(command, allow_nan=False) + "\n"


def _plain(value: Any) -> Any:
    """Return a value with arrays and tuples converted to lists, including those inside mappings."""
    if isinstance(value, Mapping):
        return {key: _plain(entry) for key, entry in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    return [_plain(entry) for entry in value] if isinstance(value, list | tuple) else value


def _is_number(value: Any) -> bool:
    """Return True for a finite number."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    return abs(value) <= _LARGEST  # an integer may be larger than any float


def _is_array(value: Any) -> bool:
    """Return True for a list of finite numbers, which may be nested."""
    if not isinstance(value, list):
        return False
    return all(_is_array(entry) if isinstance(entry, list) else _is_number(entry) for entry in value)


def _not_finite(text: str) -> float:
    raise ValueError(f"{text} is not a finite number")


def invalid(where: str, message: str) -> InputError:
    """Return the error for an invalid command; ``where`` is its location in a file."""
    return InputError(f"{where}: {message}" if where else message, name="commands")
