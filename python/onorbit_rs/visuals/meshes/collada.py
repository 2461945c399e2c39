"""Reads Collada files with pycollada: triangles, polygons and polylists, with the poses of their nodes."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree
from xml.parsers import expat

import numpy as np

from onorbit_rs.visuals.meshes.assemble import Budget, make_part
from onorbit_rs.visuals.meshes.part import PLAIN, Part

if TYPE_CHECKING:
    from onorbit_rs.visuals.meshes.textures import Companions

MOST_NODES = 100_000
"""Largest number of nodes in a scene; n nodes that each refer twice to the next node expand to 2ⁿ nodes."""

_CHUNK = 65_536


def read_collada(content: bytes, companions: Companions) -> list[Part]:
    """Return the triangles of the scene in a Collada file.

    Raises ValueError, or any exception of pycollada if the file is damaged.
    """
    import collada

    _check_kind(content)
    document = collada.Collada(io.BytesIO(content), ignore=[collada.DaeError])
    if document.errors:
        content = _without_lost_materials(content, {material.id for material in document.materials})
        document = collada.Collada(io.BytesIO(content), ignore=[collada.DaeError])
    scene = document.scene or next(iter(document.scenes), None)
    if scene is None:
        raise ValueError("it has no <visual_scene>; export the file again with its objects")
    known: dict[int, int] = {}
    if sum(_count(node, known) for node in scene.nodes) > MOST_NODES:
        raise ValueError(f"its scene has more than {MOST_NODES} nodes; simplify the scene")
    meter = document.assetInfo.unitmeter or 1.0
    budget, parts = Budget(), []
    for geometry in scene.objects("geometry"):
        for primitive in geometry.primitives():
            if isinstance(primitive, collada.lineset.BoundLineSet):
                continue
            budget.take(max(len(primitive), len(getattr(primitive, "index", ())) // 3))
            triangles = primitive.triangleset() if hasattr(primitive, "triangleset") else primitive
            if triangles.vertex_index is not None and len(triangles.vertex_index):
                parts.append(_part(triangles, meter, companions))
    return parts


def _check_kind(content: bytes) -> None:
    """Raise ValueError for other XML, and for document types, whose entities can expand without bound."""

    def refuse(*_: Any) -> None:
        raise ValueError(
            "it declares a document type (<!DOCTYPE>), which is not supported, because the declared entities "
            "can expand to any length; remove the declaration"
        )

    names: list[str] = []
    parser = expat.ParserCreate()
    parser.StartDoctypeDeclHandler = refuse
    parser.StartElementHandler = lambda name, _: names.append(name)
    for start in range(0, len(content), _CHUNK):
        parser.Parse(content[start : start + _CHUNK])
        if names:
            break
    if names and names[0].rpartition(":")[2] != "COLLADA":
        raise ValueError(
            f"it is not a Collada file: its root is <{names[0][:80]}>; export the mesh as Collada"
        )


def _without_lost_materials(content: bytes, known: set[str]) -> bytes:
    """Return the file without uses of unreadable materials, whose geometry pycollada would omit."""
    root = ElementTree.fromstring(content)
    for holder in root.iter():
        for use in [child for child in holder if child.tag.endswith("}instance_material")]:
            if use.get("target", "").removeprefix("#") not in known:
                holder.remove(use)
    return ElementTree.tostring(root)


def _count(node: Any, known: dict[int, int]) -> int:
    """Return the number of nodes drawn for a node, including itself; every reference to a node counts."""
    target = getattr(node, "node", node)
    if id(target) not in known:
        known[id(target)] = 1 + sum(_count(child, known) for child in getattr(target, "children", ()))
    return known[id(target)]


def _part(triangles: Any, meter: float, companions: Companions) -> Part:
    """Return a part with one vertex per corner: normals and texture coordinates have separate indices."""
    vertices = triangles.vertex[triangles.vertex_index].reshape(-1, 3) * meter
    normals = uv = colors = None
    if triangles.normal is not None and triangles.normal_index is not None:
        normals = triangles.normal[triangles.normal_index].reshape(-1, 3)
    if len(triangles.texcoordset):
        uv = triangles.texcoordset[0][triangles.texcoord_indexset[0]].reshape(len(vertices), -1)[:, :2]
        uv = np.column_stack([uv[:, 0], 1.0 - uv[:, 1]])
    rgba, texture = _material(triangles.material, companions if uv is not None else None)
    of_vertices = triangles.original.sources.get("COLOR")
    if of_vertices:
        offset, source = of_vertices[0][0], of_vertices[0][4].data
        colors = np.full((len(vertices), 4), 255.0)
        colors[:, : source.shape[1]] = (
            source[triangles.index[:, :, offset]].reshape(len(vertices), -1) * 255.0
        )
    faces = np.arange(len(vertices)).reshape(-1, 3)
    return make_part(
        vertices,
        faces,
        normals=normals,
        colors=rgba if colors is None else _bytes(colors),
        texture=texture,
        uv=uv,
    )


def _material(material: Any, companions: Companions | None) -> tuple[Any, Any]:
    """Return RGBA, 0 to 255, and texture of a material; emission replaces a black diffuse colour."""
    import collada

    effect = getattr(material, "effect", None)
    if effect is None:
        return PLAIN, None
    if isinstance(effect.diffuse, collada.material.Map):
        texture = companions and companions.texture(effect.diffuse.sampler.surface.image.path)
        return ((255, 255, 255, 255), texture) if texture is not None else (PLAIN, None)
    lights = [effect.diffuse, effect.emission]
    known = [
        light[:3] for light in lights if light is not None and not isinstance(light, collada.material.Map)
    ]
    if not known:
        return PLAIN, None
    color = next((light for light in known if any(light)), known[0])
    return _bytes(255.0 * np.array([*color, _opacity(effect)])), None


def _opacity(effect: Any) -> float:
    """Return the opacity in either of Collada's modes, 0 to 1; an invisible material is taken as opaque.

    Materials are invisible only because of errors of exporters.
    """
    import collada

    transparent, factor = effect.transparent, effect.transparency
    if transparent is None or isinstance(transparent, collada.material.Map) or not isinstance(factor, float):
        return 1.0
    if effect.opaque_mode == collada.material.OPAQUE_MODE.RGB_ZERO:
        opacity = 1.0 - factor * float(np.mean(transparent[:3]))
    else:
        opacity = factor * float(transparent[3])
    return opacity if 0.01 < opacity <= 1.0 else 1.0


def _bytes(values: Any) -> Any:
    return np.clip(np.round(np.nan_to_num(values)), 0, 255).astype(np.uint8)
