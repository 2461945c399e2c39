"""Intervals of time in which a distance is negative."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Violation:
    """Interval in which links overlap, or are in a keep-out zone.

    Attributes
    ----------
    links : (str, str)
        Deepest pair; the first entry is the name of the zone for a keep-out zone.
    entry, exit : float or None
        Start and end of the interval, s, interpolated linearly between rows; None for a start before the
        first row or an end after the last row.
    depth : float
        Largest depth in a row, m.
    time : float
        Time of this row, s.
    """

    links: tuple[str, str]
    entry: float | None
    exit: float | None
    depth: float
    time: float


def violations(time: Floats, gap: Floats, links: Sequence[tuple[str, str]]) -> Iterator[Violation]:
    """Yield the intervals in which ``gap`` (T,), m, is negative.

    ``links`` holds the nearest pair of links in each row.
    """
    inside = np.concatenate([[False], gap < 0.0, [False]])
    edges = np.flatnonzero(inside[1:] != inside[:-1])
    for first, end in zip(edges[::2], edges[1::2], strict=True):
        deepest = int(first + np.argmin(gap[first:end]))
        yield Violation(
            links[deepest],
            _crossing(time, gap, first - 1) if first > 0 else None,
            _crossing(time, gap, end - 1) if end < len(gap) else None,
            float(-gap[deepest]), float(time[deepest]),
        )  # fmt: skip


def _crossing(time: Floats, gap: Floats, k: int) -> float:
    """Return the time at which the gap is zero between the rows ``k`` and ``k + 1``."""
    return float(time[k] + (time[k + 1] - time[k]) * gap[k] / (gap[k] - gap[k + 1]))
