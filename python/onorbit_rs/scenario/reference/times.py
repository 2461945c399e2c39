"""Check of the times at which a reference passes its points."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs.common.counting import count
from onorbit_rs.scenario.errors import invalid

if TYPE_CHECKING:
    from numpy.typing import NDArray


def check_times(times: list[float] | None, what: str, points: int) -> None:
    """Raise an error if the number of times differs from the number of points."""
    if times is not None and len(times) != points:
        entries = count(len(times), "entry", "entries")
        wanted = count(points, what, f"{what}s")
        raise invalid(
            f"'times' has {entries} for {wanted}; give one time per {what}, without that of the start"
        )


def with_start(times: list[float] | None) -> NDArray[np.float64] | None:
    """Return the times, s, preceded by zero, the time of the start."""
    return None if times is None else np.array([0.0, *times])
