"""Converts shapes to rerun archetypes, and logs them."""

from __future__ import annotations

from typing import Any

import numpy as np
import rerun as rr

from onorbit_rs.common.rotations import quaternion_from_matrix
from onorbit_rs.visuals.geometry import Shape
from onorbit_rs.visuals.meshes import Mesh, Part

WIRE = (90, 225, 205)
"""Colour of collision shapes."""
_WIRE_WIDTH = rr.Radius.ui_points(0.8)


def log_wireframe(recording: rr.RecordingStream, path: str, shape: Shape) -> None:
    """Log a static shape as lines in axes of its link; the caller must set the frame of the entity."""
    drawn = _wires(shape.mesh) if shape.mesh is not None else _primitive(shape, WIRE)
    recording.log(path, drawn, _placed(shape), static=True, strict=True)


def log_shape(recording: rr.RecordingStream, path: str, shape: Shape) -> list[str]:
    """Log one static shape in axes of its link; return its entities, whose frame the caller must set."""
    placed = _placed(shape)
    drawn = [_primitive(shape)] if shape.mesh is None else [_mesh(part) for part in shape.mesh.parts]
    entities = [path, *(f"{path}/part_{index}" for index in range(1, len(drawn)))]
    for entity, archetype in zip(entities, drawn, strict=True):
        recording.log(entity, archetype, placed, static=True, strict=True)
    return entities


def _placed(shape: Shape) -> rr.InstancePoses3D:
    pose = shape.pose
    if shape.kind == "capsule":  # rerun's capsule starts at its origin, but URDF's capsule is centred
        pose = pose.copy()
        pose[:3, 3] -= pose[:3, 2] * shape.size[1] / 2.0
    return rr.InstancePoses3D(
        translations=[pose[:3, 3]], quaternions=[rr.Quaternion(xyzw=quaternion_from_matrix(pose[:3, :3]))]
    )


def _primitive(shape: Shape, wire: tuple[int, int, int] | None = None) -> rr.AsComponents:
    """Return a solid or, with the colour ``wire``, a wireframe."""
    size = shape.size
    style: dict[str, Any] = {"colors": np.array([shape.rgba]), "fill_mode": rr.components.FillMode.Solid}
    if wire is not None:
        style = {"colors": [wire], "fill_mode": rr.components.FillMode.MajorWireframe}
        style |= {"radii" if shape.kind == "box" else "line_radii": _WIRE_WIDTH}
    if shape.kind == "box":
        return rr.Boxes3D(sizes=[size], **style)
    if shape.kind == "sphere":
        return rr.Ellipsoids3D(radii=[size[0]], **style)
    if shape.kind == "cylinder":
        return rr.Cylinders3D(radii=[size[0]], lengths=[size[1]], **style)
    return rr.Capsules3D(radii=[size[0]], lengths=[size[1]], **style)


def _mesh(part: Part) -> rr.Mesh3D:
    is_plain = (part.colors == part.colors[0]).all()
    return rr.Mesh3D(
        vertex_positions=part.vertices,
        triangle_indices=part.faces,
        vertex_normals=part.normals,
        vertex_colors=None if is_plain else part.colors,
        albedo_factor=part.colors[0] if is_plain else None,
        albedo_texture=part.texture,
        vertex_texcoords=part.uv,
    )


def _wires(mesh: Mesh) -> rr.LineStrips3D:
    """Return the edges of a mesh; an edge between two triangles is drawn once."""
    strips = []
    for part in mesh.parts:
        edges = np.sort(np.concatenate([part.faces[:, [0, 1]], part.faces[:, [1, 2]], part.faces[:, [2, 0]]]))
        strips += list(part.vertices[np.unique(edges, axis=0)])
    return rr.LineStrips3D(strips, colors=[WIRE], radii=_WIRE_WIDTH)
