"""One line of text to stdout or stderr, whatever it holds and whatever stands at the other end."""

from __future__ import annotations

import io
import os
import sys
from typing import Any

import typer

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


def refuse(message: str) -> None:
    """What ends a command, in one line."""
    complain(f"{_colored('onorbit:', RED)} {_in_one_line(message)}")


def show_warning(message: Warning | str, *_: Any, **__: Any) -> None:
    """One line, without the place in our code."""
    complain(f"{_colored('onorbit: warning:', YELLOW)} {_in_one_line(message)}")


def _in_one_line(message: object) -> str:
    """What is said, with nothing in it that steers a terminal."""
    return printable(" ".join(str(message).split()))


def encode_all() -> None:
    """A letter that the encoding of a stream lacks becomes one it has, instead of an error."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors=LACKING)


def _colored(word: str, color: str) -> str:
    """In colour on a terminal, unless its user wants none (https://no-color.org)."""
    wants_none = os.environ.get("NO_COLOR") or os.environ.get("TERM") == "dumb"
    is_terminal = sys.stderr is not None and sys.stderr.isatty()
    return word if wants_none or not is_terminal else typer.style(word, fg=color, bold=True)
