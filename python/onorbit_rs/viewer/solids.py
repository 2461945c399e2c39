"""Shapes as rerun archetypes."""

from __future__ import annotations

import warnings

import numpy as np
import rerun as rr

from onorbit_rs.geometry import GREY, Shape
from onorbit_rs.rotations import quaternion_from_matrix

MESHES = (".dae", ".glb", ".gltf", ".obj", ".stl")
"""Files that rerun draws."""


def log_shape(recording: rr.RecordingStream, path: str, shape: Shape) -> bool:
    """Log one shape, static, in the axes of its link; False, with a warning, where rerun cannot draw it."""
    drawn = _archetype(shape)
    if drawn is None:
        return False
    pose = shape.pose
    if shape.kind == "capsule":  # rerun's capsule starts at its origin, URDF's is centred
        pose = pose.copy()
        pose[:3, 3] -= pose[:3, 2] * shape.size[1] / 2.0
    placed = rr.InstancePoses3D(
        translations=[pose[:3, 3]],
        quaternions=[rr.Quaternion(xyzw=quaternion_from_matrix(pose[:3, :3]))],
        scales=[shape.scale] if shape.kind == "mesh" else None,
    )
    recording.log(path, drawn, placed, static=True, strict=True)
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
    return _mesh(shape)


def _mesh(shape: Shape) -> rr.Asset3D | None:
    """The file as it is; a colour of the robot's rules over those of the file."""
    file = shape.filename
    if file is None or not file.is_file():
        return None  # the robot's loader has warned already
    if file.suffix.lower() not in MESHES:
        known = ", ".join(MESHES)
        warnings.warn(
            f"the mesh {file} of link {shape.link!r} is not drawn: the viewer reads {known}", stacklevel=2
        )
        return None
    return rr.Asset3D(path=file, albedo_factor=None if shape.rgba == GREY else list(shape.rgba))
