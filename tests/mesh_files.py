"""Generates mesh files of one box, 1 by 2 by 3 with a corner at the origin, in all supported formats."""

from __future__ import annotations

import json
import struct
import zlib

import numpy as np

from onorbit_rs.visuals.meshes import Mesh

CORNERS = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 2.0) for z in (0.0, 3.0)])
QUADS = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
"""Counter-clockwise from outside."""
TRIANGLES = [triangle for a, b, c, d in QUADS for triangle in ((a, b, c), (a, c, d))]

RED, BLUE = (255, 0, 0), (0, 0, 255)
IDENTITY = "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1"


def volume(mesh: Mesh) -> float:
    """Return the volume inside the surface, m³; negative if its faces point inwards."""
    return float(sum(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0 for a, b, c in _corners(mesh)))


def area(mesh: Mesh) -> float:
    """Return the area of the surface, m²."""
    return float(
        sum(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2.0 for a, b, c in _corners(mesh))
    )


def _corners(mesh: Mesh) -> list[tuple[np.ndarray, ...]]:
    return [tuple(part.vertices[part.faces[:, k]].astype(float) for k in range(3)) for part in mesh.parts]


def picture(*colors: tuple[int, int, int]) -> bytes:
    """Return a PNG of 2 by 2 pixels, rows from the top."""
    rows = b"".join(b"\0" + bytes(colors[k]) + bytes(colors[k + 1]) for k in (0, 2))
    chunks = (
        (b"IHDR", struct.pack(">2I5B", 2, 2, 8, 2, 0, 0, 0)),
        (b"IDAT", zlib.compress(rows)),
        (b"IEND", b""),
    )
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
        for name, data in chunks
    )


def _faces(kind: str) -> str:
    inputs = (
        '<input semantic="VERTEX" source="#v" offset="0"/><input semantic="NORMAL" source="#n" offset="1"/>'
        '<input semantic="TEXCOORD" source="#t" offset="2"/>'
    )
    quads = [
        " ".join(f"{corner} {face} {k}" for k, corner in enumerate(quad)) for face, quad in enumerate(QUADS)
    ]
    if kind == "polylist":
        listed = f"<vcount>{'4 ' * 6}</vcount><p>{' '.join(quads)}</p>"
    elif kind == "polygons":
        listed = "".join(f"<p>{quad}</p>" for quad in quads)
    else:
        listed = (
            "<p>" + " ".join(f"{c} {k // 2} 0" for k, three in enumerate(TRIANGLES) for c in three) + "</p>"
        )
    count = 12 if kind == "triangles" else 6
    return f'<{kind} count="{count}" material="paint">{inputs}{listed}</{kind}>'


def _source(name: str, values: np.ndarray, axes: str) -> str:
    numbers = " ".join(f"{value:.17g}" for value in values.ravel())
    params = "".join(f'<param name="{axis}" type="float"/>' for axis in axes)
    return (
        f'<source id="{name}"><float_array id="{name}a" count="{values.size}">{numbers}</float_array>'
        f'<technique_common><accessor source="#{name}a" count="{len(values)}" stride="{len(axes)}">{params}'
        "</accessor></technique_common></source>"
    )


