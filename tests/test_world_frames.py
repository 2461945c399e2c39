"""References in frames of other systems."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.common.coordinates import JOINTS_Q, JOINTS_V
from onorbit_rs.exceptions import ControlError, FrameError, ScenarioError, SimulationError
from onorbit_rs.scenario import load

GRASPED = [0, 1.4260, 0, 1.3391, 0, -1.1943, 0]
OFFSET = np.array([-0.1, 0.0, 0.02])


def pair(frame: Any, offset: Any, spin: float = 0.05) -> Any:
    """Returns a world of a servicer whose tool keeps its initial pose in a frame of a tumbling satellite."""
    servicer, target = oo.robots.load("servicer"), oo.robots.load("target_satellite")
    q = servicer.neutral()
    q[JOINTS_Q] = GRASPED
    q_target = target.neutral()
    tool, handle = servicer.frame_pose(q, "tool"), target.frame_pose(q_target, "handle")
    q_target[:3] = tool[:3, 3] - handle[:3, 3] - offset
    law = oo.ComputedTorque(servicer, "tool", kp=25.0, kd=10.0)
    pose = np.linalg.inv(target.frame_pose(q_target, "handle")) @ tool
    control = oo.Control(law, reference=oo.Hold(pose, frame=frame), name="follow")
    first = oo.System("servicer", servicer, q, np.zeros(servicer.nv), controller=[control])
    return oo.World([first, oo.System("target", target, q_target, [0.01, 0, 0.005, 0.02, 0.03, spin])])


def test_the_tool_follows_a_tumbling_handle():
    trace = oo.Simulation(pair("target/handle", OFFSET), time_step=2e-3).run(5.0)
    servicer, target = oo.robots.load("servicer"), oo.robots.load("target_satellite")
    start = None
    for row in (0, -1):
        tool = servicer.frame_pose(trace["servicer"].q[row], "tool")
        handle = target.frame_pose(trace["target"].q[row], "handle")
        relative = np.linalg.inv(handle) @ tool
        start = relative if start is None else start
    # the initial velocity error decays; the target turned by 0.3 rad meanwhile
    assert np.abs(relative - start).max() < 1e-6
    moved = target.frame_pose(trace["target"].q[-1], "handle") - handle_at_start(trace, target)
    assert np.abs(moved).max() > 0.1
    error = trace["servicer"].tracking["follow"]
    assert np.abs(error[-1]).max() < 1e-6
    desired = trace["servicer"].reference_pose[-1]
    np.testing.assert_allclose(desired, handle @ start, atol=1e-12)


def handle_at_start(trace: Any, target: Any) -> Any:
    return target.frame_pose(trace["target"].q[0], "handle")


def test_systems_that_follow_each_other_share_their_steps():
    """The follower and the target are one group: the certificate has their sum."""
    trace = oo.Simulation(pair("target/handle", OFFSET), time_step=2e-3).run(0.2)
    names = [name for name, *_ in trace.certificate()]
    assert any(name.startswith("servicer+target/") for name in names)


def test_pieces_have_the_bits_of_one_run():
    whole = oo.Simulation(pair("target/handle", OFFSET), time_step=2e-3).run(1.0)
    stepper = oo.Simulation(pair("target/handle", OFFSET), time_step=2e-3).start(duration=1.0)
    for t in (0.1, 0.4321, 1.0):
        stepper.advance_to(t)
    np.testing.assert_array_equal(stepper.trace()["servicer"].q, whole["servicer"].q)


def test_the_world_frame_is_the_control_of_this_test():
    """A tool that holds its pose in W does not follow."""
    servicer = oo.robots.load("servicer")
    world = pair("target/handle", OFFSET)
    assert world.names == ["servicer", "target"]
    q = servicer.neutral()
    q[JOINTS_Q] = GRASPED
    law = oo.ComputedTorque(servicer, "tool", kp=25.0, kd=10.0)
    hold = oo.Control(law, reference=oo.Hold(servicer.frame_pose(q, "tool")))
    alone = oo.Simulation(servicer, q, np.zeros(servicer.nv), controller=[hold], time_step=2e-3).run(5.0)
    followed = oo.Simulation(world, time_step=2e-3).run(5.0)["servicer"]
    assert np.abs(alone.tool_pose[-1] - followed.tool_pose[-1]).max() > 0.1


@pytest.mark.parametrize(
    ("frame", "error", "message"),
    [
        ("targt/handle", ControlError, "no system of the world is named 'targt'.*servicer, target"),
        ("target/handel", FrameError, "handle"),
        ("servicer/tool", oo.exceptions.WorldError, "frame of the same system"),
        ("handle", ControlError, "SYSTEM/FRAME"),
    ],
)
def test_frames_that_do_not_exist_are_refused(frame: str, error: type[Exception], message: str):
    with pytest.raises(error, match=message):
        pair(frame, OFFSET)


def test_a_robot_alone_has_no_other_systems():
    servicer = oo.robots.load("servicer")
    law = oo.ComputedTorque(servicer, "tool", kp=25.0, kd=10.0)
    hold = oo.Hold(np.eye(4), frame="target/handle")
    with pytest.raises(ControlError, match="one robot"):
        oo.Simulation(servicer, servicer.neutral(), np.zeros(servicer.nv), controller=law, reference=hold)
    with pytest.raises(ControlError, match="another system"):
        hold.in_world(0.0)


TEXT = """\
systems:
  chaser:
    robot: servicer
    tool: tool
    initial: {joints: [0, 1.4260, 0, 1.3391, 0, -1.1943, 0]}
    controller: {kind: computed_torque, kp: 25, kd: 10}
    reference: {kind: line, frame: target/handle, goal: {position: [-20 cm, 0, 0]}, duration: 3 s}
  target:
    robot: target_satellite
    initial:
      frame: chaser/tool
      position: [50 cm, 0, 75 cm]
      attitude: {roll_pitch_yaw: [0, -90 deg, 0]}
      angular_velocity: [0, 0, 1 deg/s]
