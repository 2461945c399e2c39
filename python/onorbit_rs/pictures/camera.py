"""Perspective camera, and its placement so that a scene fills the picture."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

FIELD_OF_VIEW_DEG = 35.0
"""Vertical angle of view, degrees."""

NEAREST = 1e-3
"""Distance along the line of sight below which nothing is drawn, m."""

_FILLED = 0.82
"""Fraction of the picture that the scene fills in width or height."""


@dataclass(frozen=True)
class Camera:
    """Pinhole camera.

    Attributes
    ----------
    position : (3,) array
        Position in the axes of the scene, m.
    axes : (3, 3) array
        Unit vectors to the right, up, and backwards, as rows, in axes of the scene.
    width, height : int
        Size of the picture, pixels.
    """

    position: Floats
    axes: Floats
    width: int
    height: int

    @classmethod
    def looking(cls, eye: Floats, at: Floats, up: Floats, size: tuple[int, int]) -> Camera:
        """Return a camera at ``eye``, m, that looks at the point ``at``, m, with ``up`` upwards."""
        back = (eye - at) / np.linalg.norm(eye - at)
        right = np.cross(up, back)
        if np.linalg.norm(right) < 1e-6:  # the camera looks along ``up``
            right = np.cross(np.roll(up, 1), back)
        right /= np.linalg.norm(right)
        return cls(eye, np.stack([right, np.cross(back, right), back]), *size)

    @classmethod
    def around(cls, points: Floats, direction: Floats, up: Floats, size: tuple[int, int]) -> Camera:
        """Return a camera that lies in a direction from points (k, 3), m, and has all of them in view."""
        center = (points.min(axis=0) + points.max(axis=0)) / 2.0
        view = cls.looking(center + direction, center, up, size)
        x, y, z = ((points - center) @ view.axes.T).T
        # d - z is the depth of a point, and |x| / (d - z) at most the tangent of the filled half angle
        tangents = _FILLED * np.array([view.width, view.height]) / 2.0 / view.focal
        distance = max(float((z + np.abs(x) / tangents[0]).max()), float((z + np.abs(y) / tangents[1]).max()))
        return cls(center + distance * view.axes[2], view.axes, *size)

    @property
    def focal(self) -> float:
        """Focal length, pixels."""
        return self.height / 2.0 / float(np.tan(np.radians(FIELD_OF_VIEW_DEG) / 2.0))

    def enlarged(self, times: int) -> Camera:
        """Return the same camera with ``times`` as many pixels in width and in height."""
        return Camera(self.position, self.axes, times * self.width, times * self.height)

    def project(self, points: Floats) -> Floats:
        """Return pixels x (to the right) and y (down) and the inverse depth, 1/m, of points (..., 3), m.

        The inverse depth is zero for a point that is not in front of the camera; its pixel is meaningless.
        """
        x, y, z = np.moveaxis((points - self.position) @ self.axes.T, -1, 0)
        with np.errstate(divide="ignore", invalid="ignore"):
            inverse = np.where(-z > NEAREST, -1.0 / z, 0.0)
        return np.stack(
            [
                self.width / 2.0 + self.focal * x * inverse,
                self.height / 2.0 - self.focal * y * inverse,
                inverse,
            ],
            axis=-1,
        )

    def rays(self, rows: NDArray[np.int64]) -> Floats:
        """Return the directions (k, width, 3), not normalized, through the centres of pixels in k rows."""
        x = (np.arange(self.width) + 0.5 - self.width / 2.0) / self.focal
        y = (self.height / 2.0 - rows - 0.5) / self.focal
        right, up, back = self.axes
        directions: Floats = x[None, :, None] * right + y[:, None, None] * up - back
        return directions
