"""Shapes as rerun archetypes."""

from __future__ import annotations

import re
import warnings

import numpy as np
import rerun as rr

from onorbit_rs.exceptions import OnOrbitError
from onorbit_rs.geometry import GREY, Shape
from onorbit_rs.reading import LARGEST_MESH, read_bytes, read_head
from onorbit_rs.rotations import quaternion_from_matrix

MESHES = {
    ".dae": "model/vnd.collada+xml",
    ".glb": "model/gltf-binary",
    ".gltf": "model/gltf+json",
    ".obj": "model/obj",
    ".stl": "model/stl",
}
"""Files that rerun draws, and their media types, which it guesses wrongly for Collada."""

_HEAD_BYTES = 65_536
"""Where a Collada file tells its unit."""


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
        scales=[np.array(shape.scale) * _unit(shape)] if shape.kind == "mesh" else None,
    )
    recording.log(path, drawn, placed, static=True, strict=True)
    return True


def _unit(shape: Shape) -> float:
    """Metres in the unit of a Collada file, which rerun passes over; other kinds of files are in metres."""
    file = shape.filename
    if file is None or file.suffix.lower() != ".dae":
        return 1.0
    head = read_head(file, _HEAD_BYTES, "mesh")
    found = re.search(rb"<unit\b[^>]*\bmeter\s*=\s*[\"']([0-9.eE+-]+)", head)
    try:
        return float(found[1]) if found else 1.0
    except ValueError:
        return 1.0


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
    if file is None:
        return None
    media_type = MESHES.get(file.suffix.lower())
    if media_type is None:
        known = ", ".join(MESHES)
        warnings.warn(
            f"the mesh {file} of link {shape.link!r} is not drawn: the viewer reads {known}", stacklevel=2
        )
        return None
    try:
        content = read_bytes(file, LARGEST_MESH, "mesh")
    except OnOrbitError as error:
        warnings.warn(f"the mesh of link {shape.link!r} is not drawn: {error}", stacklevel=2)
        return None
    color = None if shape.rgba == GREY else list(shape.rgba)
    return rr.Asset3D(contents=content, media_type=media_type, albedo_factor=color)
