"""Frames and quantities of the topics against the engine."""

from __future__ import annotations

import warnings
from typing import Any
from xml.etree import ElementTree as xml

import numpy as np
import pytest
from ros2_runs import needs_ros2
from world_runs import trio

import onorbit_rs as oo
from onorbit_rs.robots.fingerprint import fingerprint
from onorbit_rs.robots.urdf import urdf_text
from onorbit_rs.scenario import load
from onorbit_rs.scenario.build import build

needs_ros2()

from onorbit_rs.ros2.messages import decode  # noqa: E402
from onorbit_rs.ros2.names import ros_names  # noqa: E402
from onorbit_rs.ros2.rows import Rows, rows_of_trace  # noqa: E402
from onorbit_rs.ros2.topics import topics  # noqa: E402
from onorbit_rs.ros2.transforms import SystemFrames, fixed_frames, frames_of  # noqa: E402


def matrix(pose: Any) -> Any:
    """Returns the matrix of a position and a quaternion xyzw."""
    x, y, z, w = pose[3:]
    found = np.eye(4)
    found[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    found[:3, 3] = pose[:3]
    return found


def chained(links: Any, poses: Any) -> dict[str, Any]:
    """Returns the pose in `world` of every frame below it."""
    found = {"world": np.eye(4)}
    left = list(zip(links, poses, strict=True))
    while left:
        known = [(link, pose) for link, pose in left if link.parent in found]
        assert known, f"no way from world to {left}"
        for link, pose in known:
            found[link.child] = found[link.parent] @ matrix(pose)
        left = [(link, pose) for link, pose in left if link.child not in found]
    return found


def robots() -> dict[str, oo.Model]:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of inertias
        return _robots()


def _robots() -> dict[str, oo.Model]:
    found = {name: oo.robots.load(name) for name in oo.robots.names()}
    servicer = found["servicer"]
    joined = oo.attach(servicer, "tool", found["target_satellite"], "handle", prefix="target_")
    for model in (servicer, joined):
        last = model.bodies[-1].name
        found[f"{model.name} of {len(model.bodies)} bodies from {last}"] = model.rerooted(last)
    return found


ROBOTS = robots()


@pytest.mark.filterwarnings("ignore:the inertia of link")
@pytest.mark.parametrize("name", ROBOTS)
def test_frames_are_those_of_the_engine(name: str) -> None:
    model = ROBOTS[name]
    rng = np.random.default_rng(3)
    q = np.stack([model.neutral()] * 4)
    q[:, :3] = rng.normal(size=(4, 3))
    q[:, 3:7] = rng.normal(size=(4, 4))
    q[:, 3:7] /= np.linalg.norm(q[:, 3:7], axis=1, keepdims=True)
    q[:, 7:] = rng.uniform(-2.0, 2.0, (4, len(model.joint_names)))
    moving = SystemFrames("", model, frames_of("", model))
    links, poses = fixed_frames("", model, frames_of("", model))
    for k, row in enumerate(moving.poses(Rows({"time": np.zeros(4), "q": q}))):
        found = chained([*moving.links, *links], [*row, *poses])
        assert set(found) == {"world", "base", *model.body_names, *(frame.name for frame in model.frames)}
        for frame in {*model.body_names, *(frame.name for frame in model.frames)}:
            np.testing.assert_allclose(found[frame], model.frame_pose(q[k], frame), atol=1e-12, err_msg=frame)


def test_a_rerooted_robot_has_joints_beside_the_origins_of_links() -> None:
    """Negative control: without the anchors, the chain of a rerooted robot would be wrong."""
    model = next(model for name, model in ROBOTS.items() if "from" in name)
    frames = SystemFrames("", model, frames_of("", model))
    assert frames._anchor.any()
    frames._anchor = np.zeros_like(frames._anchor)
    q = model.neutral()
    q[7:] = 1.0
    links, poses = fixed_frames("", model, frames_of("", model))
    found = chained(
        [*frames.links, *links], [*frames.poses(Rows({"time": np.zeros(1), "q": q[None]}))[0], *poses]
    )
    last = model.body_names[-1]
    assert np.abs(found[last] - model.frame_pose(q, last)).max() > 1e-3


def test_the_frames_of_the_orbit_are_those_of_the_trace() -> None:
    data = load("humanoid_reach").resolved()
    simulation = build(load(data)).simulation
    trace = simulation.run(0.5)
    rows = rows_of_trace(trace, simulation.models)
    found = topics(simulation.models, rows)
    poses = {}
    for topic, messages in found.messages(rows):
        content = decode(messages[-1].tobytes(), topic.kind)
        if topic.name == "/tf":
            for one in content.transforms:
                p, q = one.transform.translation, one.transform.rotation
                poses[one.header.frame_id, one.child_frame_id] = matrix([p.x, p.y, p.z, q.x, q.y, q.z, q.w])
        elif topic.name == "/orbit/pose":
            p, q = content.pose.position, content.pose.orientation
            orbit = matrix([p.x, p.y, p.z, q.x, q.y, q.z, q.w])
            assert content.header.frame_id == "eci"
        elif topic.name == "/orbit/twist":
            v, w = content.twist.linear, content.twist.angular
    r_eci, v_eci = trace.reference_position_eci[-1], trace.reference_velocity_eci[-1]
    world = poses["eci", "world"]
    np.testing.assert_array_equal(world, np.block([[np.eye(3), r_eci[:, None]], [np.zeros(3), 1.0]]))
    np.testing.assert_allclose(world @ poses["world", "lvlh"], orbit, atol=1e-12)
    np.testing.assert_allclose(poses["world", "base"][:3, 3] + r_eci, trace.position_eci[-1], rtol=1e-15)
    x, _, z = orbit[:3, :3].T
    np.testing.assert_allclose(x, r_eci / np.linalg.norm(r_eci), atol=1e-12)
    h = np.cross(r_eci, v_eci)
    np.testing.assert_allclose(z, h / np.linalg.norm(h), atol=1e-12)
    np.testing.assert_array_equal([v.x, v.y, v.z], v_eci)
    # ω turns the radius: dr/dt without its radial part is ω × r
    radial = x * (v_eci @ x)
    np.testing.assert_allclose(np.cross([w.x, w.y, w.z], r_eci), v_eci - radial, rtol=1e-9, atol=1e-6)


def test_the_description_contains_mimic_joints_but_no_shapes_that_urdf_lacks() -> None:
    hand = xml.fromstring(urdf_text(oo.robots.load("four_bar_gripper")))
    mimics = {joint.get("name"): joint.find("mimic") for joint in hand.iter("joint")}
    model = oo.robots.load("four_bar_gripper")
    for joint in model.joints:
        found = mimics[joint.name]
        given = None if found is None else (found.get("joint"), found.get("multiplier"), found.get("offset"))
        assert given == (joint.mimic and (joint.mimic[0], repr(joint.mimic[1]), repr(joint.mimic[2])))
    assert any(joint.mimic for joint in model.joints)
    gear = oo.Model.rigid_body(1.0, np.eye(3)).with_collision("base", oo.Shape.torus(0.1, 0.01))
    gear = gear.with_collision("base", oo.Shape.sphere(0.1))
    (geometry,) = xml.fromstring(urdf_text(gear)).iter("geometry")
    assert [shape.tag for shape in geometry] == ["sphere"]


@pytest.mark.filterwarnings("ignore:the inertia of link")
@pytest.mark.parametrize("name", [name for name in ROBOTS if "from" not in name])
def test_the_description_is_the_robot(name: str) -> None:
    model = ROBOTS[name]
    read = oo.Model.from_urdf_string(urdf_text(model))
    again = oo.Model.from_urdf_string(urdf_text(read))
    assert fingerprint(again) == fingerprint(read), "only the order of shapes and frames may change, once"
    for shapes in ("visuals", "collisions"):
        assert sorted(map(_shape, getattr(read, shapes))) == sorted(map(_shape, getattr(model, shapes)))
    q = model.neutral()
    q[7:] = np.random.default_rng(2).uniform(-1.0, 1.0, len(model.joint_names))
    np.testing.assert_allclose(read.mass_matrix(q), model.mass_matrix(q), rtol=1e-12, atol=1e-12)
    for body in model.body_names:
        np.testing.assert_allclose(read.frame_pose(q, body), model.frame_pose(q, body), atol=1e-12)
    for a, b in zip(model.joints, read.joints, strict=True):
        assert (a.name, a.kind, a.parent, a.child) == (b.name, b.kind, b.parent, b.child)
        for limit in ("lower", "upper", "effort", "velocity", "damping", "friction"):
            assert getattr(a, limit) == getattr(b, limit), limit


def _shape(shape: Any) -> Any:
    return shape.link, shape.kind, np.round(shape.pose, 12).tolist(), list(shape.size)


def test_a_description_of_a_rerooted_robot_is_refused() -> None:
    with pytest.raises(oo.exceptions.ModelError, match="URDF"):
        urdf_text(next(model for name, model in ROBOTS.items() if "from" in name))


@pytest.mark.filterwarnings("ignore:the inertia of link")
def test_wrenches_are_those_of_the_effects_about_another_point() -> None:
    data = load("leo_drag_tumble").resolved()
    data["simulation"]["record_wrenches"] = True
    built = build(load(data))
    trace = built.simulation.run(20 * data["simulation"]["time_step"])
    rows = rows_of_trace(trace, built.simulation.models)
    (model,) = built.simulation.models.values()
    found = topics(built.simulation.models, rows)
    about = np.array([0.3, -0.2, 0.5])
    checked = 0
    for effect, held in trace.wrenches.items():
        for index, body in enumerate(model.bodies):
            name = f"/wrench/{ros_names([effect], 'effect')[effect]}/{body.name}"
            (topic,) = (topic for topic in found.series if topic.name == name)
            content = decode(topic.messages(rows[topic.system])[-1].tobytes(), topic.kind)
            assert content.header.frame_id == body.name
            pose = np.asarray(model.frame_pose(trace.q[-1], body.name))
            f, t = content.wrench.force, content.wrench.torque
            force, torque = pose[:3, :3] @ [f.x, f.y, f.z], pose[:3, :3] @ [t.x, t.y, t.z]
            com = pose[:3, :3] @ body.com + pose[:3, 3]
            expected = np.asarray(held)[-1, index]
            np.testing.assert_allclose(force, expected[:3], rtol=1e-9, atol=1e-18)
            moment = torque + np.cross(pose[:3, 3] - about, force)
            np.testing.assert_allclose(
                moment, expected[3:] + np.cross(com - about, expected[:3]), rtol=1e-9, atol=1e-15
            )
            checked += bool(np.abs(expected).max() > 0.0)
    assert checked, "no effect acts"


def test_systems_have_prefixes_and_share_one_tree() -> None:
    world, trace = trio()
    rows = rows_of_trace(trace, world.simulation.models)
    found = topics(world.simulation.models, rows)
    names = {topic.name for topic in found.series}
    assert {"/chaser/joint_states", "/chaser/odom", "/target/odom", "/third/odom", "/tf", "/clock"} <= names
    assert "/target/joint_states" not in names, "a satellite without joints"
    parents: dict[str, str] = {}
    for topic, messages in found.messages(rows):
        if topic.name == "/tf":
            for one in decode(messages[0].tobytes(), topic.kind).transforms:
                assert one.child_frame_id not in parents, "a frame has one parent"
                parents[one.child_frame_id] = one.header.frame_id
    assert all(parents[f"{system}/base"] == "world" for system in ("chaser", "target", "third"))
    assert (parents["world"], parents["lvlh"]) == ("eci", "world")


def test_names_that_ros_does_not_allow_are_mapped_and_named() -> None:
    with pytest.warns(
        UserWarning,
        match=r"renamed links: 'a-b' → 'a_b', 'a b' → 'a_b_2', '1st' → 'n1st'",
    ):
        found = ros_names(["a-b", "a b", "1st", "ok"], "link")
    assert found == {"a-b": "a_b", "a b": "a_b_2", "1st": "n1st", "ok": "ok"}
    with pytest.warns(UserWarning):
        assert ros_names(["é", "__", "x/y/"], "link") == {"é": "x", "__": "x_2", "x/y/": "x_y"}
    with pytest.warns(UserWarning, match="renamed links: 'a-b' → 'a_b_2'$"):
        assert ros_names(["a-b", "a_b"], "link") == {"a-b": "a_b_2", "a_b": "a_b"}
    assert ros_names(["tool", "tool_2"], "link") == {"tool": "tool", "tool_2": "tool_2"}


CLASHING = """<robot name="r">
{links}
<joint name="a" type="revolute">
<parent link="{root}"/><child link="base"/><origin xyz="1 0 0"/><axis xyz="0 0 1"/>
<limit effort="1" velocity="1" lower="-1" upper="1"/></joint>
<joint name="b" type="revolute">
<parent link="base"/><child link="world"/><origin xyz="1 0 0"/><axis xyz="0 0 1"/>
<limit effort="1" velocity="1" lower="-1" upper="1"/></joint>
<joint name="c" type="fixed"><parent link="world"/><child link="lvlh"/></joint>
<joint name="d" type="fixed"><parent link="world"/><child link="base_2"/></joint>
</robot>"""


def clashing(root: str = "eci") -> oo.Model:
    """Returns a robot whose links and frames have the names of other frames of the tree."""
    body = (
        '<link name="{}"><inertial><mass value="1"/>'
        '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>'
    )
    links = "".join(map(body.format, [root, "base", "world"])) + '<link name="lvlh"/><link name="base_2"/>'
    return oo.Model.from_urdf_string(CLASHING.format(root=root, links=links))


def test_links_with_names_of_other_frames_get_names_of_their_own() -> None:
    model = clashing()
    with pytest.warns(
        UserWarning, match="'eci' → 'eci_2', 'base' → 'base_3', 'world' → 'world_2', 'lvlh' → "
    ):
        names = frames_of("", model)
    assert names == {
        "eci": "eci_2", "base": "base_3", "world": "world_2", "lvlh": "lvlh_2", "base_2": "base_2",
    }  # fmt: skip
    moving, (links, _) = SystemFrames("", model, names), fixed_frames("", model, names)
    children = [link.child for link in (*moving.links, *links)]
    assert sorted(children) == sorted(["base", *names.values()]), "each frame once"
    parents = {link.child: link.parent for link in (*moving.links, *links)}
    assert parents["base"] == "world" and parents["eci_2"] == "base" and parents["base_3"] == "eci_2"
    read = oo.Model.from_urdf_string(urdf_text(model, names))
    assert set(read.body_names) | {frame.name for frame in read.frames} == set(names.values())
    with pytest.warns(UserWarning, match="already have are renamed there: 'base' → 'base_3'$"):
        assert frames_of("chaser/", model)["world"] == "world", "chaser/world is another frame"


def test_a_root_link_named_base_is_the_base() -> None:
    """A robot whose root has the name keeps it, without a warning."""
    model = oo.Model.from_urdf_string(
        '<robot name="r"><link name="base"><inertial><mass value="1"/>'
        '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>'
    )
    assert frames_of("", model) == {"base": "base"}


def test_the_rate_of_a_perturbed_orbit_is_that_of_its_recorded_attitude() -> None:
    orbit = oo.Kepler(semi_major_axis=6.778e6, inclination=0.9, mean_anomaly=0.7, secular_j2=True)
    model = oo.robots.load("target_satellite")
    simulation = oo.Simulation(
        model, model.neutral(), np.zeros(model.nv), orbit=orbit, gravity_mode="carried", time_step=1.0
    )
    assert simulation.orbit is orbit
    rows = rows_of_trace(simulation.run(20.0), simulation.models)
    (own,) = rows.values()
    attitude = np.array([matrix([0.0, 0.0, 0.0, *quat])[:3, :3] for quat in own.orbit_attitude])
    # [ω] = Ṙ Rᵀ, by central differences
    spin = np.einsum("tij,tkj->tik", (attitude[2:] - attitude[:-2]) / 2.0, attitude[1:-1])
    expected = np.stack([spin[:, 2, 1], spin[:, 0, 2], spin[:, 1, 0]], axis=1)

    def rates(orbit: oo.Orbit | None) -> Any:
        found = topics(simulation.models, rows, orbit)
        (twist,) = (topic for topic in found.series if topic.name == "/orbit/twist")
        contents = [decode(raw.tobytes(), twist.kind) for raw in twist.messages(own)]
        w = [content.twist.angular for content in contents]
        return np.array([[one.x, one.y, one.z] for one in w])[1:-1]

    scale = np.linalg.norm(expected[0])
    exact = np.abs(rates(orbit) - expected).max() / scale
    without = np.abs(rates(None) - expected).max() / scale
    assert exact < 1e-6 < 1e-4 < without, (exact, without)
