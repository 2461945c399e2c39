"""Prints text on stdout and stderr, for any content and any encoding of the terminal."""

from __future__ import annotations

import io
import os
import sys
from typing import Any

import typer

from onorbit_rs.common.printable import LACKING, printable

RED, YELLOW = typer.colors.RED, typer.colors.YELLOW


def print_line(line: str) -> None:
    """Print one line on stdout, with control characters escaped."""
    print_text(printable(line))


def print_text(text: str) -> None:
    """Print text on stdout in its encoding; typer alone would write UTF-8 to an ASCII terminal."""
    typer.echo(text, file=sys.stdout)


def print_error(text: str) -> None:
    """Print text on stderr, if it is open."""
    if sys.stderr is not None:
        typer.echo(text, file=sys.stderr)


def print_failure(message: str) -> None:
    """Print the error that ends a command, in one line."""
    print_error(f"{_colored('onorbit:', RED)} {_in_one_line(message)}")


def show_warning(message: Warning | str, *_: Any, **__: Any) -> None:
    """Print a warning on one line, without its location in the code."""
    print_error(f"{_colored('onorbit: warning:', YELLOW)} {_in_one_line(message)}")


def _in_one_line(message: object) -> str:
    """Return a message in one line, with control characters escaped."""
    return printable(" ".join(str(message).split()))


def escape_unencodable() -> None:
    """Set stdout and stderr to replace characters missing from their encoding, instead of raising."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors=LACKING)


def _colored(word: str, color: str) -> str:
    """Return a word in colour if stderr is a terminal and colours are not disabled (https://no-color.org)."""
    is_disabled = os.environ.get("NO_COLOR") or os.environ.get("TERM") == "dumb"
    is_terminal = sys.stderr is not None and sys.stderr.isatty()
    return word if is_disabled or not is_terminal else typer.style(word, fg=color, bold=True)
