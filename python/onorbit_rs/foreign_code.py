"""Announcement of Python files that a scenario brings, before they are executed."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

_PACKAGE = Path(__file__).resolve().parent

listeners: list[Callable[[str], None]] = []
"""Called with the path or module name of the code; the command line prints it."""


def is_foreign(source: str) -> bool:
    """Return whether a file is not one of this package."""
    return not Path(source).resolve().is_relative_to(_PACKAGE)


def announce(source: str) -> None:
    """Call the listeners unless the file is one of this package."""
    if is_foreign(source):
        for listener in listeners:
            listener(source)
