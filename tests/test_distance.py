"""Distances of links: poses, collision elements, meshes, and invalid input."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest
from collision_robots import (
    CUBE,
    CUBE_FACES,
    INERTIAL,
    binary_stl,
    body,
    element,
    obj_file,
    random_pose,
    world_of,
)

import onorbit_rs as oo

BOX = "<box size='1 1 1'/>"
BALL = "<sphere radius='0.2'/>"
ARM = f"""<robot name='r'>
<link name='bus'>{INERTIAL}{element(BOX)}</link>
<link name='arm'>{INERTIAL}{element("<capsule radius='0.1' length='1'/>", (0, 0, 0.5))}</link>
<link name='mast'>{INERTIAL}{element(BALL, (1, 0, 0))}{element(BALL, (2, 0, 0))}</link>
<link name='bare'/>
<joint name='j' type='revolute'><parent link='bus'/><child link='arm'/><origin xyz='0 0 1'/>
<axis xyz='1 0 0'/><limit lower='-3' upper='3' effort='1' velocity='1'/></joint>
<joint name='k' type='fixed'><parent link='bus'/><child link='mast'/><origin xyz='2 0 0'/></joint>
<joint name='l' type='fixed'><parent link='bus'/><child link='bare'/></joint>
</robot>"""


@pytest.fixture(scope="module")
def model() -> oo.Model:
    return oo.Model.from_urdf_string(ARM)


def test_the_distance_follows_the_joints(model: oo.Model) -> None:
    q = model.neutral()
    for angle in np.linspace(-2.0, 2.0, 9):
        q[7] = angle
        found = oo.distance(model, q, "bus", "arm")
        # the lower end of the axis is 0.5 m above the box, and above its other end up to a quarter turn
        end = 1.0 + min(0.0, np.cos(angle))
        far = max(0.0, np.abs(np.sin(angle)) - 0.5) if np.cos(angle) < 0 else 0.0
        if far == 0.0:
            assert abs(found.distance - (end - 0.5 - 0.1)) < 1e-14
        np.testing.assert_allclose(found.point_b - found.point_a, found.distance * found.normal, atol=1e-14)
        back = oo.distance(model, q, "arm", "bus")
        assert back.distance == found.distance
        np.testing.assert_array_equal(back.normal, -found.normal)


def test_the_distance_is_in_w_and_independent_of_the_base(model: oo.Model) -> None:
    rng = np.random.default_rng(1)
    q = model.neutral()
    q[7] = 0.4
    at_home = oo.distance(model, q, "arm", "mast")
    for _ in range(20):
        q[:7] = random_pose(rng, 5.0)
        found = oo.distance(model, q, "arm", "mast")
        assert abs(found.distance - at_home.distance) < 1e-13
        pose = model.frame_pose(q, "bus")
        np.testing.assert_allclose(found.normal, pose[:3, :3] @ at_home.normal, atol=1e-13)
        np.testing.assert_allclose(found.point_a, pose[:3, :3] @ at_home.point_a + pose[:3, 3], atol=1e-13)


def test_a_link_with_several_elements_has_the_distance_of_the_nearest(model: oo.Model) -> None:
    found = oo.distance(model, model.neutral(), "bus", "mast")
    assert abs(found.distance - (3.0 - 0.5 - 0.2)) < 1e-14
    np.testing.assert_allclose(found.point_b, [2.8, 0, 0], atol=1e-14)
    assert repr(found) == "<Distance 2.3 m along [1, 0, 0]>"


def test_systems_of_a_world_are_named_by_paths() -> None:
    world = world_of(body(element(BOX)), body(element("<sphere radius='0.5'/>")))
    q = {"a": [0, 0, 0, 0, 0, 0, 1], "b": [0, 2, 0, 0, 0, 0, 1]}
    assert oo.distance(world, q, "a/body", "b/body").distance == 1.0
    q["b"] = [0, 0.75, 0, 0, 0, 0, 1]
    assert oo.distance(world, q, "a/body", "b/body").distance == -0.25


def test_meshes_are_convex_hulls_without_warnings_if_they_are_closed(tmp_path: Path) -> None:
    ascii_stl = tmp_path / "ascii.stl"
    loops = "".join(
        "facet normal 0 0 0\nouter loop\n"
        + "".join(f"vertex {x} {y} {z}\n" for x, y, z in CUBE[list(face)])
        + "endloop\nendfacet\n"
        for face in CUBE_FACES
    )
    ascii_stl.write_text(f"solid cube\n{loops}endsolid cube\n")
    files = [
        obj_file(tmp_path / "cube.obj", CUBE, CUBE_FACES),
        binary_stl(tmp_path / "b.STL", CUBE, CUBE_FACES),
    ]
    rng = np.random.default_rng(3)
    ball = "<sphere radius='0.3'/>"
    poses = [{"a": random_pose(rng, 0.5), "b": random_pose(rng, 1.5)} for _ in range(20)]
    expected = [
        oo.distance(world_of(body(element(BOX)), body(element(ball))), q, "a/body", "b/body") for q in poses
    ]
    for file in [*files, ascii_stl]:
        world = world_of(body(element(f"<mesh filename='{file}'/>")), body(element(ball)))
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            found = [oo.distance(world, q, "a/body", "b/body") for q in poses]
        for one, other in zip(found, expected, strict=True):
            assert abs(one.distance - other.distance) < 1e-13
    scaled = body(element(f"<mesh filename='{files[0]}' scale='2 1 -1'/>"))
    q = {"a": [0, 0, 0, 0, 0, 0, 1], "b": [3, 0, 0, 0, 0, 0, 1]}
    assert (
        abs(oo.distance(world_of(scaled, body(element(ball))), q, "a/body", "b/body").distance - 1.7) < 1e-13
    )


@pytest.mark.parametrize(
    ("faces", "message"),
    [
        (CUBE_FACES[1:], "is open or inconsistently oriented at 3 edges; its convex hull is used"),
        ([face[::-1] for face in CUBE_FACES], "is inside out"),
        ([CUBE_FACES[0][::-1], *CUBE_FACES[1:]], "is open or inconsistently oriented at 3 edges"),
    ],
)
def test_a_mesh_with_a_defect_is_a_hull_with_one_warning(
    faces: list[tuple[int, int, int]], message: str, tmp_path: Path
) -> None:
    file = obj_file(tmp_path / "cube.obj", CUBE, faces)
    world = world_of(body(element(f"<mesh filename='{file}'/>")), body(element(BOX)))
    q = {"a": [0, 0, 0, 0, 0, 0, 1], "b": [2, 0, 0, 0, 0, 0, 1]}
    with pytest.warns(UserWarning, match=message) as caught:
        assert abs(oo.distance(world, q, "a/body", "b/body").distance - 1.0) < 1e-13
        oo.distance(world, q, "a/body", "b/body")
    assert len(caught) == 1


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "a convex hull with a volume cannot be formed"),
        ("a.obj", "v 0 0\n", "line 1 is 'v 0 0'; expected a vertex with three numbers"),
        ("b.obj", "v 0 0 0\nf 1 2 3\n", "line 2 is 'f 1 2 3'; expected a face with at least three"),
        ("c.obj", "", "the file has no triangles"),
        (
            "d.obj",
            "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
            "a vertex coordinate is infinite, NaN or too large",
        ),
        ("e.dae", "<x/>", "the file name must end in .stl or .obj; convert the mesh to STL or OBJ"),
        (
            "f.stl",
            "solid x\nvertex 0 0 0\nendloop\n",
            "the loop that ends in line 3 has 1 instead of 3 vertices",
        ),
    ],
)
def test_an_invalid_mesh_is_an_error_with_the_link_and_the_file(
    name: str, content: str, message: str, tmp_path: Path
) -> None:
    (tmp_path / name).write_text(content)
    world = world_of(body(element(f"<mesh filename='{tmp_path / name}'/>")), body(element(BOX)))
    q = {"a": [0, 0, 0, 0, 0, 0, 1], "b": [2, 0, 0, 0, 0, 0, 1]}
    with pytest.raises(oo.exceptions.ModelError) as caught, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        oo.distance(world, q, "a/body", "b/body")
    assert message in str(caught.value) and "of the link 'body' cannot be used" in str(caught.value)
    assert name in str(caught.value) and caught.value.link == "body"


def test_a_missing_mesh_and_an_invalid_shape_are_errors() -> None:
    q = {"a": [0, 0, 0, 0, 0, 0, 1], "b": [2, 0, 0, 0, 0, 0, 1]}
    for geometry, message in [
        (
            "<mesh filename='package://lost/a.stl'/>",
            "there is no mesh file 'package://lost/a.stl'; correct its name",
        ),
        ("<mesh scale='1 1 1'/>", "<mesh> of link 'body' has no attribute 'filename'; add the attribute"),
        ("<sphere radius='0'/>", "link 'body': radius of <sphere> is 0 m; it must be positive"),
        ("<box size='1 -1 1'/>", "link 'body': size"),
    ]:
        # another element does not hide the invalid one
        world = world_of(body(element(BOX), element(geometry)), body(element(BOX)))
        with pytest.raises(oo.exceptions.ModelError, match="of the link 'body' cannot be used") as caught:
            oo.distance(world, q, "a/body", "b/body")
        assert message in str(caught.value)


def test_wrong_names_and_configurations_name_the_fix(model: oo.Model) -> None:
    q = model.neutral()
    errors = oo.exceptions
    for a, b, error, message in [
        ("bus", "amr", errors.FrameError, "there is no frame 'amr'; did you mean 'arm'?"),
        (
            "bus",
            "bare",
            errors.ModelError,
            "give it a <collision> element, or use one of the links that have one: bus, ",
        ),
        ("bus", "bus", errors.InputError, "a and b are both 'bus'"),
        ("bus", 3, errors.DtypeError, "b is of type int"),
    ]:
        with pytest.raises(error) as caught:
            oo.distance(model, q, a, b)  # type: ignore[arg-type]
        assert message in str(caught.value)
    with pytest.raises(errors.ShapeError, match=r"\(2, 8\); expected \(8,\)"):
        oo.distance(model, np.stack([q, q]), "bus", "arm")
    with pytest.raises(errors.InputError, match="NaN"):
        oo.distance(model, q * np.nan, "bus", "arm")
    with pytest.raises(errors.DtypeError, match="expected a Model or a World"):
        oo.distance("robot.urdf", q, "bus", "arm")  # type: ignore[arg-type]
    with pytest.raises(errors.ModelError, match="no link of the robot has one"):
        world = world_of(body(), body())
        oo.distance(world, {"a": q[:7], "b": q[:7]}, "a/body", "b/body")


def test_names_of_a_world_are_checked() -> None:
    world = world_of(body(element(BOX)), body(element(BOX)))
    q = {"a": [0, 0, 0, 0, 0, 0, 1], "b": [2, 0, 0, 0, 0, 0, 1]}
    errors = oo.exceptions
    with pytest.raises(errors.WorldError, match="there is no system 'c'; the systems are: a, b"):
        oo.distance(world, q, "c/body", "b/body")
    with pytest.raises(errors.WorldError, match="write SYSTEM/LINK"):
        oo.distance(world, q, "a/body", "body")
    with pytest.raises(errors.FrameError, match="there is no frame 'bodi'; did you mean 'body'"):
        oo.distance(world, q, "a/body", "b/bodi")
    with pytest.raises(errors.InputError, match=r"add q\['b'\]"):
        oo.distance(world, {"a": q["a"]}, "a/body", "b/body")
    with pytest.raises(errors.DtypeError, match="expected a dict"):
        oo.distance(world, q["a"], "a/body", "b/body")
