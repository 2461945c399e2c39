"""Reads STL, OBJ, PLY and glTF files with trimesh."""

from __future__ import annotations

import io
import logging
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.visuals.meshes.assemble import Budget, make_part
from onorbit_rs.visuals.meshes.part import PLAIN, Part
from onorbit_rs.visuals.meshes.textures import Companions, as_utf8, pixels

if TYPE_CHECKING:
    from numpy.typing import NDArray

logging.getLogger("trimesh").addHandler(logging.NullHandler())  # trimesh prints tracebacks for damaged files

_STL_HEADER, _STL_TRIANGLE = 84, 50
"""Sizes of the header and of a triangle in a binary STL file, bytes."""


def read_with_trimesh(content: bytes, kind: str, companions: Companions) -> list[Part]:
    """Return the triangles of an STL, OBJ, PLY or glTF file.

    Raises ValueError, or any exception of trimesh if the file is damaged.
    """
    import trimesh

    if kind == "stl":
        content = _stl(content)
    elif kind == "obj":
        content = as_utf8(content)
    resolver: Any = companions  # has the methods that trimesh calls
    scene = trimesh.load_scene(
        io.BytesIO(content), file_type=kind, resolver=resolver, allow_remote=False, process=False
    )
    budget, parts = Budget(), []
    for name in scene.graph.nodes_geometry:
        pose, geometry = scene.graph[name]
        mesh = scene.geometry[geometry]
        if isinstance(mesh, trimesh.Trimesh) and len(mesh.faces):
            budget.take(len(mesh.faces))
            parts.append(_part(mesh, pose))
    return parts


def _stl(content: bytes) -> bytes:
    """Return an STL file that trimesh accepts, without bytes appended after the last triangle."""
    declared = int.from_bytes(content[_STL_HEADER - 4 : _STL_HEADER], "little")
    length = _STL_HEADER + _STL_TRIANGLE * declared
    if declared and length <= len(content):
        return content[:length]
    if b"facet" in content[:1000] or content.lstrip()[:5].lower() == b"solid":
        return as_utf8(content)
    there = max(len(content) - _STL_HEADER, 0) // _STL_TRIANGLE
    if there < declared:
        raise ValueError(
            f"it is not a complete STL file: it declares {declared} triangles but contains {there}; export "
            "or download the mesh again"
        )
    return content


def _part(mesh: Any, pose: NDArray[np.float64]) -> Part:
    vertices = mesh.vertices @ pose[:3, :3].T + pose[:3, 3]
    faces = mesh.faces[:, ::-1] if np.linalg.det(pose[:3, :3]) < 0.0 else mesh.faces
    normals = None
    if (
        "vertex_normals" in mesh._cache
    ):  # only normals in the file; normals that trimesh computes would round all edges
        normals = mesh.vertex_normals @ np.linalg.inv(pose[:3, :3])
    colors, texture, uv = _appearance(mesh.visual)
    return make_part(vertices, faces, normals=normals, colors=colors, texture=texture, uv=uv)


def _appearance(visual: Any) -> tuple[Any, Any, Any]:
    """Return colours, texture and texture coordinates of a trimesh visual; the latter two may be None."""
    if visual.kind == "vertex":
        return visual.vertex_colors, None, None
    if visual.kind == "face":
        return visual.face_colors, None, None
    if visual.kind != "texture" or visual.material is None:
        return PLAIN, None, None
    material = visual.material
    if hasattr(material, "baseColorFactor"):  # glTF
        color = material.main_color if material.baseColorFactor is not None else (255, 255, 255, 255)
        texture = pixels(material.baseColorTexture)
    else:
        texture = pixels(material.image)
        color = material.diffuse if texture is None else (255, 255, 255, 255)
    if texture is None or visual.uv is None:
        return color, None, None
    return color, texture, np.column_stack([visual.uv[:, 0], 1.0 - visual.uv[:, 1]])
