"""Pace of a node: simulated time follows the wall clock, runs as fast as possible, or waits for steps."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

PACES = ("real_time", "fast", "stepped")

_BEHIND_S = 0.1
"""Delay after which a node in real time stops catching up, s."""


_SHORTEST_S = 1e-7
"""Delays below this, s, are counted together."""
_PER_E = 100.0
"""Classes of delays in a factor of e: quantiles are accurate to a hundredth."""
_CLASSES = 2500


class Delays:
    """Distribution of delays, in classes of equal ratio, so that its size does not grow with the run."""

    def __init__(self, limit: float) -> None:
        """Count none yet; those above ``limit``, s, are missed ticks."""
        self._limit = limit
        self._counts = np.zeros(_CLASSES, np.int64)
        self.count = self.missed = 0
        self.largest = 0.0

    def add(self, delay: float) -> None:
        """Count a delay, s."""
        number = int(_PER_E * math.log(delay / _SHORTEST_S)) if delay > _SHORTEST_S else 0
        self._counts[min(number, _CLASSES - 1)] += 1
        self.count += 1
        self.missed += delay > self._limit
        self.largest = max(self.largest, delay)

    def quantile(self, fraction: float) -> float:
        """Return a delay, s, that this fraction of all delays does not exceed, to a hundredth."""
        number = int(np.searchsorted(np.cumsum(self._counts), fraction * self.count))
        return min(_SHORTEST_S * math.exp((number + 0.5) / _PER_E), self.largest)


@dataclass
class RealTime:
    """Waits until the wall clock has reached a simulated time; measures how late it was."""

    tick: float
    """Simulated time between two waits, s."""
    slipped: float = 0.0
    """Wall-clock time by which the simulation has fallen behind for good, s."""
    clock: Callable[[], float] = time.perf_counter
    sleep: Callable[[float], None] = time.sleep
    _start: float = math.nan
    _late: Delays = field(init=False)

    def __post_init__(self) -> None:
        """Count no delay yet."""
        self._late = Delays(self.tick)

    def restart(self, t: float) -> None:
        """Let the current wall-clock time be the simulated time ``t``, s; after a pause or a reset."""
        self._start = self.clock() - t

    def wait(self, t: float) -> None:
        """Return when simulated time ``t``, s, is due."""
        if math.isnan(self._start):
            self.restart(t)
        while (ahead := self._start + t - self.clock()) > 0.0:
            self.sleep(ahead)
        self._late.add(-ahead)
        if -ahead > _BEHIND_S:
            self.slipped -= ahead
            self.restart(t)

    def report(self) -> dict[str, float]:
        """Return how late the node was, s, and the fraction of ticks missed by a tick or more."""
        late = self._late
        if not late.count:
            return {}
        return {
            "late_median_s": late.quantile(0.5), "late_99_s": late.quantile(0.99), "late_max_s": late.largest,
            "missed": late.missed / late.count, "slipped_s": self.slipped, "ticks": late.count,
        }  # fmt: skip
