"""Shapes that are drawn for a robot: its visual geometry, with substitutes for meshes that cannot be drawn.

The substitutes are the collision shapes of the link or, without them, a sphere at its joint with rods to the
next joints. For the base, a uniform box with the same inertia replaces the sphere.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs.exceptions import NotFoundError, OnOrbitError, ReadError
from onorbit_rs.visuals.convex_hull import convex_hull
from onorbit_rs.visuals.geometry import GREY, Shape, box_of_inertia, grey_shape, pose_of
from onorbit_rs.visuals.meshes import Mesh, Part, read_mesh
from onorbit_rs.visuals.meshes.part import PLAIN
from onorbit_rs.visuals.revolved import revolved

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from onorbit_rs._core import Body, Model, Visual

    Floats = NDArray[np.float64]

ROD, SPHERE = 0.008, 0.016
"""Radii in a stick figure, as fractions of the robot's reach."""

LARGEST = 1e5
"""Largest size of a mesh, m; a larger mesh has a wrong scale or unit."""


def shapes(model: Model) -> list[Shape]:
    """Return all shapes to draw for a robot; warn about mesh files that exist but cannot be drawn."""
    found, lost, messages = _drawable(model.visuals)
    for message in messages:
        _warn_once(message)
    links = {visual.link for visual in lost} if model.visuals else set(model.body_names)
    bare = links - {shape.link for shape in found}
    # no warnings about meshes of collision shapes, which are only substitutes
    solid, _, _ = _drawable(
        [shape for shape in model.collisions if shape.link in bare and shape.kind != "half_space"]
    )
    return [*found, *solid, *_stick_figure(model, bare, {shape.link for shape in solid})]


def collision_shapes(model: Model) -> list[Shape]:
    """Return the collision shapes of a robot, meshes as their convex hulls.

    Meshes that cannot be read and half-spaces, which have no boundary to draw, are omitted.
    """
    bounded = [visual for visual in model.collisions if visual.kind != "half_space"]
    files, solid = (
        [visual for visual in bounded if (visual.kind == "mesh") == is_file] for is_file in (1, 0)
    )
    hulls = [
        replace(shape, mesh=_hull_of(np.concatenate([part.vertices for part in shape.mesh.parts])))
        for shape in _drawable(files)[0] if shape.mesh
    ]  # fmt: skip
    return [*_drawable(solid)[0], *hulls]


def _hull_of(points: ArrayLike) -> Mesh:
    """Return the convex hull of points (k, 3), m, as a mesh."""
    vertices, faces = convex_hull(np.asarray(points, dtype=np.float64))
    normals = vertices - vertices.mean(axis=0)  # rough, and sufficient for a wireframe
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    colors = np.tile(np.array(PLAIN, np.uint8), (len(vertices), 1))
    part = Part(vertices.astype(np.float32), faces.astype(np.uint32), normals.astype(np.float32), colors)
    return Mesh((part,))


@lru_cache(1024)
def _warn_once(message: str) -> None:
    """Issue each warning only once, since the viewer and the figures of a run load the same files."""
    warnings.warn(message, stacklevel=3)


def missing_meshes(model: Model) -> list[str]:
    """Return the names of mesh files that do not exist or cannot be drawn, without duplicates."""
    _, lost, _ = _drawable(model.visuals)
    return list(dict.fromkeys(visual.filename or "" for visual in lost))


def _drawable(visuals: Sequence[Visual]) -> tuple[list[Shape], list[Visual], list[str]]:
    """Return the drawable shapes, the other visuals, and a message for each unusable mesh file."""
    found, lost = [], []
    messages: dict[str, str] = {}
    for visual in visuals:
        try:
            found.append(_of(visual))
        except NotFoundError:  # this warning was issued when the robot was read
            lost.append(visual)
        except OnOrbitError as error:
            lost.append(visual)
            message = f"the mesh of link {visual.link!r} is not drawn: {error}"
            messages.setdefault(visual.filename or "", message)
    return found, lost, list(messages.values())


