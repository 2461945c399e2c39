"""Triangles, their colours and textures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float32]
    Indices = NDArray[np.uint32]
    Bytes = NDArray[np.uint8]

PLAIN = (184, 186, 191, 255)
"""RGBA colour of surfaces whose file defines no colour."""

_WITHIN = np.array([[1, 1, 1], [4, 1, 1], [1, 4, 1], [1, 1, 4]]) / [[3], [6], [6], [6]]
"""Barycentric coordinates of the points at which a texture is sampled, away from the triangle's edges."""


@dataclass(frozen=True, eq=False)
class Part:
    """Triangles with a common texture, or without a texture.

    ``vertices`` (n, 3), m; ``faces`` (k, 3), indices of vertices, counter-clockwise from outside;
    ``normals`` (n, 3), unit vectors; ``colors`` (n, 4), RGBA; ``texture`` (h, w, 3), RGB, multiplied by the
    colours, and ``uv`` (n, 2), texture coordinates from the upper left corner.
    """

    vertices: Floats
    faces: Indices
    normals: Floats
    colors: Bytes
    texture: Bytes | None = None
    uv: Floats | None = None

    @property
    def face_colors(self) -> NDArray[np.float64]:
        """Mean colour of each face, (k, 3) RGB from 0 to 1; textures are sampled at a few points per face."""
        colors: NDArray[np.float64] = self.colors[:, :3][self.faces].mean(axis=1) / 255.0
        if self.texture is None or self.uv is None:
            return colors
        shape = np.array(self.texture.shape[1::-1])
        places = np.einsum("pc,kcx->kpx", _WITHIN, self.uv[self.faces])
        column, row = np.moveaxis((np.mod(places, 1.0) * shape).astype(int), -1, 0)
        colors *= self.texture[row, column].mean(axis=1) / 255.0
        return colors


@dataclass(frozen=True, eq=False)
class Mesh:
    """Mesh of one or more parts, such as the content of a mesh file; immutable."""

    parts: tuple[Part, ...]

    @cached_property
    def bounds(self) -> tuple[Floats, Floats]:
        """Smallest and largest coordinates of the vertices, (3,) each, m."""
        return (
            np.min([part.vertices.min(axis=0) for part in self.parts], axis=0),
            np.max([part.vertices.max(axis=0) for part in self.parts], axis=0),
        )

    def scaled(self, scale: Sequence[float]) -> Mesh:
        """Return the mesh scaled by three factors; an odd number of negative factors mirrors the mesh."""
        factors = np.asarray(scale, dtype=np.float32)
        if (factors == 1.0).all():
            return self
        x, y, z = factors
        turn = -1 if x * y * z < 0.0 else 1
        areas = np.array([y * z, z * x, x * y]) * np.float32(
            turn
        )  # signed area factors of faces normal to each axis
        return Mesh(tuple(
            replace(
                part,
                vertices=part.vertices * factors,
                faces=part.faces[:, ::turn],
                normals=unit(part.normals * areas),
            )
            for part in self.parts
        ))  # fmt: skip

    def painted(self, rgba: Sequence[float]) -> Mesh:
        """Return the mesh in one colour, RGBA from 0 to 1, by which textures are multiplied."""
        color = np.clip(np.round(np.array(rgba) * 255.0), 0, 255).astype(np.uint8)
        return Mesh(tuple(
            replace(part, colors=np.broadcast_to(color, part.colors.shape)) for part in self.parts
        ))  # fmt: skip


def unit(vectors: Floats) -> Floats:
    """Return the vectors (n, 3) scaled to length 1; zero vectors are unchanged."""
    lengths = np.linalg.norm(vectors, axis=-1, keepdims=True)
    scaled: Floats = np.divide(vectors, lengths, out=np.zeros_like(vectors), where=lengths > 0.0)
    return scaled
