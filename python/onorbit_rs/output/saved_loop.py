"""Recorded forces of a closed loop, read from a file or from a pickle."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs._core import COLUMNS

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import LoopTrace

    Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class SavedLoop:
    """Closed loop with the attributes of :class:`onorbit_rs.LoopTrace`."""

    values: Floats
    """All quantities, (T, 11), in the order of ``onorbit_rs.COLUMNS``."""

    def __getattr__(self, name: str) -> Floats:
        """Return a quantity of the loop: (T, 3) for a vector, (T, 2) for the opening, m and rad."""
        parts = COLUMNS["loops"].parts
        if name == "values" or name not in parts:
            raise AttributeError(f"a loop has no attribute {name!r}; its quantities are {', '.join(parts)}")
        return self.values[:, parts[name][0]]

    def __len__(self) -> int:
        """Return the number of rows."""
        return len(self.values)


def reduced_loop(loop: LoopTrace) -> tuple[Any, ...]:
    """Return the class and argument that rebuild a loop from a pickle."""
    return SavedLoop, (np.asarray(loop.values),)
