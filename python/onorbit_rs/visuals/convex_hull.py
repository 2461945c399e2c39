"""Convex hull of points, to a precision that suffices for pictures."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int64]

PRECISION = 2e-3
"""Largest distance of a point outside the returned hull, as a fraction of the diagonal of all points."""


def convex_hull(points: Floats) -> tuple[Floats, Indices]:
    """Return vertices (k, 3), m, and triangles (f, 3), counter-clockwise from outside, of a convex hull.

    The point farthest outside is added until all points are inside or closer than :data:`PRECISION`. For
    points in a plane there is no triangle.
    """
    points = np.unique(points, axis=0)
    tolerance = PRECISION * float(np.linalg.norm(np.ptp(points, axis=0)))
    faces = _first_faces(points, tolerance)
    if not len(faces):
        return np.empty((0, 3)), faces
    height, owner = _farthest(points, faces)
    while height.max() > tolerance:
        apex = int(np.argmax(height))
        is_seen = _heights(points[apex : apex + 1], *_planes(points, faces))[:, 0] > 0.0
        new = np.array([(a, b, apex) for a, b in _horizon(faces[is_seen])])
        loose = is_seen[owner] & (height > 0.0)
        owner = (np.cumsum(~is_seen) - 1)[owner]
        height[loose], owner[loose] = _farthest(points[loose], new, points)
        owner[loose] += int((~is_seen).sum())
        height[apex] = 0.0
        faces = np.concatenate([faces[~is_seen], new])
    used, numbers = np.unique(faces, return_inverse=True)
    return points[used], numbers.reshape(-1, 3)


def _first_faces(points: Floats, tolerance: float) -> Indices:
    """Return the faces of a large tetrahedron; none if the points lie in a plane."""
    a = int(np.argmin(points[:, 0]))
    b = int(np.argmax(np.linalg.norm(points - points[a], axis=1)))
    c = int(np.argmax(np.linalg.norm(np.cross(points - points[a], points[b] - points[a]), axis=1)))
    heights = _heights(points, *_planes(points, np.array([[a, b, c]])))[0]
    d = int(np.argmax(np.abs(heights)))
    if abs(heights[d]) <= tolerance:
        return np.empty((0, 3), np.int64)
    if heights[d] > 0.0:
        b, c = c, b
    return np.array([(a, b, c), (a, d, b), (b, d, c), (c, d, a)])


def _planes(points: Floats, faces: Indices) -> tuple[Floats, Floats]:
    """Return the unit normals (f, 3) of faces, and the distances (f,) of their planes from the origin, m."""
    first, second, third = np.moveaxis(points[faces], 1, 0)
    normal = np.cross(second - first, third - first)
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)
    return normal, np.einsum("fi,fi->f", normal, first)


def _heights(points: Floats, normal: Floats, offset: Floats) -> Floats:
    """Return the heights (f, k), m, of points (k, 3) above the planes `normal · x = offset`."""
    heights: Floats = normal @ points.T - offset[:, None]
    return heights


def _farthest(points: Floats, faces: Indices, corners: Floats | None = None) -> tuple[Floats, Indices]:
    """Return the largest height (k,), m, of each point above a face, 0 if inside, and that face (k,)."""
    heights = _heights(points, *_planes(points if corners is None else corners, faces))
    if not len(points):
        return np.empty(0), np.empty(0, np.int64)
    return np.maximum(heights.max(axis=0), 0.0), heights.argmax(axis=0)


def _horizon(seen: Indices) -> list[tuple[int, int]]:
    """Return the directed edges, as pairs of vertices, between the visible faces and the others."""
    edges = {
        (int(a), int(b)) for k in range(3) for a, b in zip(seen[:, k], seen[:, (k + 1) % 3], strict=True)
    }
    return [(a, b) for a, b in edges if (b, a) not in edges]
