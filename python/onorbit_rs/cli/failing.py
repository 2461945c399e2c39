"""How a command ends that cannot go on: one line on stderr, and an exit code."""

from __future__ import annotations

import os
import sys
import traceback
from typing import Any, NoReturn

import typer


def of_controller(error: Exception) -> str:
    """What a controller of the user's raised, and where."""
    frames = traceback.extract_tb(error.__traceback__)
    where = f" ({frames[-1].filename}:{frames[-1].lineno})" if frames else ""
    notes = "".join(f"; {note}" for note in getattr(error, "__notes__", ()))
    return f"the controller raised {type(error).__name__}{where}: {error}{notes}"


def show_warning(message: Warning | str, *_: Any, **__: Any) -> None:
    """One line, without the place in our code."""
    typer.echo(f"onorbit: warning: {' '.join(str(message).split())}", err=True)


def leave_stdout() -> None:
    """Nothing more goes to a stdout that is closed or full, not even when Python exits."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def fail(message: str, code: int) -> NoReturn:
    """Say it on one line of stderr, and leave with this exit code."""
    if message:
        typer.echo(f"onorbit: {' '.join(message.split())}", err=True)
    sys.exit(code)
