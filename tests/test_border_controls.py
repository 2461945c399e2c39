"""Several controllers on one robot through Python: joint groups, goals, times, invalid input."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.exceptions import ControlError, DtypeError, FrameError, RunInterrupted, ShapeError


@pytest.fixture(scope="module")
def dual() -> oo.Model:
    return oo.robots.load("humanoid_dual_arm")


@pytest.fixture
def q(dual: oo.Model) -> Any:
    posture = [0.5342, -2.341, -2.0077, -2.2249, -2.2693, -0.1342, -0.1974]
    start = dual.neutral()
    start[7:] = [*posture, *posture]
    return start


def group(model: oo.Model, side: str) -> list[str]:
    return [name for name in model.joint_names if name.startswith(side)]


def reach(model: oo.Model, q: Any, side: str, **options: Any) -> oo.Control:
    tool = f"{side}_tool"
    line = oo.LineParabola(model.frame_pose(q, tool), displacement=[0.2, 0, 0], duration=1.0)
    law = oo.ComputedTorque(model, tool, kp=100, kd=20, null_space_damping=2)
    return oo.Control(law, joints=group(model, side), reference=line, name=side, **options)


def at_rest(model: oo.Model, q: Any, controller: Any, **options: Any) -> oo.Simulation:
    return oo.Simulation(model, q, np.zeros(model.nv), controller=controller, **options)


def test_both_arms_reach_at_once(dual: oo.Model, q: Any) -> None:
    goal = oo.Goal(tolerance=[1e-4, 1e-4], time=0.5)
    trace = at_rest(dual, q, [reach(dual, q, s, goal=goal) for s in ("right", "left")]).run(1.5)
    assert set(trace.tracking) == {"right", "left"}
    for error in trace.tracking.values():
        assert error.shape == (len(trace), 6) and np.abs(error).max() < 1e-4
    assert [result["outcome"] for result in trace.results] == ["succeeded", "succeeded"]
    assert trace.tool_pose is not None  # of the first tool
    assert all(passed for *_, passed in trace.certificate())


def test_a_goal_out_of_reach_names_the_joint_and_the_arm_holds_its_posture(dual: oo.Model, q: Any) -> None:
    path = oo.JointWaypoints(np.array([q[7:14], q[7:14] + 0.5]), times=[0.0, 0.2])
    soft = oo.JointPid(p=0.05, d=0.02)
    goal = oo.Goal(tolerance=1e-3, path_tolerance=0.05)
    control = oo.Control(soft, joints=group(dual, "right"), reference=path, goal=goal, name="arm")
    (result,) = at_rest(dual, q, [control]).run(1.0).results
    assert result["outcome"] == "path_tolerance_violated"
    assert result["component"].startswith("right_joint") and abs(result["error"]) > 0.05
    assert 0.0 < result["time"] < 0.2


def test_controls_follow_each_other(dual: oo.Model, q: Any) -> None:
    goal = oo.Goal(tolerance=[1e-3, 1e-2])
    first = reach(dual, q, "right", goal=goal)
    there = oo.JointHold(q[7:14])
    second = oo.Control(
        oo.JointComputedTorque(kp=25, kd=10), joints=group(dual, "right"), reference=there, name="hold",
        after="right", starts_at_present=True,
    )  # fmt: skip
    trace = at_rest(dual, q, [first, second]).run(2.0)
    time = trace.results[0]["time"]
    before, later = trace.time < time, trace.time > time + 1e-9
    assert not trace.tracking["hold"][before].any() and not trace.tracking["right"][later].any()
    assert np.abs(trace.q[-1, 7:14] - trace.q[before][-1, 7:14]).max() < 0.02


@pytest.mark.parametrize("interface", ["position", "velocity", "effort"])
def test_the_interfaces_of_ros_control(dual: oo.Model, q: Any, interface: Any) -> None:
    gains = {"position": {"p": 2.0, "d": 0.3}, "velocity": {"p": 30.0}, "effort": {}}[interface]
    efforts = np.array([0.01, -0.02])
    reference: Any = {
        "position": oo.JointHold(q[7:9] + 0.1),
        "velocity": oo.JointWaypoints([q[7:9], q[7:9] + 1.0], times=[0.0, 1.0]),
        "effort": oo.JointHold(efforts),
    }[interface]
    law = oo.JointPid(interface=interface, **gains)
    control = oo.Control(law, joints=group(dual, "right")[:2], reference=reference)
    trace = at_rest(dual, q, [control], reference_start_tolerance=(1.0, 4.0)).run(0.5)
    if interface == "effort":
        np.testing.assert_array_equal(trace.tau[:, :2], np.tile(efforts, (len(trace), 1)))
    elif interface == "position":
        error = trace.tracking["control_0"]
        assert np.abs(error[-1]).max() < np.abs(error[0]).max()
    else:
        desired = reference.sample(trace.time)[1]
        assert np.abs(trace.v[-1, 6:8] - desired[-1]).max() < 0.2 * np.abs(desired[-1]).max()
    assert not trace.tau[:, 2:].any()  # joints without a control have zero torque


@pytest.mark.filterwarnings("ignore:the inertia of link 'link_5'")
def test_effort_limits_default_to_those_of_the_robot() -> None:
    ets = oo.robots.load("ets_vii")
    far = oo.JointHold(ets.neutral()[7:] + 0.1)
    for limit, expected in ((None, 1000.0), (np.inf, 1e5), (3.0, 3.0)):
        law = oo.JointPid(p=1e6, effort_limit=limit)
        trace = at_rest(ets, ets.neutral(), law, reference=far, reference_start_tolerance=(1, 1)).run(1e-3)
        np.testing.assert_allclose(np.abs(trace.tau[0]), expected)


def test_a_spring_returns_the_tool(dual: oo.Model, q: Any) -> None:
    pose = dual.frame_pose(q, "right_tool")
    pose[0, 3] += 0.02
    law = oo.Compliance(dual, "right_tool", stiffness=[20] * 3 + [0.5] * 3, damping=[1] * 3 + [0.02] * 3)
    control = oo.Control(law, joints=group(dual, "right"), reference=oo.Hold(pose), name="spring")
    error = at_rest(dual, q, [control]).run(20.0).tracking["spring"]
    assert np.linalg.norm(error[-1, :3]) < 0.5 * np.linalg.norm(error[0, :3])


class Count(oo.Controller):
    """Counts its updates and applies torques proportional to the count."""

    def __init__(self) -> None:
        self.calls = 0

    def reset(self) -> None:
        self.calls = 0

    def update(self, t: float, state: oo.State) -> Any:
        self.calls += 1
        return 1e-7 * self.calls * np.ones(len(state.joints))


def test_a_python_controller_drives_its_joint_group(dual: oo.Model, q: Any) -> None:
    seen: list[list[str]] = []

    class ConstantTorque(oo.Controller):
        def update(self, t: float, state: oo.State) -> Any:
            seen.append(state.joints)
            return [0.01, -0.01]

    joints = ["left_joint_2", "right_joint_1"]  # in the order of the group
    trace = at_rest(
        dual, q, [reach(dual, q, "left", end=0.01), oo.Control(ConstantTorque(), joints=joints, start=0.01)]
    )
    tau = trace.run(0.02).tau
    assert seen[0] == joints
    assert (tau[-1, 0], tau[-1, 8]) == (-0.01, 0.01)


@pytest.mark.parametrize(
    ("answer", "error"),
    [([1.0], ShapeError), ([np.nan, 0.0], ControlError), (None, DtypeError), ("no", DtypeError)],
)
def test_invalid_torques_of_a_python_controller(dual: oo.Model, q: Any, answer: Any, error: Any) -> None:
    class Wrong(oo.Controller):
        def update(self, t: float, state: oo.State) -> Any:
            return answer

    control = oo.Control(Wrong(), joints=group(dual, "right")[:2], name="wrong")
    with pytest.raises(error):
        at_rest(dual, q, [control]).run(0.01)


def test_an_exception_of_a_controller_is_re_raised_unchanged(dual: oo.Model, q: Any) -> None:
    mine = RuntimeError("mine")

    class Raises(oo.Controller):
        def update(self, t: float, state: oo.State) -> Any:
            raise mine

    with pytest.raises(RuntimeError) as caught:
        at_rest(dual, q, [oo.Control(Raises())]).run(0.01)
    assert caught.value is mine and caught.value.__traceback__ is not None


def test_a_controller_with_state_is_saved_in_a_checkpoint(dual: oo.Model, q: Any) -> None:
    def run(**options: Any) -> oo.Trace:
        controls = [reach(dual, q, "right"), oo.Control(Count(), joints=group(dual, "left"))]
        return at_rest(dual, q, controls).run(60.0, **options)

    whole = run()
    kept: list[oo.Checkpoint] = []

    def stop(t: float, duration: float) -> None:
        if kept:
            raise KeyboardInterrupt

    with pytest.raises(RunInterrupted):
        run(progress=stop, checkpoint=kept.append, checkpoint_every=0.0)
    columns = {k: np.concatenate([part.columns[k] for part in kept]) for k in kept[0].columns}
    assert "tracking_right" in columns
    rest = run(resume=oo.Checkpoint(kept[-1].state, columns))
    assert rest.tau.tobytes() == whole.tau.tobytes() and rest.q.tobytes() == whole.q.tobytes()
    assert rest.tracking["right"].tobytes() == whole.tracking["right"].tobytes()


def test_a_controller_that_cannot_be_saved_continues_to_run(dual: oo.Model, q: Any) -> None:
    class Holds(Count):
        def reset(self) -> None:
            super().reset()
            self.handle = lambda: None  # cannot be pickled

    with pytest.warns(UserWarning, match="cannot be saved"):
        trace = at_rest(dual, q, Holds()).run(60.0, checkpoint=lambda c: None, checkpoint_every=0.0)
    assert trace.is_complete


def test_invalid_controls(dual: oo.Model, q: Any) -> None:
    right = reach(dual, q, "right")
    hold, everything = oo.JointHold(q[7:]), oo.JointComputedTorque()
    for controls, error, words in (
        ([right, oo.Control(everything, reference=hold, name="all")], ControlError, "both drive joint"),
        ([oo.Control(everything, joints=["right_joint_11"], reference=hold)], FrameError, "did you mean"),
        ([oo.Control(everything, joints=[], reference=hold)], ControlError, "drives no joint"),
        ([oo.Control(everything)], ControlError, "without the reference"),
        ([oo.Control(everything, reference=oo.Hold(np.eye(4)))], DtypeError, "JointReference"),
        ([oo.Control(everything, reference=oo.JointHold([0.0]))], ControlError, "has 1 joint, but its group"),
        ([oo.Control(everything, reference=oo.JointHold(q[7:] + 1))], ControlError, "starts 1 rad"),
        ([right, right], ControlError, "two controls are named"),
        ([reach(dual, q, "right", after="x")], ControlError, "starts after 'x'"),
        ([3], ControlError, "each entry must be a Control"),
    ):  # fmt: skip
        with pytest.raises(error, match=words):
            at_rest(dual, q, controls)
    with pytest.raises(ControlError, match="have no common reference"):
        at_rest(dual, q, [right], reference=hold)
    with pytest.raises(ControlError, match="'position', 'velocity' and 'effort'"):
        oo.JointPid(interface="positon")  # type: ignore[arg-type]
    for interface in ("position", "velocity"):  # effort limits are not gains
        with pytest.raises(
            ControlError, match=f"interface '{interface}' and no gains has no effect; give 'p'"
        ):
            oo.JointPid(interface=interface, effort_limit=3.0)  # type: ignore[arg-type]
    oo.JointPid(interface="effort")
    oo.JointPid(p=0.0)  # requested
    with pytest.raises(ControlError, match="negative"):
        oo.JointComputedTorque(kp=-1)
    with pytest.raises(ShapeError, match="one entry per joint"):
        oo.JointPid(p=[1, 2], d=[1, 2, 3])
