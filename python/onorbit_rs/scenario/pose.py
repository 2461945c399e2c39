"""Pose of a frame relative to its parent frame."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from pydantic import Field

from onorbit_rs.common.rotations import matrix_from_quaternion
from onorbit_rs.scenario.attitude import Attitude, quaternion_of
from onorbit_rs.scenario.fields import Length3
from onorbit_rs.scenario.part import Part

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]


class Pose(Part):
    """Position and attitude of a frame relative to its parent frame; by default the frames coincide."""

    position: Length3 = Field(default_factory=lambda: [0.0, 0.0, 0.0])
    attitude: Attitude | None = None

    def transform(self) -> Floats:
        """Return the pose in the parent frame as a homogeneous matrix (4, 4), m."""
        pose = np.eye(4)
        pose[:3, :3], pose[:3, 3] = matrix_from_quaternion(quaternion_of(self.attitude)), self.position
        return pose
