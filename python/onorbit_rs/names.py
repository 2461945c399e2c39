"""The nearest right name, for error messages."""

from __future__ import annotations

import difflib
from collections.abc import Iterable


def nearest(name: str, known: Iterable[str]) -> str | None:
    """The known name closest to a misspelt one, or None where nothing is close."""
    by_lower = {candidate.lower(): candidate for candidate in known}
    found = difflib.get_close_matches(str(name).lower(), by_lower, n=1, cutoff=0.55)
    return by_lower[found[0]] if found else None


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """``", did you mean 'tool'?"``, or the known names where none is close and they are few."""
    known = list(known)
    suggestion = nearest(name, known)
    if suggestion is not None:
        return f", did you mean {suggestion!r}?"
    return f", known are: {', '.join(known)}" if 0 < len(known) <= 12 else ""
