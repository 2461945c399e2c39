"""Keeps a failing display from hiding its object."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

Shown = TypeVar("Shown")


def or_plain(show: Callable[[Any], Shown], shown: Any) -> Shown | None:
    """Return ``show(shown)``; None, for which notebooks show the plain ``repr``, if it raises an error."""
    try:
        return show(shown)
    except Exception:  # a display is no reason to lose a result
        return None