def _stick_figure(model: Model, bare: set[str], solid: set[str]) -> Iterator[Shape]:
    """Yield rods and spheres for bodies whose links have no shapes; for a base, a box of equal inertia."""
    ends: dict[str, list[Floats]] = {body.name: [] for body in model.bodies}
    for joint in model.joints:
        ends[joint.parent].append(np.array(joint.pose)[:3, 3])
    on_body = {frame.name: frame for frame in model.frames if frame.name in bare and frame.name not in ends}
    for frame in on_body.values():
        ends[frame.body].append(np.array(frame.pose)[:3, 3])
    ghosts = {on_body[link].body if link in on_body else link for link in bare - solid}
    reach = _reach(model)
    for index, body in enumerate(model.bodies):
        if body.name in ghosts and index == 0 and body.mass > 0.0:
            yield _box_of_inertia(body)
        elif body.name in ghosts:
            yield grey_shape(body.name, "sphere", [SPHERE * reach], np.eye(4))
        if body.name in ghosts | bare:
            for end in ends[body.name] or ([np.array(body.com)] if index > 0 else []):
                length = float(np.linalg.norm(end))
                if length > SPHERE * reach:
                    yield grey_shape(body.name, "cylinder", [ROD * reach, length], _along(end))


def _reach(model: Model) -> float:
    """Return the diagonal, m, of the box around joints and centres of mass in the neutral configuration."""
    q, points = model.neutral(), []
    for body in model.bodies:
        pose = np.asarray(model.frame_pose(q, body.name))
        points += [pose[:3, 3], pose[:3, :3] @ np.array(body.com) + pose[:3, 3]]
    return float(np.linalg.norm(np.ptp(points, axis=0)))


def _along(end: Floats) -> Floats:
    """Return the pose (4, 4) of a cylinder whose axis, its own z axis, runs from the origin to ``end``, m."""
    z = end / np.linalg.norm(end)
    x = np.cross(z, np.eye(3)[np.argmin(np.abs(z))])
    x /= np.linalg.norm(x)
    return pose_of(np.stack([x, np.cross(z, x), z], axis=-1), end / 2.0)


def _of(visual: Visual) -> Shape:
    if visual.kind in ("cone", "torus"):
        return revolved(visual)
    if visual.kind == "hull":
        return _of_hull(visual)
    return Shape(
        link=visual.link,
        pose=np.asarray(visual.pose, dtype=np.float64),
        kind=visual.kind,
        size=tuple(visual.size or ()),
        rgba=_color(visual.rgba),
        mesh=_mesh(visual) if visual.kind == "mesh" else None,
    )


def _of_hull(visual: Visual) -> Shape:
    pose = np.asarray(visual.pose, dtype=np.float64)
    return Shape(visual.link, pose, "mesh", (), _color(visual.rgba), _hull_of(visual.points))


def _mesh(visual: Visual) -> Mesh:
    """Return the scaled mesh; as in RViz, a colour in the URDF takes precedence over colours of the mesh."""
    file = visual.filename or ""
    mesh = read_mesh(file).scaled(visual.scale)
    size = float(np.ptp(mesh.bounds, axis=0).max())
    if not 0.0 < size < LARGEST:
        raise ReadError(
            f"the size of {file} is {size:.3g} m with scale {visual.scale}; it must be above 0 and below "
            f"{LARGEST:g} m; correct the scale or the unit of the file",
            path=file,
            kind="mesh",
        )
    return mesh if visual.rgba is None else mesh.painted(visual.rgba)


def _color(rgba: Sequence[float] | None) -> tuple[float, float, float, float]:
    red, green, blue, alpha = rgba or GREY
    return red, green, blue, alpha


def _box_of_inertia(body: Body) -> Shape:
    sides, axes = box_of_inertia(body.mass, np.array(body.inertia))
    return grey_shape(body.name, "box", sides, pose_of(axes, np.array(body.com)))
