"""Announces the user's Python files before a scenario executes them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

_PACKAGE = Path(__file__).resolve().parents[1]

listeners: list[Callable[[str], None]] = []
"""Callbacks that receive the path or module name of the code; the command line prints that name."""


def is_foreign(source: str) -> bool:
    """Return whether a file lies outside this package."""
    return not Path(source).resolve().is_relative_to(_PACKAGE)


def announce(source: str) -> None:
    """Call the listeners with a file or module, unless it is part of this package."""
    if is_foreign(source):
        for listener in listeners:
            listener(source)
