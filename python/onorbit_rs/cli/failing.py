"""What a command says in one line, and how it ends that cannot go on: on stderr, with an exit code."""

from __future__ import annotations

import functools
import io
import os
import sys
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, NoReturn

import typer

from onorbit_rs.exceptions import RunInterrupted
from onorbit_rs.printable import LACKING, printable

RED, YELLOW = typer.colors.RED, typer.colors.YELLOW


def say(line: str) -> None:
    """A line on stdout, whatever names of files and robots it holds."""
    say_all(printable(line))


def say_all(text: str) -> None:
    """On stdout, in its encoding: left to itself typer writes UTF-8 to a terminal of ASCII."""
    typer.echo(text, file=sys.stdout)


def complain(text: str) -> None:
    """On stderr, if it is open."""
    if sys.stderr is not None:
        typer.echo(text, file=sys.stderr)


def in_one_line(message: object) -> str:
    """What is said, with nothing in it that steers a terminal."""
    return printable(" ".join(str(message).split()))


def encode_all() -> None:
    """A letter that the encoding of a stream lacks becomes one it has, instead of an error."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors=LACKING)


def of_controller(error: Exception) -> str:
    """What a controller of the user's raised, and where."""
    frames = traceback.extract_tb(error.__traceback__)
    where = f" ({frames[-1].filename}:{frames[-1].lineno})" if frames else ""
    notes = "".join(f"; {note}" for note in getattr(error, "__notes__", ()))
    return f"the controller raised {type(error).__name__}{where}: {error}{notes}"


def show_warning(message: Warning | str, *_: Any, **__: Any) -> None:
    """One line, without the place in our code."""
    complain(f"{_colored('onorbit: warning:', YELLOW)} {in_one_line(message)}")


def ending_well(command: Callable[..., None]) -> Callable[..., None]:
    """The command, with what typer would end in its own way: Ctrl-C, and a pipe that was closed."""

    @functools.wraps(command)
    def guarded(*arguments: Any, **options: Any) -> None:
        try:
            command(*arguments, **options)
        except RunInterrupted as stop:
            fail(str(stop), 130)
        except KeyboardInterrupt:
            fail("stopped by Ctrl-C", 130)
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
        complain(f"{_colored('onorbit:', RED)} {in_one_line(message)}")
    sys.exit(code)


def _colored(word: str, color: str) -> str:
    """In colour on a terminal, unless its user wants none (https://no-color.org)."""
    wants_none = os.environ.get("NO_COLOR") or os.environ.get("TERM") == "dumb"
    is_terminal = sys.stderr is not None and sys.stderr.isatty()
    return word if wants_none or not is_terminal else typer.style(word, fg=color, bold=True)
