"""Suggestions of similar names, for error messages."""

from __future__ import annotations

import difflib
from collections.abc import Iterable


def nearest(name: str, known: Iterable[str]) -> str | None:
    """Return the known name that is most similar to a misspelt one, or None."""
    by_lower = {candidate.lower(): candidate for candidate in known}
    lower = str(name).lower()
    found = difflib.get_close_matches(lower, by_lower, n=1, cutoff=0.55)
    # part of exactly one name, such as euler of semi_implicit_euler
    found = found or [candidate for candidate in by_lower if len(lower) > 2 and lower in candidate]
    return by_lower[found[0]] if len(found) == 1 else None


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """Return a suggestion such as ``"; did you mean 'tool'?"`` for a misspelt name.

    If no name is similar, the known names are listed, or, if there are more than 12, the result is empty.
    """
    known = list(known)
    suggestion = nearest(name, known)
    if suggestion is not None:
        return f"; did you mean {suggestion!r}?"
    return f"; known names: {', '.join(known)}" if 0 < len(known) <= 12 else ""
