"""Moves those corners of convex pieces that nearly lie on a mesh onto the mesh.

CoACD cuts at planes that miss edges by up to a thousandth of the mesh's size, and shrinks pieces slightly.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

NEAR = 2e-3
"""Largest displacement of a corner, relative to the diagonal of the mesh's bounding box."""


def fitted(pieces: list[Floats], vertices: Floats, triangles: NDArray[np.int32]) -> list[Floats]:
    """Return the pieces after moving each corner that nearly lies on the mesh onto the mesh.

    A corner is moved if its distance from the mesh is at most :data:`NEAR` times the diagonal of the mesh's
    bounding box: to the nearest vertex within this distance or, if there is none, to the nearest point of an
    edge, and otherwise of a face.
    """
    near = NEAR * float(np.linalg.norm(np.ptp(vertices, axis=0)))
    corners = vertices[triangles]  # (t, 3, 3)
    low, high = corners.min(axis=1) - near, corners.max(axis=1) + near

    def moved(point: Floats) -> Floats:
        around = corners[np.all((low <= point) & (point <= high), axis=1)]
        if len(around) == 0:
            return point
        for candidates in (around.reshape(-1, 3), _on_edges(around, point), _on_faces(around, point)):
            if len(candidates) > 0:
                distances = np.linalg.norm(candidates - point, axis=1)
                if distances.min() <= near:
                    return np.asarray(candidates[distances.argmin()])
        return point

    return [np.array([moved(point) for point in piece]) for piece in pieces]


def _on_edges(triangles: Floats, point: Floats) -> Floats:
    """Return the point of each edge of triangles (k, 3, 3) that is nearest to ``point``."""
    start = triangles.reshape(-1, 3)
    along = np.roll(triangles, -1, axis=1).reshape(-1, 3) - start
    length = np.maximum(np.einsum("ij,ij->i", along, along), np.finfo(float).tiny)
    fraction = np.clip(np.einsum("ij,ij->i", point - start, along) / length, 0.0, 1.0)
    nearest: Floats = start + fraction[:, None] * along
    return nearest


def _on_faces(triangles: Floats, point: Floats) -> Floats:
    """Return the projections of a point that lie inside their triangles (k, 3, 3)."""
    a, b, c = np.moveaxis(triangles, 1, 0)
    normal = np.cross(b - a, c - a)
    length = np.linalg.norm(normal, axis=1)
    normal = normal[length > 0.0] / length[length > 0.0, None]
    corners = triangles[length > 0.0]
    projected = point - np.einsum("ij,ij->i", point - corners[:, 0], normal)[:, None] * normal
    edges = np.roll(corners, -1, axis=1) - corners
    sides = np.einsum("ij,ikj->ik", normal, np.cross(edges, projected[:, None] - corners))
    inside: Floats = projected[np.all(sides >= 0.0, axis=1)]
    return inside
