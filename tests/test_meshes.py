"""Mesh files of every format yield the same box, and unusable ones are rejected with a reason."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mesh_files import (
    BLUE,
    CORNERS,
    QUADS,
    RED,
    TRIANGLES,
    area,
    collada,
    glb,
    obj,
    picture,
    ply,
    stl_binary,
    stl_text,
    volume,
)

import onorbit_rs as oo
from onorbit_rs.visuals.coarse import coarse
from onorbit_rs.visuals.meshes import Mesh, read_mesh
from onorbit_rs.visuals.meshes.assemble import MOST_TRIANGLES
from onorbit_rs.visuals.shapes import missing_meshes, shapes

FLOAT = 1e-6  # vertices have 32 bits


def read(folder: Path, name: str, content: str | bytes) -> Mesh:
    path = folder / name
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    return read_mesh(path)


FORMATS: dict[str, str | bytes] = {
    "polylist.dae": collada("polylist"),
    "triangles.DAE": collada("triangles"),
    "polygons.dae": collada("polygons"),
    "text.stl": stl_text(),
    "binary.STL": stl_binary(),
    "solid.stl": stl_binary(b"solid made by an exporter that writes binary"),
    "longer.stl": stl_binary() + b"what an exporter left behind",
    "triangles.obj": obj(list(TRIANGLES)),
    "quads.obj": obj(QUADS),
    "colours.ply": ply(),
    "binary.glb": glb(),
    "latin-1.obj": "# Böx\n".encode("latin-1") + obj(QUADS).encode(),
    "latin-1.stl": stl_text().replace("box", "Böx").encode("latin-1"),
}


@pytest.mark.parametrize("name", FORMATS)
def test_the_box_is_the_same_in_every_format(name: str, tmp_path: Path) -> None:
    mesh = read(tmp_path, name, FORMATS[name])
    np.testing.assert_allclose(mesh.bounds, [[0, 0, 0], [1, 2, 3]], rtol=FLOAT)
    assert (volume(mesh), area(mesh)) == pytest.approx((6.0, 22.0), rel=FLOAT)
    (part,) = mesh.parts
    flat = part.vertices[part.faces]
    across = np.cross(flat[:, 1] - flat[:, 0], flat[:, 2] - flat[:, 0])
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    np.testing.assert_allclose(part.normals[part.faces[:, 0]], across, atol=FLOAT)  # flat, outwards


def test_a_box_with_an_inverted_face_is_detected(tmp_path: Path) -> None:
    turned = [*TRIANGLES[:2], TRIANGLES[2][::-1], *TRIANGLES[3:]]
    assert volume(read(tmp_path, "turned.obj", obj(turned))) != pytest.approx(6.0, rel=0.01)


@pytest.mark.parametrize(
    ("asset", "meter"),
    [
        ('<unit name="inch" meter="0.0254"/>', 0.0254),
        ('<unit name="centimeter" meter="0.01"/><up_axis>Y_UP</up_axis>', 0.01),
        ("<up_axis>X_UP</up_axis>", 1.0),
    ],
)
def test_the_unit_of_collada_is_applied_but_not_its_up_axis(asset: str, meter: float, tmp_path: Path) -> None:
    mesh = read(tmp_path, "box.dae", collada(asset=asset))
    np.testing.assert_allclose(mesh.bounds, np.array([[0, 0, 0], [1, 2, 3]]) * meter, rtol=FLOAT)


def test_the_poses_of_colladas_nodes_are_applied(tmp_path: Path) -> None:
    turned = "0 -1 0 10 1 0 0 0 0 0 1 0 0 0 0 1"  # a quarter turn about z, then 10 along x
    mesh = read(tmp_path, "box.dae", collada(matrices=("1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1", turned)))
    np.testing.assert_allclose(mesh.bounds, [[0, 0, 0], [10, 2, 3]], atol=FLOAT)
    assert volume(mesh) == pytest.approx(12.0, rel=FLOAT)


def test_scale_stretches_and_mirrors(tmp_path: Path) -> None:
    mesh = read(tmp_path, "box.stl", stl_binary()).scaled([-2.0, 1.0, 0.5])
    np.testing.assert_allclose(mesh.bounds, [[-2, 0, 0], [0, 2, 1.5]], atol=FLOAT)
    assert volume(mesh) == pytest.approx(6.0, rel=FLOAT)  # positive: the faces still point outwards
    sloped = read(tmp_path, "slope.obj", "v 0 0 0\nv 1 0 0\nv 0 1 1\nf 1 2 3\n").scaled([1.0, 1.0, 2.0])
    np.testing.assert_allclose(sloped.parts[0].normals[0], np.array([0, -2, 1]) / np.sqrt(5.0), atol=FLOAT)


def test_normals_of_the_file_stay_smooth(tmp_path: Path) -> None:
    text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvn 1 0 0\nvn 0 1 0\nf 1//1 2//2 3//3\n"
    (part,) = read(tmp_path, "smooth.obj", text).parts
    np.testing.assert_allclose(part.normals[part.faces[0]], [[0, 0, 1], [1, 0, 0], [0, 1, 0]], atol=FLOAT)


def test_colours_and_materials_of_the_file(tmp_path: Path) -> None:
    assert read(tmp_path, "red.dae", collada()).parts[0].colors[0].tolist() == [*RED, 255]
    assert read(tmp_path, "blue.ply", ply()).parts[0].colors[0].tolist() == [*BLUE, 255]
    assert read(tmp_path, "blue.glb", glb()).parts[0].colors[0].tolist() == [*BLUE, 255]
    (tmp_path / "paint.mtl").write_text("# für die Box\nnewmtl paint\nKd 0 0 1\n", encoding="latin-1")
    mesh = read(tmp_path, "blue.obj", obj(QUADS, "paint"))
    assert mesh.parts[0].colors[0].tolist() == [*BLUE, 255]
    assert mesh.painted([1, 0, 0, 0.5]).parts[0].colors[3].tolist() == [*RED, 128]
    assert read(tmp_path, "gone.obj", obj(QUADS, "gone")).parts[0].colors[0].tolist() == [184, 186, 191, 255]


GREEN, WHITE = (0, 255, 0), (255, 255, 255)


def test_a_texture_is_the_right_way_up(tmp_path: Path) -> None:
    (tmp_path / "of the box.png").write_bytes(picture(RED, GREEN, BLUE, WHITE))
    (part,) = read(tmp_path, "box.dae", collada(texture="of%20the%20box.png")).parts
    assert part.texture is not None and part.texture.shape == (2, 2, 3)
    assert part.texture[0, 0].tolist() == list(RED) and part.texture[1, 1].tolist() == list(WHITE)
    is_corner = (part.vertices == CORNERS[QUADS[1][0]]).all(axis=1) & (part.normals[:, 0] > 0.9)
    # v is up in Collada and down in a Part: (0.25, 0.75) of the file is in the upper left pixel
    np.testing.assert_allclose(part.uv[is_corner], 0.25)  # type: ignore[index]
    (tmp_path / "plain.png").write_bytes(picture(BLUE, BLUE, BLUE, BLUE))
    blue = read(tmp_path, "blue.dae", collada(texture="plain.png")).parts[0]
    np.testing.assert_array_equal(blue.face_colors, np.tile([0.0, 0.0, 1.0], (12, 1)))
    assert len(np.unique(part.face_colors, axis=0)) > 1


@pytest.mark.parametrize(
    "lies", ["beside", "in textures", "outside", "link", "nowhere", "postscript", "network"]
)
def test_textures_are_local_files_near_the_mesh(lies: str, tmp_path: Path) -> None:
    meshes = tmp_path / "package" / "meshes" / "visual"
    meshes.mkdir(parents=True)
    (tmp_path / "package" / "package.xml").touch()
    content = picture(RED, RED, RED, RED)
    (tmp_path / "secret.png").write_bytes(content)
    name = {"outside": "../../../secret.png", "network": "http://127.0.0.1:9/picture.png"}.get(
        lies, "picture.png"
    )
    if lies == "beside":
        (meshes / name).write_bytes(content)
    elif lies == "in textures":
        (meshes.parent / "textures").mkdir()
        (meshes.parent / "textures" / name).write_bytes(content)
    elif lies == "link":
        (meshes / name).symlink_to(tmp_path / "secret.png")
    elif lies == "postscript":  # which Pillow passes to Ghostscript
        (meshes / name).write_bytes(b"%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: 0 0 2 2\nshowpage\n")
    (part,) = read(meshes, "box.dae", collada(texture=name)).parts
    assert (part.texture is not None) == (lies in ("beside", "in textures"))


def test_a_surface_with_a_missing_material_is_kept(tmp_path: Path) -> None:
    """pycollada drops geometry with a missing material; ANYmal's foot was once not drawn."""
    mesh = read(tmp_path, "box.dae", collada(material="gone"))
    assert volume(mesh) == pytest.approx(6.0, rel=FLOAT)
    assert mesh.parts[0].colors[0].tolist() == [184, 186, 191, 255]


