"""The engine's reference from the scenario's."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs import _core
from onorbit_rs.scenario.control import HoldReference, LineParabolaReference

if TYPE_CHECKING:
    from numpy.typing import NDArray


def reference_of(
    reference: HoldReference | LineParabolaReference | None, start_pose: NDArray[np.float64]
) -> _core.Hold | _core.LineParabola:
    """What the tool tracks, from its first pose (4, 4) in W; it holds that pose where nothing is given."""
    if isinstance(reference, LineParabolaReference):
        return _core.LineParabola(
            start_pose,
            displacement=np.array(reference.displacement),
            height=np.array(reference.height),
            duration=reference.duration,
        )
    return _core.Hold(start_pose)