def collada(
    kind: str = "polylist",
    *,
    asset: str = '<unit name="meter" meter="1"/><up_axis>Z_UP</up_axis>',
    matrices: tuple[str, ...] = (IDENTITY,),
    texture: str = "",
    material: str = "shine",
    corners: np.ndarray = CORNERS,
) -> str:
    """Return the text of a COLLADA file with one box per matrix, red or with a texture."""
    appearance = "<color>1 0 0 1</color>"
    images = params = ""
    if texture:
        images = f'<library_images><image id="i"><init_from>{texture}</init_from></image></library_images>'
        params = (
            '<newparam sid="f"><surface type="2D"><init_from>i</init_from></surface></newparam>'
            '<newparam sid="s"><sampler2D><source>f</source></sampler2D></newparam>'
        )
        appearance = '<texture texture="s" texcoord="t"/>'
    normals = np.array([[-1, 0, 0], [1, 0, 0], [0, -1, 0], [0, 1, 0], [0, 0, -1], [0, 0, 1]])
    uv = np.array([[0.25, 0.75], [0.75, 0.75], [0.75, 0.25], [0.25, 0.25]])  # in each of four pixels
    nodes = "".join(
        f'<node><matrix>{matrix}</matrix><instance_geometry url="#box"><bind_material><technique_common>'
        f'<instance_material symbol="paint" target="#{material}"/>'
        "</technique_common></bind_material></instance_geometry></node>"
        for matrix in matrices
    )
    return (
        '<?xml version="1.0"?>'
        '<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">'
        f"<asset>{asset}</asset>{images}<library_effects>"
        f'<effect id="e"><profile_COMMON>{params}<technique sid="c">'
        f"<lambert><diffuse>{appearance}</diffuse></lambert>"
        "</technique></profile_COMMON></effect></library_effects>"
        '<library_materials><material id="shine"><instance_effect url="#e"/></material></library_materials>'
        '<library_geometries><geometry id="box"><mesh>'
        f"{_source('p', corners, 'XYZ')}{_source('n', normals, 'XYZ')}{_source('t', uv, 'ST')}"
        '<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>'
        f"{_faces(kind)}</mesh></geometry></library_geometries>"
        f'<library_visual_scenes><visual_scene id="w">{nodes}'
        '</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#w"/></scene></COLLADA>'
    )


def stl_text() -> str:
    facets = "".join(
        "facet normal 0 0 0\nouter loop\n"
        + "".join("vertex {} {} {}\n".format(*CORNERS[corner]) for corner in three)
        + "endloop\nendfacet\n"
        for three in TRIANGLES
    )
    return f"solid box\n{facets}endsolid box\n"


def stl_binary(head: bytes = b"") -> bytes:
    triangles = b"".join(
        struct.pack("<12fH", 0, 0, 0, *CORNERS[list(three)].ravel(), 0) for three in TRIANGLES
    )
    return head.ljust(80, b"\0") + struct.pack("<I", 12) + triangles


def obj(faces: list[tuple[int, ...]], material: str = "") -> str:
    lines = [f"mtllib {material}.mtl", "usemtl paint"] if material else []
    lines += ["v {} {} {}".format(*corner) for corner in CORNERS]
    lines += ["f " + " ".join(str(corner + 1) for corner in face) for face in faces]
    return "\n".join(lines) + "\n"


def ply() -> str:
    head = (
        "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
        "property uchar red\nproperty uchar green\nproperty uchar blue\n"
        "element face 12\nproperty list uchar int vertex_indices\nend_header\n"
    )
    points = "".join("{} {} {} 0 0 255\n".format(*corner) for corner in CORNERS)
    return head + points + "".join("3 {} {} {}\n".format(*three) for three in TRIANGLES)


def glb() -> bytes:
    points = CORNERS.astype("<f4").tobytes()
    indices = np.array(TRIANGLES, dtype="<u2").tobytes()
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 1, 1]}}],
        "buffers": [{"byteLength": len(points) + len(indices)}],
        "bufferViews": [
            {"buffer": 0, "byteLength": len(points)},
            {"buffer": 0, "byteOffset": len(points), "byteLength": len(indices)},
        ],
        "accessors": [
            {
                "bufferView": 0,
                "componentType": 5126,
                "count": 8,
                "type": "VEC3",
                "min": [0, 0, 0],
                "max": [1, 2, 3],
            },
            {"bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR"},
        ],
    }
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    body = struct.pack("<2I", len(text), 0x4E4F534A) + text
    body += struct.pack("<2I", len(points) + len(indices), 0x004E4942) + points + indices
    return struct.pack("<3I", 0x46546C67, 2, 12 + len(body)) + body
