"""Where the robot is looked at from, and where notes stand beside it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import rerun.blueprint as rrb

from onorbit_rs.rotations import matrix_from_quaternion
from onorbit_rs.thinning import evenly

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs.viewer.rows import Rows
    from onorbit_rs.viewer.setting import Setting

    Floats = NDArray[np.float64]

_TO_EYE = np.array([0.5, -0.8, 0.34])
"""Base axes: from the front, the right and a little above."""

_NEAR = 4.0
"""A target farther away than so many sizes of the robot does not move the eye back."""

_POSES = 12
"""Moments of a run that are looked at."""


@dataclass(frozen=True)
class Stage:
    """How large the robot is, and where it is looked at from: m, in ``follow``."""

    size: float
    center: Floats
    rot_fb: Floats
    """From base axes to those of ``follow`` at the start."""

    @classmethod
    def of(cls, rows: Rows, setting: Setting) -> Stage:
        """From where the robot reaches within these rows, and how the base stands in the first."""
        q = rows["q"][0]
        center, size = setting.extent(rows["q"][evenly(len(rows), _POSES)])
        quat = q[3:7] if rows.quat_lb is None else rows.quat_lb[0]
        rot_fb = matrix_from_quaternion(quat)
        center = rot_fb @ center
        for target in setting.targets:  # one that is near is seen too
            aside = rot_fb @ matrix_from_quaternion(q[3:7]).T @ (target.position - q[:3]) - center
            reach = float(np.linalg.norm(aside)) + float(np.linalg.norm(target.size)) / 2.0
            if size / 2.0 < reach < _NEAR * size:
                center, size = center + aside / 2.0 * (1.0 - size / 2.0 / reach), size / 2.0 + reach
        return cls(size, center, rot_fb)

    def place(self, right: float, up: float, behind: float = 0.0) -> Floats:
        """A point beside the robot as it is seen, in units of its size."""
        x, y, z = self._sight()
        place: Floats = self.center + self.size * (right * x + up * y - behind * z)
        return place

    def beside_tool(self, rows: Rows, setting: Setting) -> Floats:
        """Where the tool's name stands in its axes, m: off the robot and upwards, over the whole run."""
        pose = setting.tool_pose(rows["q"][evenly(len(rows), _POSES)])
        off = pose[:, :3, 3] - self.rot_fb.T @ self.center
        sight = _TO_EYE / np.linalg.norm(_TO_EYE)
        off -= np.outer(off @ sight, sight)  # as it is seen
        off = off / np.linalg.norm(off, axis=1, keepdims=True).clip(1e-9) + [0.0, 0.0, 1.0]
        direction = np.einsum("kji,kj->i", pose[:, :3, :3], off)
        place: Floats = 0.11 * self.size * direction / max(float(np.linalg.norm(direction)), 1e-9)
        return place

    def _sight(self) -> Floats:
        """Unit vectors (3, 3): to the right, up, and towards the eye, as seen at the start."""
        to_eye = self.rot_fb @ _TO_EYE
        to_eye /= np.linalg.norm(to_eye)
        right = np.cross(self.rot_fb[:, 2], to_eye)
        right /= np.linalg.norm(right)
        return np.stack([right, np.cross(to_eye, right), to_eye])

    def eye(self) -> rrb.EyeControls3D:
        """Sees the whole robot from its front and a little above; its own z is up at the start."""
        return rrb.EyeControls3D(
            position=self.place(0.0, 0.0, -1.18), look_target=self.center, eye_up=self.rot_fb[:, 2]
        )

    @property
    def inertial_at(self) -> Floats:
        """Where the axes of I are shown."""
        return self.place(-0.8, 0.32)

    @property
    def local_at(self) -> Floats:
        """Where the axes of L are shown."""
        return self.place(-0.8, -0.36)
