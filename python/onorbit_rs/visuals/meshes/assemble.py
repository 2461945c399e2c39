"""Builds the parts of a mesh from the arrays in a file."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.visuals.meshes.part import PLAIN, Part, unit

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

MOST_TRIANGLES = 10_000_000
"""Largest number of triangles in a file; every instance of a geometry counts."""


def make_part(
    vertices: ArrayLike,
    faces: ArrayLike,
    *,
    normals: ArrayLike | None = None,
    colors: ArrayLike | None = None,
    texture: Any = None,
    uv: ArrayLike | None = None,
) -> Part:
    """Return a part; its faces are shaded flat if it has no normals, or if it has one colour per face.

    Parameters
    ----------
    vertices, normals : (n, 3) arrays
        Positions, m, and unit normals of the vertices.
    faces : (k, 3) array
        Indices of the vertices of each triangle.
    colors : (4,), (n, 4) or (k, 4) array
        RGBA from 0 to 255: one colour, or one colour for each vertex or face.
    texture, uv
        As in :class:`Part`; a texture without ``uv`` is ignored.

    Raises
    ------
    ValueError
        If the numbers of vertices, normals and ``uv`` differ, or a vertex is not finite.
    """
    index = np.ascontiguousarray(faces, dtype=np.uint32).reshape(-1, 3)
    points = np.asarray(vertices, dtype=np.float32).reshape(-1, 3)
    tints = np.asarray(PLAIN if colors is None else colors, dtype=np.uint8)
    places = None if uv is None or texture is None else np.asarray(uv, dtype=np.float32).reshape(-1, 2)
    is_of_faces = tints.ndim == 2 and len(tints) == len(index) != len(points)
    if normals is None or is_of_faces:
        corners = index.reshape(-1)
        points, places = points[corners], None if places is None else places[corners]
        if is_of_faces:
            tints = np.repeat(tints, 3, axis=0)
        elif tints.ndim == 2:
            tints = tints[corners]
        index = np.arange(len(points), dtype=np.uint32).reshape(-1, 3)
        a, b, c = points.reshape(-1, 3, 3).swapaxes(0, 1)
        directions = np.repeat(np.cross(b - a, c - a), 3, axis=0)
    else:
        directions = np.asarray(normals, dtype=np.float32).reshape(-1, 3)
    if len(directions) != len(points) or (places is not None and len(places) != len(points)):
        uv = "" if places is None else f", texture coordinates: {len(places)}"
        raise ValueError(
            "it has different numbers of vertices and of their attributes (vertices: "
            f"{len(points)}, normals: {len(directions)}{uv}); export the mesh again"
        )
    if not np.isfinite(points).all():
        raise ValueError("it has vertices whose coordinates are not finite; export the mesh again")
    tints = np.broadcast_to(tints, (len(points), 4))
    return Part(
        points, index, unit(np.nan_to_num(directions)), tints, None if places is None else texture, places
    )


def joined(parts: Sequence[Part]) -> tuple[Part, ...]:
    """Merge parts that share texture and opacity, so that each result can be drawn in one call."""
    groups: dict[tuple[int, int], list[Part]] = {}
    for part in parts:
        groups.setdefault((id(part.texture), int(part.colors[0, 3])), []).append(part)
    return tuple(_as_one(group) for group in groups.values())


def _as_one(parts: list[Part]) -> Part:
    if len(parts) == 1:
        return parts[0]
    starts = np.cumsum([0, *(len(part.vertices) for part in parts[:-1])], dtype=np.uint32)
    places = [part.uv for part in parts if part.uv is not None]
    return Part(
        np.vstack([part.vertices for part in parts]),
        np.vstack([part.faces + start for part, start in zip(parts, starts, strict=True)]),
        np.vstack([part.normals for part in parts]),
        np.vstack([part.colors for part in parts]),
        parts[0].texture,
        np.vstack(places) if places else None,
    )


@dataclass
class Budget:
    """Limit on the number of triangles in a file."""

    left: int = MOST_TRIANGLES

    def take(self, triangles: int) -> None:
        """Subtract triangles from the remaining number; raise ValueError if the limit is exceeded."""
        self.left -= triangles
        if self.left < 0:
            raise ValueError(f"it has more than {MOST_TRIANGLES} triangles; simplify the mesh")
