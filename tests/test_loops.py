"""Closed loops and mimic joints in Python."""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
import pytest
from looped_robots import at_x, closing, linkage, rod, start

import onorbit_rs as oo
from onorbit_rs.exceptions import ConvergenceError, DtypeError, FrameError, InputError, ModelError, WorldError
from onorbit_rs.robots.fingerprint import fingerprint


def looped(**options: Any) -> oo.Model:
    builder = linkage()
    builder.add_link(
        "finger",
        parent="base",
        joint="finger",
        xyz=[-0.6, 0.2, 0.0],
        mimic=("left", -2.0, 0.3),
        **rod(0.6, 0.4),
    )
    builder.close(closing(**options))
    return builder.build()


def permitted(model: oo.Model) -> tuple[Any, Any]:
    q = model.closed_configuration(start(model))
    return q, model.closed_velocity(q, np.linspace(-0.5, 1.0, model.nv))


def test_loops_and_mimics_are_listed() -> None:
    model = looped()
    assert [(loop.name, loop.kind, loop.rows) for loop in model.loops] == [("closing", "revolute", 5)]
    assert [joint.mimic for joint in model.joints] == [None, None, None, ("left", -2.0, 0.3)]
    assert "1 loop, 1 mimic joint" in repr(model)
    assert model.loops[0] == closing() != closing(kind="weld")


def test_the_nearest_closed_state_keeps_the_momentum() -> None:
    model = looped()
    q = start(model)
    closed, _ = permitted(model)
    assert np.abs(model.loop_errors(q)).max() > 0.1
    assert np.abs(model.loop_errors(closed)).max() < 1e-15
    assert closed[10] == pytest.approx(-2.0 * closed[7] + 0.3, abs=1e-15)
    v = np.linspace(-0.5, 1.0, model.nv)
    change = model.momentum(closed, model.closed_velocity(closed, v)) - model.momentum(closed, v)
    assert np.abs(change).max() < 1e-15


def test_an_extended_prismatic_loop_is_closed_from_nearby() -> None:
    builder = oo.ModelBuilder("telescope", base="base", mass=4.0, inertia=np.diag([0.3, 0.4, 0.5]))
    builder.add_link("tube", parent="base", joint="hinge", axis=[0.0, 1.0, 0.0], **rod(0.5, 0.4))
    builder.add_link("boom", parent="tube", joint="slide", kind="prismatic", **rod(0.5, 0.4))
    guide = np.eye(4)
    guide[2, 3] = 0.2
    model = builder.build().with_loops([oo.Loop("guide", "prismatic", "base", "boom", pose_a=guide)])
    q = model.neutral()
    q[7:] = [1e-3, 1.2]  # the hinge is 0.2 m from the guide, and the boom 1 m
    closed = model.closed_configuration(q)
    assert np.abs(model.loop_errors(closed)).max() < 1e-15
    assert closed[7:] == pytest.approx([0.0, 1.2], abs=1e-5)
    assert np.abs(model.loop_errors(q)).max() > 1e-3  # negative control


CHAIN_ANGLES = np.array([0.4, -0.7, 0.9, 0.5, -0.3])


def short_chain() -> tuple[oo.Model, Any]:
    """Return a chain of five joints welded to its base, with a configuration that closes the loop.

    The loop has six constraints, more than the chain has joints.
    """
    builder = oo.ModelBuilder("chain", base="base", mass=20.0, inertia=np.eye(3))
    parent = "base"
    for k, axis in enumerate(([0, 0, 1], [0, 1, 0], [1, 0, 1], [0, 1, 1], [1, 1, 0])):
        unit = np.array(axis) / np.linalg.norm(axis)
        xyz = [0.3, 0.05 * k, 0.1]
        builder.add_link(
            f"link{k}", parent=parent, joint=f"joint{k}", axis=unit, xyz=xyz, **rod(1.0 + k, 0.3)
        )
        parent = f"link{k}"
    tree = builder.build()
    q = tree.neutral()
    q[7:] = CHAIN_ANGLES
    pose = np.linalg.solve(tree.frame_pose(q, "base"), tree.frame_pose(q, "link4"))
    return tree.with_loops([oo.Loop("weld", "weld", "base", "link4", pose_a=pose)]), q


