"""Distribution of the delays of a node in real time."""

from __future__ import annotations

import math

import numpy as np

_SHORTEST_S = 1e-7
"""Delay, s, below which all delays are counted in the first class."""
_PER_E = 100.0
"""Number of classes per factor e of the delay; quantiles are therefore accurate to 1 %."""
_CLASSES = 2500


class Delays:
    """Histogram of delays in classes of constant relative width; its size does not grow with the run."""

    def __init__(self, limit: float) -> None:
        """Create an empty histogram; a delay above ``limit``, s, is a missed tick."""
        self._limit = limit
        self._counts = np.zeros(_CLASSES, np.int64)
        self.count = self.missed = 0
        self.largest = 0.0

    def add(self, delay: float) -> None:
        """Add a delay, s, to the histogram."""
        number = int(_PER_E * math.log(delay / _SHORTEST_S)) if delay > _SHORTEST_S else 0
        self._counts[min(number, _CLASSES - 1)] += 1
        self.count += 1
        self.missed += delay > self._limit
        self.largest = max(self.largest, delay)

    def quantile(self, fraction: float) -> float:
        """Return a delay, s, that a fraction of the delays does not exceed, to a relative error of 1 %."""
        number = int(np.searchsorted(np.cumsum(self._counts), fraction * self.count))
        return min(_SHORTEST_S * math.exp((number + 0.5) / _PER_E), self.largest)
