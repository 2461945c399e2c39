"""Shows the plain ``repr`` of an object in a notebook if its display fails."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

Shown = TypeVar("Shown")


def or_plain(show: Callable[[Any], Shown], shown: Any) -> Shown | None:
    """Return ``show(shown)``, or None if it raises an error; notebooks then show the plain ``repr``."""
    try:
        return show(shown)
    except Exception:  # the object remains usable if its display fails
        return None
