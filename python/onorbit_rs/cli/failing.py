"""How a command ends: all done, at Ctrl-C, at a pipe that was closed, or with one line that says why not."""

from __future__ import annotations

import functools
import os
import sys
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import Any, NoReturn

from onorbit_rs.cli.saying import refuse
from onorbit_rs.exceptions import RunInterrupted
from onorbit_rs.stopping import stopped_by


def ending_well(command: Callable[..., None]) -> Callable[..., None]:
    """The command, with what typer would end in its own way: Ctrl-C, and a pipe that was closed."""

    @functools.wraps(command)
    def guarded(*arguments: Any, **options: Any) -> None:
        try:
            command(*arguments, **options)
        except KeyboardInterrupt as stop:
            stopped(stop)
        except BrokenPipeError:
            leave_stdout()

    return guarded


@contextmanager
def as_far_as_read() -> Iterator[None]:
    """Around what is printed by a command that does more: ``| head`` ends the printing, not the command."""
    try:
        yield
        if sys.stdout is not None:
            sys.stdout.flush()
    except BrokenPipeError:
        leave_stdout()


def leave_stdout() -> None:
    """Nothing more goes to a stdout that is closed or full, not even when Python exits."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def fail(message: str, code: int) -> NoReturn:
    """Say it on one line of stderr, and leave with this exit code."""
    if message:
        with suppress(OSError):  # stderr was a terminal that is gone
            refuse(message)
    sys.exit(code)


def stopped(stop: KeyboardInterrupt) -> NoReturn:
    """Say what a signal ended and what is there of it, and leave with the exit code of that signal."""
    name, code = stopped_by(stop)
    said = str(stop) if isinstance(stop, RunInterrupted) else f"stopped by {name}"
    fail("; ".join([said, *getattr(stop, "__notes__", ())]), code)


def of_controller(error: Exception) -> str:
    """What a controller of the user's raised, and where."""
    frames = traceback.extract_tb(error.__traceback__)
    where = f" ({frames[-1].filename}:{frames[-1].lineno})" if frames else ""
    notes = "".join(f"; {note}" for note in getattr(error, "__notes__", ()))
    return f"the controller raised {type(error).__name__}{where}: {error}{notes}"
