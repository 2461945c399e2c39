"""Reference of a tool from a table of poses."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from onorbit_rs import _core
from onorbit_rs.common.rotations import matrix_from_quaternion
from onorbit_rs.scenario.csv_table import read_table
from onorbit_rs.scenario.fields import FilePath
from onorbit_rs.scenario.reference.task import TaskReference

if TYPE_CHECKING:
    from onorbit_rs.scenario.reference.start import Start

COLUMNS = {
    "time": ("time",),
    "position": ("x", "y", "z"),
    "attitude": ("qx", "qy", "qz", "qw"),
    "velocity": ("vx", "vy", "vz", "wx", "wy", "wz"),
}
"""Groups of columns of the CSV file, in SI units."""


class SampledReference(TaskReference):
    """Poses from a CSV file with the header ``time,x,y,z,qx,qy,qz,qw``, optionally ``vx,vy,vz,wx,wy,wz``."""

    kind: Literal["sampled"] = "sampled"
    file: FilePath
    """CSV file with values in SI units; its path is relative to the scenario."""
    relative: bool = False
    """Whether the motion is transformed rigidly so that it begins at the pose ``start``."""

    def build(self, at: Start) -> _core.Sampled:
        """Return the engine's reference object."""
        start = self.first_pose(at)
        table = read_table(at.folder / self.file, COLUMNS, ("time", "position", "attitude"))
        quats, velocities = table["attitude"], table.get("velocity")
        poses = np.tile(np.eye(4), (len(quats), 1, 1))
        poses[:, :3, :3] = matrix_from_quaternion(quats / np.linalg.norm(quats, axis=1, keepdims=True))
        poses[:, :3, 3] = table["position"]
        if self.relative:
            turn = start[:3, :3] @ poses[0, :3, :3].T
            poses[:, :3, 3] = start[:3, 3] + (poses[:, :3, 3] - poses[0, :3, 3]) @ turn.T
            poses[:, :3, :3] = turn @ poses[:, :3, :3]
            if velocities is not None:
                velocities = np.concatenate([velocities[:, :3] @ turn.T, velocities[:, 3:] @ turn.T], axis=1)
        frame = self.engine_frame()
        return _core.Sampled(table["time"].ravel(), poses, velocities=velocities, frame=frame)
