"""Handles SIGTERM and SIGHUP like Ctrl-C: a run writes its last checkpoint and prints how to resume."""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

REPEATS_S = 5.0
"""Wall-clock time, s, during which repeated signals are ignored, so that the final files are complete.

A closing terminal sends SIGHUP twice, from the shell and from the kernel.
"""


class _Handler:
    """Signal handler that raises ``KeyboardInterrupt`` with the name of the signal, unless it is repeated."""

    def __init__(self) -> None:
        self._last = -REPEATS_S

    def __call__(self, number: int, frame: FrameType | None) -> None:
        now = time.monotonic()
        is_repeated, self._last = now - self._last < REPEATS_S, now
        if not is_repeated:
            raise KeyboardInterrupt(signal.Signals(number).name)


@contextmanager
def ending_signals() -> Iterator[None]:
    """Handle SIGTERM and SIGHUP during a block in the main thread, unless already handled or ignored."""
    handler, replaced = _Handler(), []
    if threading.current_thread() is threading.main_thread():
        for name in ("SIGTERM", "SIGHUP"):  # Windows has no SIGHUP
            number = getattr(signal, name, None)
            if number is not None and signal.getsignal(number) == signal.SIG_DFL:
                signal.signal(number, handler)
                replaced.append(number)
    try:
        yield
    finally:
        for number in replaced:
            signal.signal(number, signal.SIG_DFL)
