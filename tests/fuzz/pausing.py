"""A controller that lets a short run leave a checkpoint, on a machine of any speed."""

from __future__ import annotations

import time
from typing import Any, ClassVar

import numpy as np


class Pausing:
    """No efforts; while ``stops`` is set, the first update takes long and one half-way is a Ctrl-C."""

    stops: ClassVar[bool] = False
    """Of the class: no part of what a checkpoint keeps."""

    def __init__(self) -> None:
        self.updates = 0

    def update(self, t: float, state: Any) -> Any:
        """Return no efforts, for a body without joints."""
        if self.stops:
            if self.updates == 0:
                time.sleep(0.06)  # the first checkpoint comes after 0.05 s at the earliest
            if t > 0.2:
                raise KeyboardInterrupt
        self.updates += 1
        return np.zeros(0)
