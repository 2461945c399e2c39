"""Shapes as rerun archetypes."""

from __future__ import annotations

import numpy as np
import rerun as rr

from onorbit_rs.common.rotations import quaternion_from_matrix
from onorbit_rs.visuals.geometry import Shape
from onorbit_rs.visuals.meshes import Part


def log_shape(recording: rr.RecordingStream, path: str, shape: Shape) -> list[str]:
    """Log one static shape in axes of its link; return its entities, whose frame the caller must set."""
    pose = shape.pose
    if shape.kind == "capsule":  # rerun's capsule starts at its origin, but URDF's capsule is centred
        pose = pose.copy()
        pose[:3, 3] -= pose[:3, 2] * shape.size[1] / 2.0
    placed = rr.InstancePoses3D(
        translations=[pose[:3, 3]], quaternions=[rr.Quaternion(xyzw=quaternion_from_matrix(pose[:3, :3]))]
    )
    drawn = [_primitive(shape)] if shape.mesh is None else [_mesh(part) for part in shape.mesh.parts]
    entities = [path, *(f"{path}/part_{index}" for index in range(1, len(drawn)))]
    for entity, archetype in zip(entities, drawn, strict=True):
        recording.log(entity, archetype, placed, static=True, strict=True)
    return entities


def _primitive(shape: Shape) -> rr.AsComponents:
    color = np.array([shape.rgba])
    size = shape.size
    solid = rr.components.FillMode.Solid
    if shape.kind == "box":
        return rr.Boxes3D(sizes=[size], colors=color, fill_mode=solid)
    if shape.kind == "sphere":
        return rr.Ellipsoids3D(radii=[size[0]], colors=color, fill_mode=solid)
    if shape.kind == "cylinder":
        return rr.Cylinders3D(radii=[size[0]], lengths=[size[1]], colors=color, fill_mode=solid)
    return rr.Capsules3D(radii=[size[0]], lengths=[size[1]], colors=color, fill_mode=solid)


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