def test_loops_with_more_constraints_than_joints_are_closed_from_far_away() -> None:
    """From most of these starts, Newton's method without damping does not converge."""
    model, closed = short_chain()
    rng, found = np.random.default_rng(3), 0
    for _ in range(60):
        q = closed.copy()
        q[7:] += rng.uniform(-1.2, 1.2, 5)
        try:
            nearest = model.closed_configuration(q)
        except ConvergenceError:
            continue  # a local minimum of the opening
        found += 1
        assert np.abs(model.loop_errors(nearest)).max() < 1e-14
        assert np.abs(np.linalg.norm(nearest[3:7]) - 1.0) < 1e-15
    assert found >= 50


def test_a_loop_that_cannot_be_closed_is_refused() -> None:
    model, closed = short_chain()
    pose = np.array(model.loops[0].pose_a)
    pose[0, 3] += 5.0  # beyond the reach of the chain
    far = model.with_loops([oo.Loop("far", "spherical", "base", "link4", pose_a=pose)])
    with pytest.raises(ConvergenceError, match="'far' stays open by"):
        far.closed_configuration(closed)


def test_the_acceleration_keeps_the_loops_closed() -> None:
    model = looped()
    q, v = permitted(model)
    tau = np.linspace(1.0, -1.0, model.nv)
    step = 1e-4

    def opening(a: Any) -> float:
        """Return the largest second derivative of a loop error, by differences along the motion."""
        ends = [model.integrate(q, step * (sign * v + 0.5 * step * a)) for sign in (1.0, -1.0)]
        errors = sum(model.loop_errors(end) for end in ends) - 2.0 * model.loop_errors(q)
        return float(np.abs(errors).max() / step**2)

    a, forces = model.constrained_forward_dynamics(q, v, tau)
    free = model.forward_dynamics(q, v, tau)
    assert forces.shape == (6,)
    assert opening(a) < 1e-5
    assert opening(free) > 0.1  # negative control
    # the constraint forces do no work on a permitted velocity
    reaction = model.inverse_dynamics(q, v, a) - tau
    assert abs(reaction @ v) < 1e-13 * np.abs(reaction).max()
    # the first two rows are the force of the pin on the crank in the axes of the coupler
    assert reaction[8] == pytest.approx(_torque_of_pin(model, q, forces[:2]), rel=1e-12)


def _torque_of_pin(model: oo.Model, q: Any, force: Any) -> float:
    """Return the torque about the pivot of the right crank of a force at its tip, N m."""
    coupler, crank = model.frame_pose(q, "coupler"), model.frame_pose(q, "right_crank")
    arm = crank[:3, :3] @ [0.4, 0.0, 0.0]
    return float(np.cross(arm, coupler[:3, :2] @ force) @ crank[:3, 2])


def test_batches_and_further_loops_agree_with_the_model() -> None:
    model = looped()
    q, v = permitted(model)
    tau = np.ones(model.nv)
    a, forces = model.constrained_forward_dynamics(q, v, tau)
    many = [np.tile(x, (11, 1)) for x in (q, v, tau)]
    rows, many_forces = model.constrained_forward_dynamics(*many, threads=2)
    assert np.abs(rows - a).max() < 1e-13
    assert np.abs(many_forces - forces).max() < 1e-13
    assert model.loop_errors(many[0]).shape == (11, 6)
    builder = linkage()
    tree = builder.build()
    q, v = q[:10], v[:9]
    closed = tree.with_loops([closing()])
    v = closed.closed_velocity(q, v)
    one = tree.constrained_forward_dynamics(q, v, np.ones(9), [closing()])
    two = closed.constrained_forward_dynamics(q, v, np.ones(9))
    assert all(np.array_equal(x, y) for x, y in zip(one, two, strict=True))
    plain = tree.constrained_forward_dynamics(q, v, np.ones(9))
    assert np.array_equal(plain[0], tree.forward_dynamics(q, v, np.ones(9)))
    assert plain[1].shape == (0,)


def test_copies_keep_loops_and_mimics() -> None:
    robot = oo.Model.from_urdf_string(URDF)
    closed = robot.with_loops([oo.Loop("rod", "distance", "left", "right", project=True)])
    again = pickle.loads(pickle.dumps(closed))
    assert again.loops == closed.loops
    assert fingerprint(again) == fingerprint(closed) != fingerprint(robot)
    other = closed.rerooted("left")
    assert other.loops == closed.loops
    assert {joint.name: joint.mimic for joint in other.joints}["right"] == ("left", 1.0, 0.0)
    bus = oo.Model.rigid_body(100.0, np.eye(3))
    both = oo.attach(bus, "base", closed, prefix="hand_")
    assert [(loop.name, loop.frame_a) for loop in both.loops] == [("hand_rod", "hand_left")]
    assert both.joints[1].mimic == ("hand_left", 1.0, 0.0)
    loop = closing(project=True)
    assert pickle.loads(pickle.dumps(loop)) == loop


