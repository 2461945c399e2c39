"""Draws triangles and lines with hidden surfaces removed (a depth buffer)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs.pictures.camera import Camera

    Floats = NDArray[np.float64]

_NEARER = 1.002
"""Factor on the inverse depth of a line, so that a line on a surface is visible."""


class Canvas:
    """Picture of the nearest surface in each pixel.

    ``color`` (height, width, 3) is from 0 to 1. ``inverse_depth`` (height, width), 1/m, is zero where nothing
    was drawn.
    """

    def __init__(self, camera: Camera) -> None:
        """Create an empty canvas for the picture of a camera."""
        self._camera = camera
        self.color = np.zeros((camera.height, camera.width, 3), np.float32)
        self.inverse_depth = np.zeros((camera.height, camera.width))

    def add_triangles(self, corners: Floats, colors: Floats) -> None:
        """Draw triangles (n, 3, 3), m, with colours (n, 3), except those that reach behind the camera."""
        self._fill(self._camera.project(corners), colors)

    def add_line(self, points: Floats, color: Floats, pixels: float) -> None:
        """Draw a line through points (k, 3), m, with a width in pixels."""
        self.add_segments(points[:-1], points[1:], color, pixels)

    def add_segments(self, starts: Floats, ends: Floats, color: Floats, pixels: float) -> None:
        """Draw straight lines from ``starts`` to ``ends``, (k, 3), m, with a width in pixels."""
        start, end = (self._camera.project(points) * [1.0, 1.0, _NEARER] for points in (starts, ends))
        along = end[:, :2] - start[:, :2]
        length = np.linalg.norm(along, axis=1, keepdims=True).clip(1e-9)
        aside = np.zeros_like(start)
        aside[:, :2] = 0.5 * pixels * along[:, ::-1] * [-1.0, 1.0] / length
        a, b, c, d = start - aside, start + aside, end + aside, end - aside
        triangles = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
        self._fill(triangles, np.tile(color, (len(triangles), 1)))

    def _fill(self, projected: Floats, colors: Floats) -> None:
        """Fill triangles (n, 3, 3) of pixels x and y and inverse depth, which is linear in x and y."""
        size = np.array([self._camera.width, self._camera.height])
        low = np.ceil(projected[..., :2].min(axis=1) - 0.5).clip(0, size)
        high = np.ceil(projected[..., :2].max(axis=1) - 0.5).clip(0, size)
        planes = _planes(projected)
        is_drawn = (projected[..., 2] > 0.0).all(axis=1) & (low < high).all(axis=1)
        is_drawn &= np.isfinite(planes).all(axis=(1, 2))
        for index in np.flatnonzero(is_drawn):
            (x0, y0), (x1, y1) = low[index].astype(int), high[index].astype(int)
            x = np.arange(x0, x1) + 0.5
            y = np.arange(y0, y1)[:, None] + 0.5
            weights = [px * x + (py * y + p) for px, py, p in planes[index]]
            part = self.inverse_depth[y0:y1, x0:x1]
            is_visible = np.minimum(np.minimum(weights[0], weights[1]), weights[2]) >= 0.0
            is_visible &= weights[3] > part
            part[is_visible] = weights[3][is_visible]
            self.color[y0:y1, x0:x1][is_visible] = colors[index]


def _planes(projected: Floats) -> Floats:
    """Return the coefficients (n, 4, 3) of x, y and 1 in barycentric coordinates and inverse depth."""
    matrix = projected.copy()
    matrix[..., 2] = 1.0
    # rows of the inverse of [[x0, y0, 1], [x1, y1, 1], [x2, y2, 1]], transposed, are the coordinates
    a, b, c = np.moveaxis(matrix, 1, 0)
    cofactors = np.stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)], axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        weights = cofactors / np.einsum("ni,ni->n", a, cofactors[:, 0])[:, None, None]
    depth = np.einsum("nk,nki->ni", projected[..., 2], weights)
    return np.concatenate([weights, depth[:, None]], axis=1)
