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
    _late: list[float] = field(default_factory=list)

    def restart(self, t: float) -> None:
        """Let the current wall-clock time be the simulated time ``t``, s; after a pause or a reset."""
        self._start = self.clock() - t

    def wait(self, t: float) -> None:
        """Return when simulated time ``t``, s, is due."""
        if math.isnan(self._start):
            self.restart(t)
        while (ahead := self._start + t - self.clock()) > 0.0:
            self.sleep(ahead)
        self._late.append(-ahead)
        if -ahead > _BEHIND_S:
            self.slipped -= ahead
            self.restart(t)

    def report(self) -> dict[str, float]:
        """Return how late the node was, s, and the fraction of ticks missed by a tick or more."""
        if not self._late:
            return {}
        late = np.array(self._late)
        median, high = np.quantile(late, [0.5, 0.99])
        return {
            "late_median_s": float(median), "late_99_s": float(high), "late_max_s": float(late.max()),
            "missed": float(np.mean(late > self.tick)), "slipped_s": self.slipped, "ticks": len(late),
        }  # fmt: skip