def test_a_mimic_changes_the_fingerprint() -> None:
    text = URDF.replace('<mimic joint="left"/>', "")
    assert fingerprint(oo.Model.from_urdf_string(text)) != fingerprint(oo.Model.from_urdf_string(URDF))


def test_systems_and_worlds_accept_loops() -> None:
    tree, model = linkage().build(), linkage().build().with_loops([closing()])
    q = model.closed_configuration(start(model))
    v = model.closed_velocity(q, np.eye(9)[6])
    alone = oo.Simulation(oo.World([oo.System("a", tree, q, v, loops=[closing()])]), time_step=1e-3)
    on_paths = oo.Loop(
        "closing", "revolute", "a/coupler", "a/right_crank", pose_a=at_x(0.5), pose_b=at_x(0.4)
    )
    world = oo.World([oo.System("a", tree, q, v), oo.System("b", tree, q, v)], loops=[on_paths])
    trace = oo.Simulation(world, time_step=1e-3).run(0.5)
    assert np.array_equal(trace["a"].q, alone.run(0.5).q)
    assert np.abs(model.loop_errors(trace["a"].q)).max() < 1e-14
    assert np.abs(model.loop_errors(trace["b"].q)).max() > 1e-3  # negative control: no loop


def test_pickled_worlds_keep_loops() -> None:
    robot = oo.Model.from_urdf_string(URDF)
    q, v = robot.neutral(), np.eye(8)[5]  # the jaws move outwards as the robot turns
    rod = oo.Loop("rod", "distance", "a/left", "a/right")
    world = oo.World([oo.System("a", robot, q, v)], loops=[rod])
    traces = [
        oo.Simulation(one, time_step=0.01).run(0.1) for one in (world, pickle.loads(pickle.dumps(world)))
    ]
    assert np.array_equal(traces[0].q, traces[1].q)
    free = oo.Simulation(oo.World([oo.System("a", robot, q, v)]), time_step=0.01).run(0.1)
    assert np.abs(free.q - traces[0].q).max() > 1e-4  # negative control: without the rod


def test_loops_of_two_systems_are_refused() -> None:
    tree = linkage().build()
    systems = [oo.System(name, tree, tree.neutral(), np.zeros(9)) for name in ("a", "b")]
    for frames, problem in [
        (("a/coupler", "b/coupler"), r"two systems, 'a' and 'b'.*oo.Capture\('x', 'a/coupler'"),
        (("a/coupler", "coupler"), "as in 'a/FRAME'"),
        (("a/coupler", "c/coupler"), "no system 'c'; the systems are: a, b"),
    ]:
        with pytest.raises(WorldError, match=problem):
            oo.World(systems, loops=[oo.Loop("x", "weld", *frames)])
    with pytest.raises(FrameError, match="did you mean 'coupler'"):
        oo.World(systems, loops=[oo.Loop("x", "weld", "a/base", "a/couple")])


def test_invalid_loops_are_refused() -> None:
    tree = linkage().build()
    for arguments, problem in [
        (("x", "ball", "base", "coupler"), "the kinds are weld, revolute, spherical, prismatic, distance"),
        (("x", "weld", "base", "base"), "connects frame 'base' with itself"),
        (("", "weld", "base", "coupler"), "name"),
    ]:
        with pytest.raises(ModelError, match=problem):
            tree.with_loops([oo.Loop(*arguments)])
    with pytest.raises(ModelError, match="only the kind 'distance' has"):
        oo.Loop("x", "weld", "base", "coupler", length=0.1)
    with pytest.raises(ModelError, match="same body"):
        builder = linkage()
        builder.add_frame("tip", "coupler")
        builder.close(oo.Loop("x", "weld", "tip", "coupler"))
        builder.build()
    with pytest.raises(DtypeError, match="ratio, offset"):
        linkage().add_link("x", parent="base", joint="x", mimic=3.0, **rod(1.0, 1.0))  # type: ignore[arg-type]


