"""Visual geometry of a robot as polygons, for the 3-D figures and for pictures."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs.visuals.coarse import coarse
from onorbit_rs.visuals.geometry import Shape, extent
from onorbit_rs.visuals.shapes import shapes

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Model

    Floats = NDArray[np.float64]

_AROUND = 20
"""Number of faces around a round body in a figure."""

MESH_TRIANGLES = 8_000
"""Largest number of mesh triangles of a robot: 1 s and 200 kB in a PDF, and a tenth of that in a PNG."""


def robot_polygons(
    model: Model, q: Floats, drawn: list[Shape] | None = None, around: int = _AROUND
) -> list[tuple[Floats, Floats]]:
    """Return the faces of the robot in some configurations.

    Parameters
    ----------
    model : Model
        Robot.
    q : (k, nq) array
        Configurations.
    drawn : list of Shape, optional
        Shapes to draw; default: the visual geometry of the robot.
    around : int
        Number of faces around a round body.

    Returns
    -------
    list of (faces, colors)
        For each configuration: corners (n, 4, 3) of quadrangles in W, m; colours (n, 3), RGB from 0 to 1.
        The last two corners of a triangle coincide. All meshes together have at most
        :data:`MESH_TRIANGLES` triangles.
    """
    robot = shapes(model) if drawn is None else drawn
    own = [*_primitives(robot, around), *_meshes(model, robot, q)]
    if not own:
        return [(np.empty((0, 4, 3)), np.empty((0, 3))) for _ in q]
    colors = np.vstack([tints for _, _, tints in own])
    found = []
    for row in q:
        placed = []
        for shape, faces, _ in own:
            pose = np.asarray(model.frame_pose(row, shape.link)).reshape(4, 4) @ shape.pose
            placed.append(faces @ pose[:3, :3].T + pose[:3, 3])
        found.append((np.vstack(placed), colors))
    return found


def _primitives(robot: list[Shape], around: int) -> Iterator[tuple[Shape, Floats, Floats]]:
    """Yield each primitive with its faces, in axes of the primitive, and their colours."""
    for shape in robot:
        if shape.mesh is None:
            faces = _faces(shape, around)
            yield shape, faces, np.tile(shape.rgba[:3], (len(faces), 1))


def _meshes(model: Model, robot: list[Shape], q: Floats) -> Iterator[tuple[Shape, Floats, Floats]]:
    """Yield the parts of meshes with their triangles, as quadrangles in axes of the part, and colours."""
    parts = [(shape, part) for shape in robot if shape.mesh is not None for part in shape.mesh.parts]
    if not parts:
        return
    _, size = extent(model, robot, q[:1])
    drawn = coarse([part for _, part in parts], size, MESH_TRIANGLES)
    for (shape, _), (corners, colors) in zip(parts, drawn, strict=True):
        yield shape, corners[:, [0, 1, 2, 2]], colors


def _faces(shape: Shape, around: int) -> Floats:
    """Return the faces (n, 4, 3), m, of a primitive in axes of the primitive."""
    size = shape.size
    if shape.kind == "box":
        return box_faces(np.asarray(size))
    if shape.kind == "sphere":
        return _revolved(_arc(size[0], 0.0, -90.0, 90.0, around), around)
    if shape.kind == "cylinder":
        radius, half = size[0], size[1] / 2.0
        return _revolved(np.array([[0.0, -half], [radius, -half], [radius, half], [0.0, half]]), around)
    radius, half = size[0], size[1] / 2.0
    ends = [_arc(radius, -half, -90.0, 0.0, around), _arc(radius, half, 0.0, 90.0, around)]
    return _revolved(np.vstack(ends), around)


def box_faces(size: Floats) -> Floats:
    """Return the faces (6, 4, 3), m, of a box with edges (3,) about the origin."""
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * size / 2.0
    rings = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces: Floats = corners[np.array(rings)]
    return faces


def _arc(radius: float, height: float, start_deg: float, end_deg: float, around: int) -> Floats:
    """Return points (k, 2) of an arc about (0, height): distance from the axis and height along the axis."""
    angles = np.radians(np.linspace(start_deg, end_deg, 1 + 3 * around // 10))
    return np.column_stack([radius * np.cos(angles), height + radius * np.sin(angles)])


def _revolved(profile: Floats, around: int) -> Floats:
    """Return the faces of a profile (distance from the axis, height) rotated about z."""
    turns = np.linspace(0.0, 2.0 * np.pi, around + 1)
    x = profile[:, 0, None] * np.cos(turns)
    y = profile[:, 0, None] * np.sin(turns)
    rings = np.stack([x, y, np.broadcast_to(profile[:, 1, None], x.shape)], axis=-1)
    faces = np.stack([rings[:-1, :-1], rings[:-1, 1:], rings[1:, 1:], rings[1:, :-1]], axis=2)
    return faces.reshape(-1, 4, 3)