simulation: {duration: 4 s, time_step: 5 ms}
"""


def test_a_scenario_approaches_the_handle(tmp_path: Path):
    file = tmp_path / "approach.yaml"
    file.write_text(TEXT)
    trace = oo.run(load(file)).trace
    chaser, target = oo.robots.load("servicer"), oo.robots.load("target_satellite")
    tool = chaser.frame_pose(trace["chaser"].q[-1], "tool")
    pose = np.linalg.inv(target.frame_pose(trace["target"].q[-1], "handle")) @ tool
    np.testing.assert_allclose(pose[:3, 3], [-0.2, 0, 0], atol=1e-4)
    file.write_text(TEXT.replace("target/handle", "targt/handle"))
    with pytest.raises(ScenarioError, match=r"reference.frame: no other system.*did you mean 'target'"):
        load(file)
    file.write_text(TEXT.replace("target/handle", "target/handel"))
    with pytest.raises(FrameError, match=r"approach.yaml.*handle"):
        oo.run(load(file))


def test_a_control_may_start_after_one_that_follows_a_frame(tmp_path: Path):
    file = tmp_path / "approach.yaml"
    single = TEXT[TEXT.index("    controller:") : TEXT.index("  target:")]
    several = """\
    controllers:
      - name: approach
        kind: computed_torque
        kp: 25
        kd: 10
        reference: {kind: line, frame: target/handle, goal: {position: [-20 cm, 0, 0]}, duration: 1 s}
        end: 1 s
      - {name: rest, kind: joint_computed_torque, kp: 25, kd: 10, after: approach, starts_at_present: true}
"""
    file.write_text(TEXT.replace(single, several))
    trace = oo.run(load(file)).trace["chaser"]
    assert np.abs(trace.v[-1][JOINTS_V]).max() < 1e-3


def grasped(
    *, end: float | None = None, replaced: bool = False, seat: float | None = None, **settings: Any
) -> Any:
    """Returns a simulation in which a tool grasps a handle at 1 s while its control still moves the tool."""
    servicer, target = oo.robots.load("servicer"), oo.robots.load("target_satellite")
    q, q_target = servicer.neutral(), target.neutral()
    q[JOINTS_Q] = GRASPED
    tool, handle = servicer.frame_pose(q, "tool"), target.frame_pose(q_target, "handle")
    q_target[:3] = tool[:3, 3] - handle[:3, 3] - OFFSET
    start = np.linalg.inv(target.frame_pose(q_target, "handle")) @ tool
    goal = start.copy()
    goal[0, 3] += 0.3
    law = oo.ComputedTorque(servicer, "tool", kp=25.0, kd=10.0)
    path = oo.Line(start, goal, duration=5.0, frame="target/handle")
    controls = [oo.Control(law, reference=path, name="follow", end=end)]
    if replaced:
        hold = oo.JointHold(q[JOINTS_Q])
        rest = oo.JointComputedTorque(kp=25.0, kd=10.0)
        controls.append(oo.Control(rest, reference=hold, starts_at_present=True, after="grasp"))
    systems = [
        oo.System("servicer", servicer, q, np.zeros(servicer.nv), controller=controls),
        oo.System("target", target, q_target, [0, 0, 0, 0.02, 0.03, 0]),
    ]
    grasp = oo.Capture("grasp", "servicer/tool", "target/handle", at=1.0, seat=seat)
    return oo.Simulation(oo.World(systems, events=[grasp]), time_step=0.01, **settings)


def test_a_control_that_follows_what_its_tool_has_grasped_is_warned_of():
    stepper = grasped().start(duration=4.0)
    stepper.advance_to(1.0)  # an exception, if there were a warning before the grasp
    text = "'follow' moves 'servicer/tool' and follows 'target/handle'.*'grasp'.*after='grasp'"
    with pytest.warns(UserWarning, match=text):
        stepper.advance_to(1.5)
    stepper.advance_to(1.6)  # once
    with pytest.warns(UserWarning, match="'follow' moves"):
        grasped(replaced=False).start(resume=stepper.checkpoint()).advance_to(1.7)


def test_during_a_seating_the_frames_are_not_rigid_yet():
    stepper = grasped(seat=0.5).start(duration=4.0)
    stepper.advance_to(1.4)
    with pytest.warns(UserWarning, match="'follow' moves"):
        stepper.advance_to(1.6)


@pytest.mark.parametrize("settings", [{"end": 1.0}, {"replaced": True}])
def test_a_control_that_ends_at_the_grasp_is_not_warned_of(settings: dict[str, Any]):
    trace = grasped(**settings).run(2.0)  # a warning would be an exception
    assert np.abs(trace["servicer"].v[-1][JOINTS_V]).max() < 0.2


@pytest.mark.timeout(60)
def test_joints_that_a_control_accelerates_without_bound_end_an_adaptive_run():
    """The tolerance would make the steps ever shorter: the run would take hours."""
    simulation = grasped(integrator="dormand_prince")
    with (
        pytest.warns(UserWarning, match="'follow' moves"),
        pytest.raises(
            SimulationError, match=r"requires steps of .* far shorter than the control period of 0\.01 s"
        ) as error,
    ):
        simulation.run(100.0)
    assert error.value.time > 1.0 and error.value.step < 1e-7
    assert error.value.trace["servicer"].time[-1] > 1.0
