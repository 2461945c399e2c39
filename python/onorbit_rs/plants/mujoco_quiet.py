"""MuJoCo's warnings, of matrices near singular, go neither to stderr nor to MUJOCO_LOG.TXT during a step.

Its settings of the log belong to the whole process, so other uses of MuJoCo in other threads are quiet for as
long. They are as the user has them as soon as no plant is in a step.
"""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

_lock = threading.Lock()
_within: list[Any] = []
"""What the first of the plants in a step found, once for each of them."""


@contextmanager
def unlogged(mujoco: Any) -> Iterator[None]:
    """Quiet from the first that enters to the last that leaves, in whatever order they do."""
    with _lock:
        loud = _within[0] if _within else mujoco.MjLogConfig.get()
        if not _within:
            quiet = mujoco.MjLogConfig.get()
            quiet.logto_console = quiet.logto_file = 0
            quiet.set()
        _within.append(loud)
    try:
        yield
    finally:
        with _lock:
            _within.pop()
            if not _within:
                loud.set()
