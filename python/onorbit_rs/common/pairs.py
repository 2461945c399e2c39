"""Pairs of systems whose distances are shown."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

MOST_PAIRS = 6
"""Number of pairs up to which all are shown; of more pairs, only those with the first system are shown."""


def pairs_of(names: Sequence[str]) -> list[tuple[str, str]]:
    """Return the pairs of systems whose distances are shown.

    These are all pairs or, if there are more than :data:`MOST_PAIRS`, the pairs with the first system.
    """
    pairs = list(combinations(names, 2))
    return pairs if len(pairs) <= MOST_PAIRS else [(names[0], name) for name in names[1:]]
