"""Exit codes and final messages of the commands."""

from __future__ import annotations

import functools
import os
import sys
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import Any, NoReturn, TextIO

from onorbit_rs.cli.text_output import print_failure
from onorbit_rs.exceptions import RunInterrupted
from onorbit_rs.simulation.stop_signals import stopped_by


def with_exit_codes(command: Callable[..., None]) -> Callable[..., None]:
    """Wrap a command so that Ctrl-C and a closed pipe end it with this package's exit codes, not typer's."""

    @functools.wraps(command)
    def guarded(*arguments: Any, **options: Any) -> None:
        try:
            command(*arguments, **options)
        except KeyboardInterrupt as stop:
            exit_stopped(stop)
        except BrokenPipeError:
            discard_stdout()

    return guarded


@contextmanager
def ignore_closed_pipe() -> Iterator[None]:
    """Discard output once the pipe is closed (``| head``), so that the command continues."""
    try:
        yield
        if sys.stdout is not None:
            sys.stdout.flush()
    except BrokenPipeError:
        discard_stdout()


def discard_stdout() -> None:
    """Redirect stdout to the null device, so that Python's exit does not write to a closed or full stdout."""
    _redirect_to_null(sys.stdout)


def _redirect_to_null(stream: TextIO) -> None:
    os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def fail(message: str, code: int) -> NoReturn:
    """Print a message in one line on stderr and exit."""
    if message:
        with suppress(OSError):  # the terminal of stderr was closed
            print_failure(message)
    _discard_unwritable_stderr()
    sys.exit(code)


def _discard_unwritable_stderr() -> None:
    """Redirect a closed stderr to the null device; otherwise, flushing it makes Python exit with code 120."""
    try:
        if sys.stderr is not None:
            sys.stderr.flush()
    except OSError:
        _redirect_to_null(sys.stderr)


def exit_stopped(stop: KeyboardInterrupt) -> NoReturn:
    """Print what stopped the command and which results exist, and exit with the code of the signal."""
    name, code = stopped_by(stop)
    message = str(stop) if isinstance(stop, RunInterrupted) else f"stopped by {name}"
    fail("; ".join([message, *getattr(stop, "__notes__", ())]), code)


def controller_error(error: Exception) -> str:
    """Return the message of an exception that Python code of a run raised, with its location."""
    frames = traceback.extract_tb(error.__traceback__)
    where = f" ({frames[-1].filename}:{frames[-1].lineno})" if frames else ""
    notes = "".join(f"; {note}" for note in getattr(error, "__notes__", ()))
    return f"Python code of the run raised {type(error).__name__}{where}: {error}{notes}"
