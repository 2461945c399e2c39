"""One source of checkpoints, two who take them: a viewer often, the writer of checkpoints when one is due."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs import _core

if TYPE_CHECKING:
    from onorbit_rs._core import Checkpoint
    from onorbit_rs.viewer.live import LiveView


class Relay:
    """Hands every checkpoint to a viewer, and to ``writer`` each ``every_s`` what came since then."""

    def __init__(self, live: LiveView, writer: Callable[[Checkpoint], object] | None, every_s: float) -> None:
        """Nothing has come yet."""
        self._live, self._writer, self._every_s = live, writer, every_s
        self._waiting: list[Checkpoint] = []
        self._last = time.monotonic()

    def __call__(self, checkpoint: Checkpoint) -> None:
        """Take one."""
        self._live.take(checkpoint.columns)
        if self._writer is not None:
            self._waiting.append(checkpoint)
            if time.monotonic() - self._last >= self._every_s:
                self.hand_on()

    def hand_on(self) -> None:
        """Give the writer what waits, as one checkpoint."""
        if not self._waiting or self._writer is None:
            return
        last = self._waiting[-1]
        columns = {
            name: np.concatenate([part.columns[name] for part in self._waiting]) for name in last.columns
        }
        self._last = time.monotonic()
        whole = _core.Checkpoint(last.state, columns, wall_s=last.wall_s)
        if self._writer(whole) is False:  # it could not be written: its rows come again with the next
            self._waiting = [whole]
        else:
            self._waiting.clear()
