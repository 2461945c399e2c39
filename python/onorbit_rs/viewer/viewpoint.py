"""Camera position, and positions of labels beside the robot."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
import rerun.blueprint as rrb

from onorbit_rs.common.coordinates import POSITION, QUATERNION
from onorbit_rs.common.decimate import evenly_spaced
from onorbit_rs.common.rotations import matrix_from_quaternion

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs.viewer.setting import Setting
    from onorbit_rs.viewer.trace_rows import TraceRows

    Floats = NDArray[np.float64]

TO_EYE = np.array([0.5, -0.8, 0.34])
"""Direction from the robot to the camera in base axes: front, right and a little above."""

_NEAR = 4.0
"""Largest distance, in sizes of the robot, at which a target is included in the initial view."""

_POSES = 12
"""Number of rows from which the size of the robot is computed."""


@dataclass(frozen=True)
class Viewpoint:
    """Size and centre of the robot, m, in the frame ``follow``; they determine the camera's position."""

    size: float
    center: Floats
    rot_fb: Floats
    """Rotation from base axes to the axes of ``follow`` at the start."""
    to_eye: Floats = field(default_factory=TO_EYE.copy)
    """Direction to the camera in base axes."""

    @classmethod
    def of(cls, rows: TraceRows, setting: Setting) -> Viewpoint:
        """Return the viewpoint for the robot's extent in these rows and its attitude in the first row."""
        q = rows["q"][0]
        center, size = setting.extent(rows["q"][evenly_spaced(len(rows), _POSES)])
        quat = q[QUATERNION] if rows.quat_lb is None else rows.quat_lb[0]
        rot_fb = matrix_from_quaternion(quat)
        center = rot_fb @ center
        for target in setting.targets:  # targets nearby are included
            aside = (
                rot_fb @ matrix_from_quaternion(q[QUATERNION]).T @ (target.position - q[POSITION]) - center
            )
            reach = float(np.linalg.norm(aside)) + float(np.linalg.norm(target.size)) / 2.0
            if size / 2.0 < reach < _NEAR * size:
                center, size = center + aside / 2.0 * (1.0 - size / 2.0 / reach), size / 2.0 + reach
        return cls(size, center, rot_fb)

    def place(self, right: float, up: float, behind: float = 0.0) -> Floats:
        """Return the position (3,) of a point in the frame ``follow``, m.

        Its coordinates on the screen, and behind the centre of the robot, are in units of the robot's size.
        """
        x, y, z = self.sight()
        place: Floats = self.center + self.size * (right * x + up * y - behind * z)
        return place

    def beside_tool(self, rows: TraceRows, setting: Setting) -> Floats:
        """Return the position of the tool's label in axes of the tool, m: away from the robot and upwards."""
        pose = setting.tool_pose(rows["q"][evenly_spaced(len(rows), _POSES)])
        off = pose[:, :3, 3] - self.rot_fb.T @ self.center
        sight = self.to_eye / np.linalg.norm(self.to_eye)
        off -= np.outer(off @ sight, sight)  # projected onto the screen
        off = off / np.linalg.norm(off, axis=1, keepdims=True).clip(1e-9) + [0.0, 0.0, 1.0]
        direction = np.einsum("kji,kj->i", pose[:, :3, :3], off)
        place: Floats = 0.11 * self.size * direction / max(float(np.linalg.norm(direction)), 1e-9)
        return place

    def sight(self) -> Floats:
        """Return unit vectors (3, 3) to the right, up, and towards the camera at the start."""
        to_eye = self.rot_fb @ self.to_eye
        to_eye /= np.linalg.norm(to_eye)
        right = np.cross(self.rot_fb[:, 2], to_eye)
        right /= np.linalg.norm(right)
        return np.stack([right, np.cross(to_eye, right), to_eye])

    def eye(self) -> rrb.EyeControls3D:
        """Return a camera in direction ``to_eye`` that shows all bodies; z of the base is up at first."""
        return rrb.EyeControls3D(
            position=self.place(0.0, 0.0, -1.18), look_target=self.center, eye_up=self.rot_fb[:, 2]
        )

    @property
    def inertial_at(self) -> Floats:
        """Position (3,) of the axes of I in the frame ``follow``, m."""
        return self.place(-0.8, 0.32)

    @property
    def base_at(self) -> Floats:
        """Position (3,) of the axes of the base in the frame ``follow``, m, beside the robot."""
        return self.place(-0.8, -0.02)

    @property
    def local_at(self) -> Floats:
        """Position (3,) of the axes of L in the frame ``follow``, m."""
        return self.place(-0.8, -0.36)
