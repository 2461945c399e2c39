"""Pace of a node: simulated time follows the wall clock, runs as fast as possible, or waits for steps."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, field

from onorbit_rs.ros2.delays import Delays

PACES = ("real_time", "fast", "stepped")

_BEHIND_S = 0.1
"""Delay after which a node in real time stops catching up, s."""
_LONGEST_SPIN_S = 3e-4
"""Longest time before a tick in which the processor is kept busy, s."""
_SPIN_PER_TICK = 0.3
"""Longest time before a tick in which the processor is kept busy, as a fraction of the tick."""
_LONGEST_SLEEP_S = 0.05
"""Longest sleep, s, between two readings of the topics while the next tick is not near."""
_BUSY_S = 0.1
"""Simulated time after a missed tick, s, without busy loops, which make Linux prefer other programs."""
_PROBES = 20
"""Number of sleeps with which the delay of the operating system is measured."""
_PROBE_S = 5e-4
"""Length of each sleep of the measurement, s."""


@dataclass
class RealTime:
    """Waits until the wall clock has reached a simulated time, and counts the delays.

    The operating system ends a sleep too late, by some 0.1 ms. The wait is therefore a sleep that ends early,
    by the delay that :meth:`calibrate` measured, and a loop until the exact time.
    """

    tick: float
    """Simulated time between two waits, s."""
    slipped: float = 0.0
    """Sum of the delays that are not caught up, in wall-clock time, s."""
    early: float = 0.0
    """Time before a tick at which the sleep ends, s."""
    clock: Callable[[], float] = time.perf_counter
    sleep: Callable[[float], None] = time.sleep
    _start: float = math.nan
    _calm_at: float = -math.inf
    """Simulated time from which sleeps end early, s."""
    _late: Delays = field(init=False)

    def __post_init__(self) -> None:
        """Create the empty histogram of delays."""
        self._late = Delays(self.tick)

    def calibrate(self) -> None:
        """Measure for about 10 ms how late the operating system ends sleeps, and set ``early``."""
        found = []
        for _ in range(_PROBES):
            begin = self.clock()
            self.sleep(_PROBE_S)
            found.append(self.clock() - begin - _PROBE_S)
        # most sleeps, but not the few that others delay
        usual = sorted(found)[int(0.8 * _PROBES)]
        self.early = min(max(1.5 * usual, 0.0), _LONGEST_SPIN_S, _SPIN_PER_TICK * self.tick)

    def restart(self, t: float) -> None:
        """Assign the simulated time ``t``, s, to the current wall-clock time, after a pause or a reset."""
        self._start = self.clock() - t
        self._calm_at = -math.inf

    def ahead(self, t: float) -> float:
        """Return the wall-clock time, s, until simulated time ``t``, s, is due; negative if it is overdue."""
        if math.isnan(self._start):
            self.restart(t)
        return self._start + t - self.clock()

    def approach(self, t: float) -> bool:
        """Sleep until shortly before simulated time ``t``, s, is due; return False if ``t`` is not yet near.

        A call takes at most 50 ms.
        """
        early = self.early if t >= self._calm_at else 0.0
        while (left := self.ahead(t) - early) > 0.0:
            if left > _LONGEST_SLEEP_S:
                self.sleep(_LONGEST_SLEEP_S)
                return False
            self.sleep(left)
        return True

    def idle(self, t: float, seconds: float) -> None:
        """Sleep while the run waits at simulated time ``t``, s.

        Afterwards, the time until ``t`` is due is the same, but at most one tick, since ``/step`` changes
        ``t``.
        """
        left = min(max(self.ahead(t), 0.0), self.tick)
        self.sleep(seconds)
        self.restart(t - left)

    def wait(self, t: float) -> None:
        """Wait until simulated time ``t``, s, is due; count the delay.

        A delay above 0.1 s is not caught up.
        """
        while not self.approach(t):
            pass
        while (ahead := self.ahead(t)) > 0.0:
            pass
        self._late.add(-ahead)
        if -ahead > _BEHIND_S:
            self.slipped -= ahead
            self.restart(t)
        if -ahead > self.tick:
            self._calm_at = t + _BUSY_S

    def report(self) -> dict[str, float]:
        """Return the entries of :attr:`Node.jitter <onorbit_rs.ros2.Node.jitter>`; empty without ticks."""
        late = self._late
        if not late.count:
            return {}
        return {
            "late_median_s": late.quantile(0.5), "late_99_s": late.quantile(0.99), "late_max_s": late.largest,
            "missed": late.missed / late.count, "slipped_s": self.slipped, "ticks": late.count,
        }  # fmt: skip
