"""Garbage collection and thread priority of a node that runs in real time."""

from __future__ import annotations

import gc
import os
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager

_YOUNG = 700
"""Number of new objects after which garbage is collected, as in Python's own collector."""
_SLACK_S = 5e-4
"""Time until the next tick, s, that suffices for a collection of new objects."""
_TOO_MANY = 50 * _YOUNG
"""Number of new objects after which a collection does not wait for slack."""


@contextmanager
def collected_in_slack() -> Iterator[Callable[[float], None]]:
    """Disable automatic garbage collection in the block, since it may pause the program for 30 ms.

    Yields a function to be called with the time, s, until the next tick. If there are many new objects and
    the time suffices, or if there are very many, the function collects those that are garbage. Garbage that
    has survived such a collection is collected after the block.
    """

    def tidy(slack: float) -> None:
        count = gc.get_count()[0]
        if count > _YOUNG and (slack > _SLACK_S or count > _TOO_MANY):
            gc.collect(1)

    was_enabled = gc.isenabled()
    gc.collect(1)
    gc.disable()
    try:
        yield tidy
    finally:
        if was_enabled:
            gc.enable()


@contextmanager
def prioritized(is_wanted: bool) -> Iterator[bool]:
    """Give this thread real-time priority (``SCHED_FIFO``) in the block; warn where this is not possible.

    Yields whether the thread has the priority. Threads that are started in the block inherit it.
    """
    if not is_wanted:
        yield False
        return
    try:
        before = os.sched_getscheduler(0), os.sched_getparam(0)
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(os.sched_get_priority_min(os.SCHED_FIFO)))
    except (AttributeError, OSError) as error:
        reason = getattr(error, "strerror", None) or "only Linux supports it"
        warnings.warn(
            f"the node runs without real-time priority ({reason}); on Linux, a line such as "
            "'@users - rtprio 1' in /etc/security/limits.conf allows it",
            UserWarning, stacklevel=4,
        )  # fmt: skip
        yield False
        return
    try:
        yield True
    finally:
        os.sched_setscheduler(0, *before)
