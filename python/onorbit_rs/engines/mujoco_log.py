"""Disables MuJoCo's log during a step.

MuJoCo would otherwise write warnings about nearly singular matrices to stderr and MUJOCO_LOG.TXT. The log
settings are global to the process, so the log is also disabled in other threads during a step. The user's
settings are restored after the last step in progress has ended.
"""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

_lock = threading.Lock()
_saved: list[Any] = []
"""The user's log settings, one entry for each engine that is in a step."""


@contextmanager
def without_log(mujoco: Any) -> Iterator[None]:
    """Disable the log while any block is active; concurrent blocks may end in any order."""
    with _lock:
        saved = _saved[0] if _saved else mujoco.MjLogConfig.get()
        if not _saved:
            quiet = mujoco.MjLogConfig.get()
            quiet.logto_console = quiet.logto_file = 0
            quiet.set()
        _saved.append(saved)
    try:
        yield
    finally:
        with _lock:
            _saved.pop()
            if not _saved:
                saved.set()
