"""What a robot looks like: its visual geometry, or the box that has the inertia of a plain body."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Model

    Floats = NDArray[np.float64]

GREY = (0.72, 0.73, 0.75, 1.0)


@dataclass(frozen=True)
class Shape:
    """One visible body.

    ``kind`` is box (``size`` x, y, z), cylinder or capsule (radius, length along z), sphere (radius) or mesh;
    ``pose`` (4, 4) is in the axes of ``link``; lengths in m; ``rgba`` from 0 to 1.
    """

    link: str
    pose: Floats
    kind: str
    size: tuple[float, ...]
    filename: Path | None
    scale: tuple[float, float, float]
    rgba: tuple[float, float, float, float]


def shapes(model: Model) -> list[Shape]:
    """Everything there is to draw of a robot; boxes of its inertia stand for geometry that is not there."""
    found = [
        Shape(
            link=visual.link,
            pose=np.asarray(visual.pose, dtype=np.float64),
            kind=visual.kind,
            size=tuple(visual.size or ()),
            filename=Path(visual.filename) if visual.filename else None,
            scale=_three(visual.scale),
            rgba=_color(visual.rgba),
        )
        for visual in model.visuals
    ]
    missing = {shape.link for shape in found if _is_missing(shape)}
    found = [shape for shape in found if not _is_missing(shape)]
    drawn = {shape.link for shape in found}
    for body in model.bodies:
        if body.name in missing - drawn and body.mass > 0.0:
            sides, axes = box_of_inertia(body.mass, np.array(body.inertia))
            found.append(_box(body.name, sides, _pose(axes, np.array(body.com))))
    return found or [_inertia_box(model)]


def _is_missing(shape: Shape) -> bool:
    return shape.kind == "mesh" and (shape.filename is None or not shape.filename.is_file())


def _box(link: str, sides: Floats, pose: Floats) -> Shape:
    return Shape(link, pose, "box", tuple(sides), None, (1.0, 1.0, 1.0), GREY)


def extent(model: Model, robot: list[Shape], q: Floats) -> tuple[Floats, float]:
    """Centre (3,), W, and diagonal of the box around a robot, m."""
    corners = np.vstack([_corners(model, q, shape) for shape in robot])
    low, high = corners.min(axis=0), corners.max(axis=0)
    return (low + high) / 2.0, max(float(np.linalg.norm(high - low)), 0.1)


def _corners(model: Model, q: Floats, shape: Shape) -> Floats:
    """(8, 3) corners of a box around a shape, W, m; a mesh counts as the box with its body's inertia."""
    pose = np.asarray(model.frame_pose(q, shape.link)).reshape(4, 4)
    if shape.kind == "mesh":
        body = next((body for body in model.bodies if body.name == shape.link and body.mass > 0.0), None)
        size = np.full(3, 0.1)
        if body is not None:
            size, axes = box_of_inertia(body.mass, np.array(body.inertia))
            pose = pose @ _pose(axes, np.array(body.com))
        half = size / 2.0
    else:
        pose = pose @ shape.pose
        if shape.kind == "box":
            half = np.array(shape.size) / 2.0
        elif shape.kind == "sphere":
            half = np.full(3, shape.size[0])
        else:
            radius, length = shape.size
            half = np.array([radius, radius, length / 2.0 + (radius if shape.kind == "capsule" else 0.0)])
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    corners: Floats = signs * half @ pose[:3, :3].T + pose[:3, 3]
    return corners


def _pose(rotation: Floats, position: Floats) -> Floats:
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = rotation, position
    return pose


def box_of_inertia(mass: float, inertia: Floats) -> tuple[Floats, Floats]:
    """Edges (3,), m, and axes (3, 3) of the uniform box with a mass and an inertia about its centre.

    `I_x = m (b² + c²) / 12` and its like give `a² = 6 (I_y + I_z - I_x) / m`.
    """
    moments, axes = np.linalg.eigh(inertia)
    axes[:, 2] *= np.sign(np.linalg.det(axes))
    return np.sqrt(np.maximum(6.0 * (moments.sum() - 2.0 * moments) / mass, 1e-4)), axes


def _three(scale: Sequence[float] | None) -> tuple[float, float, float]:
    x, y, z = scale or (1.0, 1.0, 1.0)
    return x, y, z


def _color(rgba: Sequence[float] | None) -> tuple[float, float, float, float]:
    red, green, blue, alpha = rgba or GREY
    return red, green, blue, alpha


def _inertia_box(model: Model) -> Shape:
    """The uniform box with the mass and principal moments of the whole robot in its neutral configuration."""
    matrix = np.asarray(model.mass_matrix(model.neutral()))
    mass = matrix[0, 0]
    # The base rows of M are [m 1, -m [c]; m [c], I_origin], with c the centre of mass in base axes.
    lever = matrix[3:6, :3] / mass
    center = np.array([lever[2, 1], lever[0, 2], lever[1, 0]])
    inertia = matrix[3:6, 3:6] - mass * (center @ center * np.eye(3) - np.outer(center, center))
    sides, axes = box_of_inertia(mass, inertia)
    return _box(model.body_names[0], sides, _pose(axes, center))
