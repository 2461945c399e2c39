"""Progress as lines of text, for a stderr that is not a terminal, such as a log file."""

from __future__ import annotations

import sys
import time
from contextlib import suppress

from onorbit_rs.common.printable import printable

FIRST_S = 3.0
"""Wall-clock time before the first line, s; shorter runs print none."""

LONGEST_S = 60.0
"""Longest wall-clock time between two lines, s; each interval is twice the one before, up to this."""


class ProgressLines:
    """Prints lines on stderr at growing intervals."""

    def __init__(self, name: str) -> None:
        """Start the clock of a task that is called ``name`` in each line."""
        self._name = printable(name)
        self._interval_s = FIRST_S
        self._last = time.monotonic()
        self._has_printed = False

    def update(self, text: str) -> None:
        """Print the text if the interval since the last line has passed."""
        if time.monotonic() - self._last >= self._interval_s:
            self._print(text)
            self._interval_s = min(2.0 * self._interval_s, LONGEST_S)

    def begin(self, text: str) -> None:
        """Print the name of a new task, if an earlier line is at least 1 s old or the interval has passed."""
        self._interval_s = FIRST_S
        if self._has_printed and time.monotonic() - self._last >= 1.0:
            self._print(text)
        else:
            self.update(text)

    def _print(self, text: str) -> None:
        self._last, self._has_printed = time.monotonic(), True
        with suppress(OSError, ValueError):  # stderr was closed
            sys.stderr.write(f"onorbit: {self._name}: {printable(text)}\n")
            sys.stderr.flush()
