"""Drawable shapes and their extent."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from onorbit_rs._core import Model
    from onorbit_rs.visuals.meshes import Mesh

    Floats = NDArray[np.float64]

GREY = (0.72, 0.73, 0.75, 1.0)


@dataclass(frozen=True)
class Shape:
    """A drawable shape fixed to a link.

    Attributes
    ----------
    link : str
        Name of the link.
    pose : (4, 4) array
        Pose in axes of the link, m.
    kind : str
        ``box``, ``cylinder``, ``capsule``, ``sphere`` or ``mesh``.
    size : tuple of float
        Edges x, y, z of a box; radius and length along z of a cylinder or capsule; radius of a sphere; m.
    rgba : tuple of float
        Red, green, blue and opacity, 0 to 1; not used for a mesh, which contains its colours.
    mesh : Mesh or None
        Triangles of a mesh.
    """

    link: str
    pose: Floats
    kind: str
    size: tuple[float, ...]
    rgba: tuple[float, float, float, float]
    mesh: Mesh | None = None


def extent(model: Model, robot: list[Shape], q: Floats) -> tuple[Floats, float]:
    """Return centre (3,) in W, m, and diameter, m, of a sphere around a robot in all configurations (k, nq).

    The diameter is at least 0.1 m.
    """
    corners = corners_of(model, robot, q)
    center = (corners.min(axis=0) + corners.max(axis=0)) / 2.0
    return center, max(2.0 * float(np.linalg.norm(corners - center, axis=1).max()), 0.1)


def corners_of(model: Model, robot: list[Shape], q: Floats) -> Floats:
    """Return the corners (c, 3) in W, m, of the boxes around all shapes in all configurations (k, nq)."""
    return np.vstack([_corners(model, row, shape) for row in q for shape in robot])


def box_around(shape: Shape) -> tuple[Floats, Floats]:
    """Return the pose (4, 4) in the link and the half edges (3,), m, of a box around a shape."""
    if shape.mesh is not None:
        low, high = np.array(shape.mesh.bounds, dtype=np.float64)
        return shape.pose @ pose_of(np.eye(3), (low + high) / 2.0), (high - low) / 2.0
    if shape.kind == "box":
        half = np.array(shape.size) / 2.0
    elif shape.kind == "sphere":
        half = np.full(3, shape.size[0])
    else:
        radius, length = shape.size
        half = np.array([radius, radius, length / 2.0 + (radius if shape.kind == "capsule" else 0.0)])
    return shape.pose, half


def _corners(model: Model, q: Floats, shape: Shape) -> Floats:
    """Return the corners (8, 3) in W, m, of the box around a shape."""
    in_link, half = box_around(shape)
    pose = np.asarray(model.frame_pose(q, shape.link)).reshape(4, 4) @ in_link
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    corners: Floats = signs * half @ pose[:3, :3].T + pose[:3, 3]
    return corners


def pose_of(rotation: Floats, position: Floats) -> Floats:
    """Return the homogeneous matrix (4, 4) of a rotation and a position."""
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = rotation, position
    return pose


def grey_shape(link: str, kind: str, size: Iterable[float], pose: Floats) -> Shape:
    """Return a grey primitive shape that is fixed to a link."""
    return Shape(link, pose, kind, tuple(size), GREY)


def box_of_inertia(mass: float, inertia: Floats) -> tuple[Floats, Floats]:
    """Return edges (3,), m, and axes (3, 3) of the uniform box with this mass and inertia about its centre.

    The edges are at least 1 cm long.

    With mass `m`, edges `a`, `b`, `c` and principal moments `I_x`, `I_y`, `I_z`, `I_x = m (b² + c²) / 12` and
    its permutations give `a² = 6 (I_y + I_z - I_x) / m`.
    """
    moments, axes = np.linalg.eigh(inertia)
    axes[:, 2] *= np.sign(np.linalg.det(axes))
    return np.sqrt(np.maximum(6.0 * (moments.sum() - 2.0 * moments) / mass, 1e-4)), axes
