"""Signals that stop a node after the message that it is publishing."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

_SIGNALS = ("SIGINT", "SIGTERM", "SIGHUP")


@contextmanager
def noted_stop() -> Iterator[Callable[[], bool]]:
    """Yield a function that returns True after a SIGINT, SIGTERM or SIGHUP that has a handler in Python.

    In the main thread, the first such signal is only noted, so that it does not interrupt a message that is
    being published; a second signal is handled as before the block. In another thread, signals are handled as
    before.
    """
    replaced: dict[int, Callable[[int, FrameType | None], Any]] = {}
    is_noted = False

    def note(number: int, frame: FrameType | None) -> None:
        nonlocal is_noted
        if is_noted:
            replaced[number](number, frame)
        is_noted = True

    if threading.current_thread() is threading.main_thread():
        for name in _SIGNALS:
            number = getattr(signal, name, None)  # Windows has no SIGHUP
            handler = signal.getsignal(number) if number is not None else None
            if number is not None and callable(handler) and not isinstance(handler, signal.Handlers):
                replaced[number] = handler
                signal.signal(number, note)
    try:
        yield lambda: is_noted
    finally:
        for number, handler in replaced.items():
            signal.signal(number, handler)
