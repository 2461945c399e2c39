"""Visual geometry of a robot as polygons, for the 3-D figures."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs.appearance import shapes
from onorbit_rs.geometry import Shape

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Model

    Floats = NDArray[np.float64]

_AROUND = 20
"""Sides of a round body."""


def robot_polygons(model: Model, q: Floats) -> tuple[list[Floats], list[tuple[float, float, float]]]:
    """Faces of every shape at one configuration, and the colour of each.

    Parameters
    ----------
    model : Model
    q : (nq,) array
        Configuration.

    Returns
    -------
    faces : list of (k, 3) arrays
        Corners in W, m; meshes are left out.
    colors : list of RGB tuples
    """
    faces: list[Floats] = []
    colors: list[tuple[float, float, float]] = []
    for shape in shapes(model):
        own = _faces(shape)
        pose = np.asarray(model.frame_pose(q, shape.link)).reshape(4, 4) @ shape.pose
        faces += [face @ pose[:3, :3].T + pose[:3, 3] for face in own]
        colors += [shape.rgba[:3]] * len(own)
    return faces, colors


def robot_skeleton(model: Model, q: Floats) -> Floats:
    """Segments (k, 2, 3), W, m, from each joint to the next: the robot where it has only meshes."""
    origin = {name: np.asarray(model.frame_pose(q, name)).reshape(4, 4)[:3, 3] for name in model.body_names}
    ends = [(origin[joint.parent], origin[joint.child]) for joint in model.joints
            if joint.parent in origin and joint.child in origin]  # fmt: skip
    return np.array(ends).reshape(-1, 2, 3)


def _faces(shape: Shape) -> list[Floats]:
    """Faces of one shape, in its own axes."""
    size = shape.size
    if shape.kind == "box":
        return _box(np.asarray(size))
    if shape.kind == "sphere":
        return _revolved(_arc(size[0], 0.0, -90.0, 90.0))
    if shape.kind == "cylinder":
        radius, half = size[0], size[1] / 2.0
        return _revolved(np.array([[0.0, -half], [radius, -half], [radius, half], [0.0, half]]))
    if shape.kind == "capsule":
        radius, half = size[0], size[1] / 2.0
        return _revolved(np.vstack([_arc(radius, -half, -90.0, 0.0), _arc(radius, half, 0.0, 90.0)]))
    return []


def _box(size: Floats) -> list[Floats]:
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * size / 2.0
    rings = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return [corners[list(ring)] for ring in rings]


def _arc(radius: float, height: float, start_deg: float, end_deg: float) -> Floats:
    """(k, 2) points (distance from the axis, height along it) of an arc about (0, height)."""
    angles = np.radians(np.linspace(start_deg, end_deg, 7))
    return np.column_stack([radius * np.cos(angles), height + radius * np.sin(angles)])


def _revolved(profile: Floats) -> list[Floats]:
    """Faces of a profile (distance from the axis, height) turned about z."""
    turns = np.linspace(0.0, 2.0 * np.pi, _AROUND + 1)
    x = profile[:, 0, None] * np.cos(turns)
    y = profile[:, 0, None] * np.sin(turns)
    rings = np.stack([x, y, np.broadcast_to(profile[:, 1, None], x.shape)], axis=-1)
    return [
        np.array([rings[i, j], rings[i, j + 1], rings[i + 1, j + 1], rings[i + 1, j]])
        for i in range(len(profile) - 1)
        for j in range(_AROUND)
    ]