def test_friction_on_all_joints_of_a_loop_is_not_determined() -> None:
    def with_friction(*joints: str) -> oo.Model:
        builder = oo.ModelBuilder("linkage", base="base", mass=4.0, inertia=np.eye(3))
        for name, parent, xyz in (("left", "base", 0.0), ("knee", "left", 0.3), ("right", "base", 0.6)):
            friction = 0.1 if name in joints else 0.0
            builder.add_link(
                name, parent=parent, joint=name, xyz=[xyz, 0.0, 0.0], friction=friction, **rod(1.0, 0.3)
            )
        builder.add_link("other", parent="base", joint="other", **rod(1.0, 0.3))
        return builder.build()

    pin = oo.Loop("pin", "revolute", "knee", "right")
    with pytest.warns(UserWarning, match=r"joints of the loop 'pin' have friction \(left, knee, right\)"):
        looped = with_friction("left", "knee", "right").with_loops([pin])
    looped.with_loops([oo.Loop("rod", "distance", "base", "other", length=0.1)])  # no second warning
    with_friction("left", "right", "other").with_loops([pin])  # control: no warning


@pytest.mark.parametrize(
    ("leaders", "problem"),
    [
        (("f", None), "joint 'f' mimics itself"),
        (("g", "f"), "the joints 'f', 'g', 'f' mimic each other in a circle"),
        (("lefft", None), "joint 'f' mimics joint 'lefft', which does not exist; did you mean 'left'"),
    ],
)
def test_invalid_mimic_joints_are_refused(leaders: Any, problem: str) -> None:
    builder = linkage()
    for name, leader in zip("fg", leaders, strict=True):
        builder.add_link(name, parent="base", joint=name, mimic=leader, **rod(1.0, 0.4))
    with pytest.raises(ModelError, match=problem):
        builder.build()


def test_loops_that_cannot_be_closed_are_named() -> None:
    far = oo.Loop("far", "spherical", "base", "left_crank", pose_a=at_x(5.0), pose_b=at_x(0.2))
    model = linkage().build().with_loops([far])
    with pytest.raises(ConvergenceError, match=r"'far' stays open by 4\.\d+ m"):
        model.closed_configuration(start(model))


def test_a_mimic_joint_that_cannot_follow_is_named_with_its_unit() -> None:
    builder = linkage()
    builder.add_link(
        "slide", parent="base", joint="slide", kind="prismatic", mimic=("left", 1.0, 0.2), **rod(1.0, 0.4)
    )
    at_left = np.eye(4)
    at_left[:3, 3] = [0.1, 0.2, 0.0]
    welds = [
        oo.Loop("weld_left", "weld", "base", "left_crank", pose_a=at_left),
        oo.Loop("weld_slide", "weld", "base", "slide"),
    ]
    model = builder.build().with_loops(welds)
    message = r"the mimic joint 'slide' still differs by [0-9.e-]+ m from the position that its leader"
    with pytest.raises(ConvergenceError, match=message):
        model.closed_configuration(model.neutral())


def test_a_start_that_opens_a_loop_is_refused_unless_projected() -> None:
    model = linkage().build().with_loops([closing()])
    with pytest.raises(InputError, match=r"opens the loop 'closing' by 0.32.* m; .*'project: true'"):
        oo.Simulation(model, start(model), np.zeros(9), time_step=1e-3).run(0.01)
    model = linkage().build().with_loops([closing(project=True)])
    trace = oo.Simulation(model, start(model), np.zeros(9), time_step=1e-3).run(0.01)
    assert np.allclose(trace.q[0], model.closed_configuration(start(model)), atol=1e-14)


URDF = """<robot name="jaws">
  <link name="body"><inertial><mass value="2"/>
    <inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="left" type="prismatic"><parent link="body"/><child link="left"/>
    <origin xyz="0.1 0.05 0"/><axis xyz="0 1 0"/>
    <limit lower="0" upper="0.1" effort="10" velocity="1"/></joint>
  <link name="left"><inertial><mass value="0.2"/>
    <inertia ixx="0.001" iyy="0.001" izz="0.001" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="right" type="prismatic"><parent link="body"/><child link="right"/>
    <origin xyz="0.1 -0.05 0"/><axis xyz="0 -1 0"/><limit lower="0" upper="0.1" effort="10" velocity="1"/>
    <mimic joint="left"/></joint>
  <link name="right"><inertial><mass value="0.2"/>
    <inertia ixx="0.001" iyy="0.001" izz="0.001" ixy="0" ixz="0" iyz="0"/></inertial></link>
</robot>"""
