"""Reference that is at rest in inertial axes."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from onorbit_rs import _core
from onorbit_rs.scenario.attitude import Attitude, quaternion_of
from onorbit_rs.scenario.fields import GravitationalParameter, Length3, Positive
from onorbit_rs.scenario.orbit.gravity_mode import GravityMode
from onorbit_rs.scenario.part import Part


class FixedFrameOrbit(Part):
    """Reference frame at rest in inertial axes; it does not orbit the planet."""

    kind: Literal["fixed_frame"] = "fixed_frame"
    position: Length3 = Field(default_factory=lambda: [0.0, 0.0, 0.0])
    attitude: Attitude | None = None
    mu: Annotated[GravitationalParameter, Positive] | None = None
    gravity_mode: GravityMode = "true"

    def build(self, _folder: Path) -> _core.FixedFrame:
        """Return the engine's orbit object."""
        attitude = quaternion_of(self.attitude)
        return _core.FixedFrame(position=np.array(self.position), attitude=attitude, mu=self.mu)
