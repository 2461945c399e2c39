"""Normals at the corners of faces, with which round bodies look smooth and edges stay sharp."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

SHARPEST = np.cos(np.radians(35.0))
"""Cosine of the largest angle between the normals of two faces whose common edge is smooth."""

_SAME = 1e-6
"""Largest distance between corners that are the same point, as a fraction of the size of all faces."""


def corner_normals(faces: Floats) -> Floats:
    """Return unit normals (n, 4, 3) at the corners of quadrangles (n, 4, 3), on the side of the face normal.

    The normal at a corner is the mean, weighted by area, of the normals of all faces that meet there
    smoothly. The last two corners of a triangle coincide; faces without an area have a zero normal.
    """
    # the cross product of the diagonals is twice the vector of the area
    areas = np.cross(faces[:, 2] - faces[:, 0], faces[:, 3] - faces[:, 1])
    units = _unit(areas)
    corners, others = _meeting(faces)
    cosine = np.einsum("ni,ni->n", units[corners // 4], units[others // 4])
    is_smooth = np.abs(cosine) > SHARPEST
    corners, others, cosine = corners[is_smooth], others[is_smooth], cosine[is_smooth]
    parts = np.sign(cosine)[:, None] * areas[others // 4]
    sums: Floats = np.stack([np.bincount(corners, parts[:, i], 4 * len(faces)) for i in range(3)], axis=1)
    return _unit(sums).reshape(-1, 4, 3)


def _meeting(faces: Floats) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return all ordered pairs of corners, numbered from 0 to 4n - 1, that are at the same point.

    They include the pair of each corner with itself.
    """
    points = faces.reshape(-1, 3)
    size = max(float(np.ptp(points, axis=0).max()), 1e-30) if len(points) else 1.0
    cells = np.round((points - points.min(axis=0, initial=0.0)) / (_SAME * size)).astype(np.int64)
    order = np.lexsort(cells.T)
    is_new = np.append(True, (np.diff(cells[order], axis=0) != 0).any(axis=1))[: len(order)]
    starts = np.flatnonzero(is_new)
    counts = np.diff(np.append(starts, len(order)))
    group = np.cumsum(is_new) - 1
    times = counts[group]  # how many corners are at the point of each corner
    corners = np.repeat(order, times)
    within = np.arange(len(corners)) - np.repeat(np.cumsum(times) - times, times)
    return corners, order[np.repeat(starts[group], times) + within]


def _unit(vectors: Floats) -> Floats:
    unit: Floats = vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-30)
    return unit