def nodes_of_nodes(levels: int) -> str:
    """Return a scene of 2^levels nodes."""
    library = "".join(
        f'<node id="n{k}">' + f'<instance_node url="#n{k - 1}"/>' * 2 * (k > 0) + "</node>"
        for k in range(levels)
    )
    text = collada().replace(
        "<library_visual_scenes>", f"<library_nodes>{library}</library_nodes><library_visual_scenes>"
    )
    return text.replace(
        "</visual_scene>", f'<node><instance_node url="#n{levels - 1}"/></node></visual_scene>'
    )


LAUGHS = '<!DOCTYPE x [<!ENTITY a "ha"><!ENTITY b "&a;&a;">]>'
ENDLESS = np.where(CORNERS == 3.0, np.inf, CORNERS)

BAD: dict[str, tuple[str | bytes, str]] = {
    "empty.stl": (b"", "it is empty"),
    "header.stl": (stl_binary()[:84], "it declares 12 triangles but contains 0"),
    "short.stl": (stl_binary()[:400], "it declares 12 triangles but contains 6"),
    "nothing.stl": ("solid\nendsolid\n", "no triangles of nonzero area"),
    "words.stl": ("solid\nfacet\nvertex a b c\nendsolid\n", "cannot be read"),
    "document.dae": (collada().replace("<COLLADA", f"{LAUGHS}<COLLADA"), "document type"),
    "document16.dae": (
        f'<?xml version="1.0" encoding="utf-16"?>{LAUGHS}<COLLADA/>'.encode("utf-16"),
        "document type",
    ),
    "scene.dae": ("<COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema'/>", "no <visual_scene>"),
    "bare.dae": (collada(matrices=()), "no triangles of nonzero area"),
    "page.dae": ("<html><body>404</body></html>", "not a Collada file: its root is <html>"),
    "torn.dae": (collada()[:2000], "cannot be read"),
    "number.dae": (collada(corners=ENDLESS), "not finite"),
    "many.dae": (nodes_of_nodes(60), "more than 100000 nodes"),
    "number.obj": (obj(QUADS).replace("3.0", "nan"), "not finite"),
    "far.obj": ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 7\n", "cannot be read"),
    "points.ply": (ply().replace("element face 12", "element face 0").split("3 0 1 3")[0], "no triangles"),
    "torn.stl": (stl_text()[:500] + "?" + stl_text()[500:], "cannot be read"),
    "torn.glb": (glb()[:100], "cannot be read"),
    "line.obj": ("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "no triangles of nonzero area"),
    "craft.3ds": (b"?", r"its format is not supported; convert it to one of \.dae, \.glb"),
}


@pytest.mark.parametrize("name", BAD)
def test_a_file_without_a_mesh_is_an_error_that_names_it(
    name: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    content, reason = BAD[name]
    with pytest.raises(oo.exceptions.ReadError, match=f"{name} cannot be read: .*{reason}|{name} {reason}"):
        read(tmp_path, name, content)
    assert capfd.readouterr() == ("", "")  # trimesh printed a traceback


def test_folders_pipes_and_missing_files_are_not_meshes(tmp_path: Path) -> None:
    (tmp_path / "folder.stl").mkdir()
    os.mkfifo(tmp_path / "pipe.stl")
    for name, reason in (("folder", "is a folder"), ("pipe", "a pipe or a device")):
        with pytest.raises(oo.exceptions.ReadError, match=reason):
            read_mesh(tmp_path / f"{name}.stl")
    with pytest.raises(oo.exceptions.NotFoundError):
        read_mesh(tmp_path / "gone.stl")


def test_a_file_is_read_once_and_again_when_it_changed(tmp_path: Path) -> None:
    first = read(tmp_path, "box.stl", stl_binary())
    assert read_mesh(tmp_path / "box.stl") is first
    assert read(tmp_path, "box.stl", stl_text()) is not first


def robot(folder: Path, *visuals: str, collision: str = "") -> oo.Model:
    """Returns a robot with one link per mesh."""
    links = "".join(
        f'<link name="link_{k}"><inertial><mass value="1"/>'
        '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>'
        f"</inertial><visual><geometry><mesh {mesh}/></geometry></visual>{collision if k else ''}</link>"
        for k, mesh in enumerate(visuals)
    )
    joints = "".join(
        f'<joint name="j{k}" type="continuous"><parent link="link_0"/><child link="link_{k}"/>'
        '<axis xyz="0 0 1"/></joint>'
        for k in range(1, len(visuals))
    )
    (folder / "craft.urdf").write_text(f'<robot name="craft">{links}{joints}</robot>')
    return oo.Model.from_urdf(folder / "craft.urdf")


def test_an_unusable_mesh_is_warned_about_once_and_replaced(tmp_path: Path) -> None:
    (tmp_path / "short.stl").write_bytes(stl_binary()[:400])
    (tmp_path / "box.stl").write_bytes(stl_binary())
    (tmp_path / "hull.stl").write_bytes(stl_binary())
    hull = '<collision><geometry><mesh filename="hull.stl" scale="2 2 2"/></geometry></collision>'
    model = robot(
        tmp_path, 'filename="box.stl"', 'filename="short.stl"', 'filename="short.stl"', collision=hull
    )
    with pytest.warns(
        UserWarning, match="the mesh of link 'link_1' is not drawn: .*not a complete STL file"
    ) as caught:
        drawn = shapes(model)
    assert len(caught) == 1
    shapes(model)  # a warning would fail the test
    assert [(shape.link, shape.kind) for shape in drawn] == [(f"link_{k}", "mesh") for k in range(3)]
    np.testing.assert_allclose(drawn[1].mesh.bounds[1], [2, 4, 6], rtol=FLOAT)  # type: ignore[union-attr]
    assert [Path(name).name for name in missing_meshes(model)] == ["short.stl"]


def test_a_collision_mesh_replaces_a_missing_visual_mesh(tmp_path: Path) -> None:
    (tmp_path / "hull.stl").write_bytes(stl_binary())
    hull = '<collision><geometry><mesh filename="{}.stl"/></geometry></collision>'
    with pytest.warns(UserWarning, match=r"^1 mesh file was not found: 'package://gone/arm\.stl'"):
        model = robot(
            tmp_path, 'filename="hull.stl"', 'filename="package://gone/arm.stl"',
            collision=hull.format("hull") + hull.format("gone"),
        )  # fmt: skip
    assert [(shape.link, shape.kind) for shape in shapes(model)] == [("link_0", "mesh"), ("link_1", "mesh")]


@pytest.mark.parametrize("scale", ["1e6 1e6 1e6", "0 0 0"])
def test_a_mesh_of_an_absurd_size_is_not_drawn(scale: str, tmp_path: Path) -> None:
    (tmp_path / "box.stl").write_bytes(stl_binary())
    model = robot(tmp_path, f'filename="box.stl" scale="{scale}"')
    with pytest.warns(UserWarning, match=r"is not drawn: .* m with scale .*correct the scale or the unit"):
        assert next(shape.kind for shape in shapes(model)) == "box"


def test_figures_have_fewer_triangles_of_the_same_shape(tmp_path: Path) -> None:
    turn = np.linspace(0.0, 2.0 * np.pi, 200, endpoint=False)
    ring = np.stack([np.cos(turn), np.sin(turn)], axis=-1)
    points = np.vstack([np.column_stack([ring, np.full(200, z)]) for z in np.linspace(0.0, 1.0, 50)])
    lines = ["v {:.9f} {:.9f} {:.9f}".format(*point) for point in points]
    for row in range(49):
        for k in range(200):
            a, b = 200 * row + k + 1, 200 * row + (k + 1) % 200 + 1
            lines.append(f"f {a} {b} {b + 200} {a + 200}")
    mesh = read(tmp_path, "tube.obj", "\n".join(lines))
    ((corners, colors),) = coarse(mesh.parts, 2.0, 2000)
    assert 500 < len(corners) <= 2000 and len(colors) == len(corners)
    a, b, c = corners.swapaxes(0, 1)
    found = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2.0
    assert found == pytest.approx(2.0 * np.pi, rel=0.1)  # half a cube is lost at each edge
    ((whole, _),) = coarse(mesh.parts, 2.0, MOST_TRIANGLES)
    assert len(whole) == 2 * 49 * 200
    np.testing.assert_array_equal(corners, coarse(mesh.parts, 2.0, 2000)[0][0])


def test_mesh_libraries_are_loaded_only_for_meshes(tmp_path: Path) -> None:
    program = "import sys, onorbit_rs.viewer.solids; print({'trimesh', 'collada', 'PIL'} & set(sys.modules))"
    done: Any = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert "trimesh" not in done.stdout and "collada" not in done.stdout
