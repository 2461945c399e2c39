"""A controller that makes a short run write a checkpoint on machines of any speed."""

from __future__ import annotations

import time
from typing import Any, ClassVar

import numpy as np


class Pausing:
    """Controller without efforts.

    While ``stops`` is set, its first update is slow, and an update after 0.2 s raises KeyboardInterrupt.
    """

    stops: ClassVar[bool] = False
    """A class attribute, which is not part of a checkpoint."""

    def __init__(self) -> None:
        self.updates = 0

    def update(self, t: float, state: Any) -> Any:
        """Returns no efforts, for a body without joints."""
        if self.stops:
            if self.updates == 0:
                time.sleep(0.06)  # the first checkpoint is written after 0.05 s or later
            if t > 0.2:
                raise KeyboardInterrupt
        self.updates += 1
        return np.zeros(0)
