"""Draws triangles and lines with hidden surfaces removed (a depth buffer)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator
    from typing import Protocol

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

    class View(Protocol):
        """Projection of points onto a picture of ``width`` by ``height`` pixels."""

        @property
        def width(self) -> int:
            """Width of the picture, pixels."""

        @property
        def height(self) -> int:
            """Height of the picture, pixels."""

        def project(self, points: Floats) -> Floats:
            """Return pixels x and y of points (..., 3), m, and a measure that is larger for nearer points."""


_SMALL = 200
"""Largest number of pixels in the box around a triangle that is drawn at the same time as others."""

_AT_ONCE = 200_000
"""Number of pixels that are tested at the same time."""

_NEARER = 1.002
"""Factor on the inverse depth of a line, so that a line on a surface is visible."""


class Canvas:
    """Picture of the nearest surface in each pixel.

    ``color`` (height, width, channels) is from 0 to 1. ``inverse_depth`` (height, width), 1/m, is zero where
    nothing was drawn.
    """

    def __init__(self, view: View, channels: int = 3) -> None:
        """Create an empty canvas of the size of a view, which projects the points."""
        self._view = view
        self.color = np.zeros((view.height, view.width, channels), np.float32)
        self.inverse_depth = np.zeros((view.height, view.width))

    def add_triangles(self, corners: Floats, colors: Floats) -> None:
        """Draw triangles (n, 3, 3), m, except those that reach behind the camera.

        The colours are those of the triangles, (n, channels), or of their corners, (n, 3, channels).
        """
        self._fill(self._view.project(corners), colors)

    def add_line(self, points: Floats, color: Floats, pixels: float) -> None:
        """Draw a line through points (k, 3), m, with a width in pixels."""
        self.add_segments(points[:-1], points[1:], color, pixels)

    def add_segments(self, starts: Floats, ends: Floats, color: Floats, pixels: float) -> None:
        """Draw straight lines from ``starts`` to ``ends``, (k, 3), m, with a width in pixels."""
        start, end = (self._view.project(points) * [1.0, 1.0, _NEARER] for points in (starts, ends))
        along = end[:, :2] - start[:, :2]
        length = np.linalg.norm(along, axis=1, keepdims=True).clip(1e-9)
        aside = np.zeros_like(start)
        aside[:, :2] = 0.5 * pixels * along[:, ::-1] * [-1.0, 1.0] / length
        a, b, c, d = start - aside, start + aside, end + aside, end - aside
        triangles = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
        self._fill(triangles, np.tile(color, (len(triangles), 1)))

    def _fill(self, projected: Floats, colors: Floats) -> None:
        """Fill triangles (n, 3, 3), given by pixels x and y and the inverse depth, linear in x and y."""
        size = np.array([self._view.width, self._view.height])
        low = np.ceil(projected[..., :2].min(axis=1) - 0.5).clip(0, size)
        high = np.ceil(projected[..., :2].max(axis=1) - 0.5).clip(0, size)
        planes = _planes(projected)
        is_drawn = (projected[..., 2] > 0.0).all(axis=1) & (low < high).all(axis=1)
        is_drawn &= np.isfinite(planes).all(axis=(1, 2))
        if colors.ndim == 2:
            colors = np.broadcast_to(colors[:, None], (len(colors), 3, colors.shape[1]))
        boxes = np.concatenate([low, high], axis=1).astype(int)
        pixels = (boxes[:, 2:] - boxes[:, :2]).prod(axis=1)
        for index in np.flatnonzero(is_drawn & (pixels > _SMALL)):
            self._fill_large(boxes[index], planes[index], colors[index])
        for part in _parts(np.flatnonzero(is_drawn & (pixels <= _SMALL)), pixels):
            self._fill_small(boxes[part], planes[part], colors[part])

    def _fill_large(self, box: NDArray[np.int_], planes: Floats, colors: Floats) -> None:
        """Draw one triangle in those pixels of its ``box`` in which it is the nearest so far.

        ``box`` (4,) contains the first x and y, and the x and y after the last. ``planes`` (4, 3) contains
        the coefficients of x, y and 1 in the three barycentric coordinates and in the inverse depth;
        ``colors`` (3, channels) are those of the corners.
        """
        x0, y0, x1, y1 = box
        x = np.arange(x0, x1) + 0.5
        y = np.arange(y0, y1)[:, None] + 0.5
        weights = [px * x + (py * y + p) for px, py, p in planes]
        part = self.inverse_depth[y0:y1, x0:x1]
        is_visible = np.minimum(np.minimum(weights[0], weights[1]), weights[2]) >= 0.0
        is_visible &= weights[3] > part
        part[is_visible] = weights[3][is_visible]
        color = colors[0]
        if (colors != colors[0]).any():
            color = np.stack([weight[is_visible] for weight in weights[:3]], axis=1) @ colors
        self.color[y0:y1, x0:x1][is_visible] = color

    def _fill_small(self, boxes: NDArray[np.int_], planes: Floats, colors: Floats) -> None:
        """Fill many triangles; in each pixel of their boxes, the nearest one is drawn."""
        width, height = (boxes[:, 2:] - boxes[:, :2]).T
        count = width * height
        owner = np.repeat(np.arange(len(boxes)), count)
        within = np.arange(len(owner)) - np.repeat(np.cumsum(count) - count, count)
        x = boxes[owner, 0] + within % width[owner]
        y = boxes[owner, 1] + within // width[owner]
        plane = planes[owner]
        weights = plane[:, :, 0] * (x + 0.5)[:, None] + (plane[:, :, 1] * (y + 0.5)[:, None] + plane[:, :, 2])
        is_visible = (weights[:, :3].min(axis=1) >= 0.0) & (weights[:, 3] > self.inverse_depth[y, x])
        owner, x, y, weights = owner[is_visible], x[is_visible], y[is_visible], weights[is_visible]
        place = y * self._view.width + x
        order = np.lexsort((weights[:, 3], place))
        is_nearest = np.append(np.diff(place[order]) != 0, True)[: len(order)]
        kept = order[is_nearest]
        self.inverse_depth[y[kept], x[kept]] = weights[kept, 3]
        self.color[y[kept], x[kept]] = np.einsum("nk,nkc->nc", weights[kept, :3], colors[owner[kept]])


def _parts(chosen: NDArray[np.intp], pixels: NDArray[np.int_]) -> Iterator[NDArray[np.intp]]:
    """Yield the chosen triangles in parts with a limited number of pixels."""
    if len(chosen):
        number = np.cumsum(pixels[chosen]) // _AT_ONCE
        yield from np.split(chosen, np.flatnonzero(np.diff(number)) + 1)


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
