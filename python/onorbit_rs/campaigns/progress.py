"""Progress of a campaign: the numbers of cases and of errors, and the time left."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from onorbit_rs.common.counting import count
from onorbit_rs.common.progress import parts_bar


class CampaignProgress:
    """Counts the cases that have ended, and estimates the time left; call :meth:`add` after every case."""

    def __init__(self, cases: int, done: int, show: Callable[[str, float], None]) -> None:
        """Store the number of all cases, the number of cases that were run before, and the display."""
        self._cases, self._done, self._show = cases, done, show
        self._first, self._began, self._errors = done, time.monotonic(), 0

    def add(self, *, has_error: bool) -> None:
        """Count a case that has ended, and show the progress."""
        self._done += 1
        self._errors += has_error
        self._show(self.text(time.monotonic()), self._done / self._cases)

    def text(self, now: float) -> str:
        """Return the progress as text, such as ``12 of 100 cases, 1 error, 35 s left``."""
        errors = f", {count(self._errors, 'error', 'errors')}" if self._errors else ""
        cases, left = count(self._cases, "case", "cases"), _duration(self._left_s(now))
        return f"{self._done} of {cases}{errors}, {left} left"

    def _left_s(self, now: float) -> float:
        ran = self._done - self._first
        return (now - self._began) / ran * (self._cases - self._done) if ran else 0.0


@contextmanager
def campaign_progress(name: str, cases: int, done: int, *, quiet: bool) -> Iterator[CampaignProgress]:
    """Show the progress of a campaign on stderr during the block, unless ``quiet``."""
    with parts_bar(name, quiet=quiet) as show:
        yield CampaignProgress(cases, done, show)


def _duration(seconds: float) -> str:
    """Return a duration as text in suitable units, such as ``35 s`` or ``2 h 5 min``."""
    if seconds < 90.0:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60.0)
    return f"{minutes} min" if minutes < 90 else f"{minutes // 60} h {minutes % 60} min"
