"""SIGTERM and SIGHUP end a command as Ctrl-C does: a run leaves its last checkpoint and says how to go on."""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

REPEATS_S = 5.0
"""Wall-clock time in which a repeated signal does not interrupt what is written because of the first.

A terminal that closes sends SIGHUP from the shell and from the kernel.
"""


class _Handler:
    """Raises ``KeyboardInterrupt`` with the name of the signal."""

    def __init__(self) -> None:
        self._last = -REPEATS_S

    def __call__(self, number: int, frame: FrameType | None) -> None:
        now = time.monotonic()
        is_repeated, self._last = now - self._last < REPEATS_S, now
        if not is_repeated:
            raise KeyboardInterrupt(signal.Signals(number).name)


@contextmanager
def ending_signals() -> Iterator[None]:
    """Handle SIGTERM and SIGHUP within, in the main thread and where nobody else handles or ignores them."""
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
