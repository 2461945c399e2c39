"""Cones and tori as triangles, since neither the viewer nor the figures have these shapes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs.visuals.geometry import GREY, Shape
from onorbit_rs.visuals.meshes import Mesh, Part

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Visual

    Floats = NDArray[np.float64]

AROUND = 32
"""Number of faces around the axis, and around the tube of a torus."""


def revolved(visual: Visual) -> Shape:
    """Return the mesh of a cone or a torus, in the pose of the visual on its link."""
    first, second = visual.size
    if visual.kind == "cone":
        # each corner twice, so that the normals of base and side differ there
        half, slope = second / 2.0, np.array([second, first]) / np.hypot(first, second)
        profile = np.array([[0.0, -half], [first, -half], [first, -half], [0.0, half]])
        normals = np.array([[0.0, -1.0], [0.0, -1.0], slope, slope])
    else:
        turn = np.linspace(0.0, 2.0 * np.pi, AROUND + 1)
        normals = np.column_stack([np.cos(turn), np.sin(turn)])
        profile = second * normals + [first, 0.0]
    color = np.clip(np.round(np.array(visual.rgba or GREY) * 255.0), 0, 255).astype(np.uint8)
    part = _rotated(profile, normals, color)
    pose = np.asarray(visual.pose, dtype=np.float64)
    return Shape(visual.link, pose, "mesh", (), (1.0, 1.0, 1.0, 1.0), Mesh((part,)))


def _rotated(profile: Floats, normals: Floats, color: NDArray[np.uint8]) -> Part:
    """Return the surface of a profile (k, 2), distance from the axis and height, rotated about z."""
    turn = np.linspace(0.0, 2.0 * np.pi, AROUND + 1)[:, None]

    def around(points: Floats) -> Floats:
        x, z = points.T
        return np.stack([x * np.cos(turn), x * np.sin(turn), np.broadcast_to(z, (AROUND + 1, len(z)))], -1)

    count = len(profile)
    corner = np.arange(AROUND)[:, None] * count + np.arange(count - 1)
    ahead, up = corner + count, corner + 1
    faces = np.concatenate([
        np.stack([corner, ahead, up], -1).reshape(-1, 3), np.stack([ahead, ahead + 1, up], -1).reshape(-1, 3)
    ])  # fmt: skip
    vertices = around(profile).reshape(-1, 3)
    return Part(
        vertices.astype(np.float32),
        faces.astype(np.uint32),
        around(normals).reshape(-1, 3).astype(np.float32),
        np.tile(color, (len(vertices), 1)),
    )
