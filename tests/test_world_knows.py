"""Controllers that know the model of what is captured."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.common.coordinates import JOINTS_Q, JOINTS_V

GRASPED = [0, 1.4260, 0, 1.3391, 0, -1.1943, 0]


def systems(controller: Any, target: Any, knows: list[str], rates: float = 1.0) -> list[Any]:
    servicer = oo.robots.load("servicer")
    q = servicer.neutral()
    q[JOINTS_Q] = GRASPED
    q_target = target.neutral()
    q_target[:3] = servicer.frame_pose(q, "tool")[:3, 3] - target.frame_pose(q_target, "handle")[:3, 3]
    v_target = np.zeros(target.nv)
    v_target[:6] = [0, 0, 0, 0.002 * rates, -0.003 * rates, 0.001 * rates]
    v_target[JOINTS_V] = 0.02
    first = oo.System("servicer", servicer, q, np.zeros(servicer.nv), controller=controller, knows=knows)
    return [first, oo.System("target", target, q_target, v_target)]


def panelled() -> Any:
    """Returns a target with a panel that turns freely."""
    builder = oo.ModelBuilder("target", base="bus", mass=200, inertia=np.diag([40.0, 60, 50]))
    builder.add_link(
        "panel", parent="bus", joint="hinge", axis=[0, 1, 0], xyz=[0, 0.8, 0],
        mass=20, com=[0.2, 0.5, 0], inertia=np.diag([4.0, 1, 5]),
    )  # fmt: skip
    builder.add_frame("handle", "bus", xyz=[-0.6, 0, 0])
    return builder.build()


def assert_certified(trace: oo.WorldTrace) -> None:
    for part in (trace, *(trace[name] for name in trace.names)):
        assert all(passed for _, _, _, passed in part.certificate()), part.certificate()


def tracking_error(knows: list[str], target: Any, law: Any) -> float:
    """Returns the largest joint error, rad, after 3 s; capture and motion of the reference start at 1 s."""
    path = oo.JointWaypoints([GRASPED, GRASPED, np.array(GRASPED) + 0.2], times=[0.0, 1.0, 6.0])
    control = oo.Control(law, reference=path, name="arm")
    world = oo.World(
        systems([control], target, knows),
        events=[oo.Capture("grasp", "servicer/tool", "target/handle", at=1.0)],
    )
    trace = oo.Simulation(world, time_step=2e-3, integrator="rk4").run(5.0)
    assert_certified(trace)
    error = trace["servicer"].tracking["arm"]
    return float(np.abs(error[trace["servicer"].time > 3.0]).max())


@pytest.mark.parametrize("target", ["target_satellite", "panelled", "sprung"])
def test_computed_torque_tracks_with_the_load_only_if_it_knows_it(target: str):
    model = oo.robots.load(target) if target == "target_satellite" else panelled()
    if target == "sprung":  # the panel oscillates by 0.3 rad
        model = model.with_joint("hinge", stiffness=10.0, rest_position=0.3)
    law = oo.JointComputedTorque(kp=49.0, kd=14.0)
    known, unknown = (tracking_error(knows, model, law) for knows in (["target"], []))
    assert known < 1e-5 < 0.1 < unknown, (known, unknown)


def test_torques_on_the_whole_tree_pass_the_check_of_the_attitude():
    # the base of the tree reacts to the torques of every tick unlike the base of the servicer alone
    servicer, target = oo.robots.load("servicer"), oo.robots.load("target_satellite")
    q = servicer.neutral()
    q[JOINTS_Q] = GRASPED
    tool = servicer.frame_pose(q, "tool")
    moved = tool.copy()
    moved[:3, 3] += [-0.2, 0.1, 0.1]
    reach = oo.Control(
        oo.ComputedTorque(servicer, "tool", kp=49.0, kd=14.0),
        reference=oo.Waypoints([tool, tool, moved], times=[0.0, 1.0, 6.0]),
    )
    push = oo.BodyWrench(f"target/{target.body_names[0]}", force=[0, 30, 0])
    world = oo.World(
        systems([reach], target, ["target"], rates=0.0),
        events=[oo.Capture("grasp", "servicer/tool", "target/handle", at=0.5)],
        environment=[push],
    )
    trace = oo.Simulation(world, time_step=2e-3).run(3.0)
    assert_certified(trace)
    checks = {name: value for name, value, _, _ in trace["servicer"].certificate()}
    assert 0.0 < checks["attitude_consistency"] < 0.05


def test_before_the_capture_knowledge_changes_nothing():
    law = oo.JointComputedTorque(kp=49.0, kd=14.0)
    q = {}
    for knows in ([], ["target"]):
        path = oo.JointWaypoints([GRASPED, np.array(GRASPED) + 0.1], times=[0.0, 2.0])
        world = oo.World(
            systems([oo.Control(law, reference=path, name="arm")], panelled(), knows),
            events=[oo.Capture("grasp", "servicer/tool", "target/handle", at=1.5)],
        )
        trace = oo.Simulation(world, time_step=2e-3).run(1.5)
        before = trace["servicer"].time < 1.5
        q[bool(knows)] = trace["servicer"].q[before]
    np.testing.assert_array_equal(q[True], q[False])


@pytest.mark.parametrize(
    ("known", "message"), [("tarjet", "not another system"), ("servicer", "not another")]
)
def test_unknown_systems_are_refused(known: str, message: str):
    with pytest.raises(oo.exceptions.WorldError, match=message):
        oo.World(systems(None, panelled(), [known]))


@pytest.mark.parametrize(
    ("knows", "captures", "message"),
    [
        (["c"], ["ab", "bc"], "only through 'b'; add 'b' to knows"),
        (["d"], ["ab", "bc", "cd"], "only through 'b' and 'c'; add 'b' and 'c' to knows"),
        (["d", "b"], ["ab", "bc", "cd"], "only through 'c'; add 'c' to knows"),
        (["b", "c"], ["ab"], "knows 'c' without effect, because no capture connects them"),
        (["b", "c"], ["ab", "bc"], None),
        (["c"], ["ab", "bc", "ca"], None),
    ],
)
def test_knowledge_without_effect_is_warned_of(knows: list[str], captures: list[str], message: str | None):
    body = oo.Model.rigid_body(10.0, np.eye(3))
    crafts = [
        oo.System(name, body, [3.0 * i, 0, 0, 0, 0, 0, 1], np.zeros(6), knows=knows if name == "a" else ())
        for i, name in enumerate("abcd")
    ]
    events: list[Any] = [
        oo.Capture(n, f"{n[0]}/base", f"{n[1]}/base", at=1.0 + i) for i, n in enumerate(captures)
    ]
    events += [oo.Release(f"end_{n}", n, on_command=True) for n in captures]
    if message is None:
        oo.World(crafts, events=events)  # a warning would be an error
        return
    with pytest.warns(UserWarning, match=message):
        oo.World(crafts, events=events)


def control(law: str, robot: Any, joints: list[str]) -> Any:
    """Returns a control of the arm by a law that uses the model of ``robot``."""
    servicer = oo.robots.load("servicer")
    q = servicer.neutral()
    q[JOINTS_Q] = GRASPED
    start = servicer.frame_pose(q, "tool")
    end = start.copy()
    end[:3, 3] += [0.1, -0.05, 0.08]
    path = oo.Line(start, end, duration=2.0)
    if law == "task":
        return oo.Control(oo.ComputedTorque(robot, "tool", kp=4.0, kd=4.0), reference=path, joints=joints)
    if law == "compliance":
        compliance = oo.Compliance(robot, "tool", stiffness=20.0, damping=40.0)
        return oo.Control(compliance, reference=path, joints=joints)
    waypoints = oo.JointWaypoints([GRASPED, np.array(GRASPED) + 0.1], times=[0.0, 2.0])
    return oo.Control(oo.JointComputedTorque(kp=4.0, kd=4.0), reference=waypoints, joints=joints)


@pytest.mark.parametrize("law", ["task", "joints", "compliance"])
def test_a_known_load_is_part_of_the_robot(law: str):
    """The torques are those of the same law on one robot that carries the target, whose panel is passive."""
    # compliance on a group of joints neglects the reaction of other joints, so its target has no joint
    target = oo.robots.load("target_satellite") if law == "compliance" else panelled()
    servicer = oo.robots.load("servicer")
    joints = list(servicer.joint_names)
    events = [oo.Capture("grasp", "servicer/tool", "target/handle", at=0.0)]
    simulations = {}
    for knows in ([], ["target"]):
        first, second = systems([control(law, servicer, joints)], target, knows, rates=0.0)
        simulations[bool(knows)] = oo.Simulation(oo.World([first, second], events=events), time_step=2e-3)
    traces = {key: simulation.run(1.0) for key, simulation in simulations.items()}

    q, q_target = traces[True]["servicer"].q[0], traces[True]["target"].q[0]
    pose = np.linalg.inv(servicer.frame_pose(q, "tool")) @ target.frame_pose(q_target, "handle")
    merged = oo.attach(servicer, "tool", target, "handle", pose=pose, prefix="target_")
    own = [merged.joint_names.index(name) for name in joints]
    q_merged, v_merged = merged.neutral(), np.zeros(merged.nv)
    q_merged[JOINTS_Q][own] = GRASPED
    if "target_hinge" in merged.joint_names:
        v_merged[JOINTS_V][merged.joint_names.index("target_hinge")] = 0.02
    alone = oo.Simulation(
        merged, q_merged, v_merged, controller=[control(law, merged, joints)], time_step=2e-3
    ).run(1.0)
    tau = alone.tau[:, own]
    assert np.abs(tau).max() > 0.1
    np.testing.assert_allclose(traces[True]["servicer"].tau[-1], tau[-1], rtol=1e-9, atol=1e-9)
    assert np.abs(traces[False]["servicer"].tau[-1] - tau[-1]).max() > 1e-2
