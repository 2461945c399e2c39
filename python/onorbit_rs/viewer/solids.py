"""Shapes as rerun archetypes."""

from __future__ import annotations

import numpy as np
import rerun as rr

from onorbit_rs.geometry import Shape
from onorbit_rs.rotations import quaternion_from_matrix

_MESHES = {".glb", ".gltf", ".obj", ".stl", ".dae"}


def log_shape(recording: rr.RecordingStream, path: str, shape: Shape) -> bool:
    """Log one shape, static, in the axes of its link; False where rerun cannot draw it."""
    drawn = _archetype(shape)
    if drawn is None:
        return False
    pose = shape.pose
    if shape.kind == "capsule":  # rerun's capsule starts at its origin, URDF's is centred
        pose = pose.copy()
        pose[:3, 3] -= pose[:3, 2] * shape.size[1] / 2.0
    placed = rr.Transform3D(
        translation=pose[:3, 3],
        quaternion=rr.Quaternion(xyzw=quaternion_from_matrix(pose[:3, :3])),
        scale=shape.scale if shape.kind == "mesh" else None,
    )
    recording.log(path, placed, drawn, static=True, strict=True)
    return True


def _archetype(shape: Shape) -> rr.AsComponents | None:
    color = np.array([shape.rgba])
    size = shape.size
    solid = rr.components.FillMode.Solid
    if shape.kind == "box":
        return rr.Boxes3D(sizes=[size], colors=color, fill_mode=solid)
    if shape.kind == "sphere":
        return rr.Ellipsoids3D(radii=[size[0]], colors=color, fill_mode=solid)
    if shape.kind == "cylinder":
        return rr.Cylinders3D(radii=[size[0]], lengths=[size[1]], colors=color, fill_mode=solid)
    if shape.kind == "capsule":
        return rr.Capsules3D(radii=[size[0]], lengths=[size[1]], colors=color, fill_mode=solid)
    if shape.filename is not None and shape.filename.suffix.lower() in _MESHES and shape.filename.is_file():
        return rr.Asset3D(path=shape.filename)
    return None
