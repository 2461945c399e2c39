"""Light on surfaces: ambient light, light from the camera, and light of the Sun, which casts shadows."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs.pictures.normals import corner_normals
from onorbit_rs.pictures.raster import Canvas

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs.pictures.camera import Camera

    Floats = NDArray[np.float64]

AMBIENT, FROM_CAMERA, FROM_SUN = 0.24, 0.42, 0.54
"""Largest fractions of the colour of a surface that the lights contribute."""

TEXELS = 1536
"""Width and height of the map of the surfaces that are lit by the Sun, cells."""

CHANNELS = 7
"""Number of components of :func:`lit_colors`."""

_OFFSET = 2.0
"""Distance behind the nearest surface up to which points are lit, in cells, for perpendicular incidence.

It is multiplied by one plus the tangent of the angle of incidence.
"""

_GRAZING = 0.03
"""Cosine of the largest angle of incidence for which the offset increases."""

_ROWS = 64


class SunView:
    """Parallel projection along the rays of the Sun: a map of the surfaces that are nearest to the Sun."""

    def __init__(self, sun: Floats, shown: Floats, casting: Floats) -> None:
        """Fit the map to the points ``shown``, (k, 3), m; ``casting`` are the corners of all faces."""
        aside = np.cross(sun, np.eye(3)[np.argmin(np.abs(sun))])
        aside /= np.linalg.norm(aside)
        self._axes = np.stack([aside, np.cross(sun, aside), sun])
        seen = shown @ self._axes.T
        self._low, high = seen.min(axis=0), seen.max(axis=0)
        self.cell = max(float((high - self._low)[:2].max()), 1e-9) / (TEXELS - 4)
        self._low[:2] -= 2.0 * self.cell
        self._low[2] = min(self._low[2], float((casting @ sun).min()))
        self.width = self.height = TEXELS

    def project(self, points: Floats) -> Floats:
        """Return cells x and y of points (..., 3), m, and their height towards the Sun, in cells.

        The height is counted from one cell below the lowest surface, so that it is positive.
        """
        projected: Floats = (points @ self._axes.T - self._low) / self.cell
        projected[..., 2] += 1.0
        return projected


def lit_colors(faces: Floats, colors: Floats, camera: Camera, sun: Floats) -> Floats:
    """Return the light (n, 4, 7) at the corners of faces (n, 4, 3), m, as seen from the camera.

    The components are the colour without the Sun, the colour that the Sun adds where there is no shadow, and
    the cosine of the angle of incidence.
    """
    normals = corner_normals(faces)
    to_camera = camera.position - faces.mean(axis=1)
    to_camera /= np.maximum(np.linalg.norm(to_camera, axis=1, keepdims=True), 1e-30)
    flat = np.cross(faces[:, 2] - faces[:, 0], faces[:, 3] - faces[:, 1])
    normals *= np.where(np.einsum("ni,ni->n", flat, to_camera) < 0.0, -1.0, 1.0)[:, None, None]
    facing = np.einsum("nki,ni->nk", normals, to_camera).clip(0.0)
    cosine = (normals @ sun).clip(0.0)
    light = np.stack([AMBIENT + FROM_CAMERA * facing, FROM_SUN * cosine], axis=-1)
    lit = (light[..., None] * colors[:, None, None, :]).reshape(len(faces), 4, 6)
    return np.concatenate([lit, cosine[..., None]], axis=-1)


def add_sunlight(canvas: Canvas, camera: Camera, sun: Floats, triangles: Floats) -> None:
    """Add the light of the Sun to the parts of a canvas of seven channels that are not in shadow."""
    is_lit = canvas.color[..., 6] > 0.0
    if not is_lit.any():
        return
    blocks = [slice(start, min(start + _ROWS, camera.height)) for start in range(0, camera.height, _ROWS)]
    points = [_points(canvas, camera, rows, is_lit[rows]) for rows in blocks]
    view = SunView(sun, np.concatenate(points), triangles.reshape(-1, 3))
    nearest = Canvas(view, channels=0)
    nearest.add_triangles(triangles, np.empty((len(triangles), 0)))
    for rows, own in zip(blocks, points, strict=True):
        light = canvas.color[rows][is_lit[rows]].astype(np.float64)
        _, from_sun, cosine = np.split(light, [3, 6], axis=1)
        free = _free(view, nearest.inverse_depth, own, cosine[:, 0])
        canvas.color[rows][is_lit[rows], :3] += free[:, None] * from_sun


def _points(canvas: Canvas, camera: Camera, rows: slice, is_lit: NDArray[np.bool_]) -> Floats:
    """Return the points (k, 3), m, of the lit surfaces in some rows of a canvas."""
    depth = 1.0 / canvas.inverse_depth[rows][is_lit]
    points: Floats = camera.position + camera.rays(np.arange(rows.start, rows.stop))[is_lit] * depth[:, None]
    return points


def _free(view: SunView, nearest: Floats, points: Floats, cosine: Floats) -> Floats:
    """Return the fraction (k,) of the Sun's light that reaches points (k, 3), m, as the mean over nine cells.

    ``cosine`` (k,) is that of the angle between the normal of the surface and the rays.
    """
    x, y, height = view.project(points).T
    column, row = x.astype(int), y.astype(int)
    c = cosine.clip(_GRAZING, 1.0)
    # within a cell, an inclined surface is higher than at the point by tan of the angle of incidence
    height = height + _OFFSET * (1.0 + np.sqrt(1.0 - c**2) / c)
    total = np.zeros(len(points))
    for right in (-1, 0, 1):
        for down in (-1, 0, 1):
            cells = nearest[(row + down).clip(0, TEXELS - 1), (column + right).clip(0, TEXELS - 1)]
            total += cells <= height
    return total / 9.0
