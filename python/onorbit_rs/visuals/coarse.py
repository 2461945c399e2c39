"""Reduces meshes to as many triangles as a figure can show."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs.visuals.meshes import Part

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

FINEST = 1.0 / 400.0
"""Initial edge length of the cubes, as a fraction of the robot's size: about one pixel of a panel."""


def coarse(parts: Sequence[Part], size: float, most: int) -> list[tuple[Floats, Floats]]:
    """Return the corners (k, 3, 3), m, and colours (k, 3), RGB from 0 to 1, of the triangles of each part.

    The vertices in each cube of a grid are replaced by their mean; triangles that collapse are omitted.
    The cubes are enlarged until all parts together have at most ``most`` triangles.

    Parameters
    ----------
    parts : sequence of Part
        Meshes to be reduced.
    size : float
        Size of the robot, m.
    most : int
        Largest number of triangles of all parts.

    Source: Rossignac and Borrel, Multi-resolution 3D approximations for rendering complex scenes, 1993.
    """
    meshes = [
        _Triangles(part.vertices.astype(np.float64), part.faces.astype(np.intp), part.face_colors)
        for part in parts
    ]
    count, edge = sum(len(mesh.faces) for mesh in meshes), FINEST * size
    while count > most:
        meshes = [mesh.clustered(edge) for mesh in meshes]
        count = sum(len(mesh.faces) for mesh in meshes)
        edge *= max(1.1, np.sqrt(count / most))  # a surface passes through about 1 / edge² cubes
    return [(mesh.points[mesh.faces], mesh.colors) for mesh in meshes]


@dataclass(frozen=True)
class _Triangles:
    """Points (n, 3), triangles (k, 3) as indices of points, and colours (k, 3) of the triangles."""

    points: Floats
    faces: NDArray[np.intp]
    colors: Floats

    def clustered(self, edge: float) -> _Triangles:
        """Return the mesh with the points in each cube of this edge merged.

        Collapsed and repeated triangles are removed.
        """
        _, cluster = np.unique(_cubes(self.points, edge), return_inverse=True)
        faces = cluster[self.faces]
        a, b, c = faces.T
        whole = np.flatnonzero((a != b) & (b != c) & (c != a))
        kept = whole[_first_of_each(np.sort(faces[whole], axis=1))]
        return _Triangles(_means(self.points, cluster), faces[kept], self.colors[kept])


def _first_of_each(rows: NDArray[np.intp]) -> NDArray[np.intp]:
    """Return the indices of the rows (k, 3) that differ from all earlier rows, in order."""
    order = np.lexsort(rows.T)
    is_new = np.ones(len(rows), dtype=bool)
    is_new[1:] = np.diff(rows[order], axis=0).any(axis=1)
    first: NDArray[np.intp] = np.sort(order[is_new])
    return first


def _cubes(points: Floats, edge: float) -> NDArray[np.int64]:
    """Return the number (n,) of the cube of this edge that contains each point (n, 3)."""
    low = points.min(axis=0)
    x, y, z = ((points - low) / edge).astype(np.int64).T
    number: NDArray[np.int64] = (x * (y.max() + 1) + y) * (z.max() + 1) + z
    return number


def _means(points: Floats, cluster: NDArray[np.intp]) -> Floats:
    """Return the mean (m, 3) of the points (n, 3) in each of m clusters, numbered by ``cluster`` (n,)."""
    return (
        np.stack([np.bincount(cluster, weights=axis) for axis in points.T], axis=-1)
        / np.bincount(cluster)[:, None]
    )
