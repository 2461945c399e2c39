"""Conversion of several OnOrbitROS and ROS Control controllers to one scenario."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from test_convert import ROBOT, onorbit, verdicts, write

import onorbit_rs as oo
from onorbit_rs.scenario import load
from onorbit_rs.scenario.build import build
from onorbit_rs.tools.interop.onorbitros import convert

# as in robot_torso: one controller per arm, and the head by ROS Control
SIDES = "".join(
    f"""\
  {side}_arm_controller:
    type: "talos_control/TorsoEffortController"
    end_effector_link: {side}_tool
    joints: [{", ".join(f"{side}_joint_{index}" for index in joints)}]
    trajectory_duration: {duration}
    kp_value: 100.0
    kv_value: 20.0
"""
    for side, joints, duration in (("right", range(1, 8), 3.0), ("left", range(1, 7), 4.0))
)
HEAD = """\
  wrist_controller:
    type: effort_controllers/JointPositionController
    joint: left_joint_7
    pid: {p: 50.0, i: 10.0, d: 1.0}
  joint_state_controller:
    type: joint_state_controller/JointStateController
    publish_rate: 50
"""
DUAL = oo.robots.path("humanoid_dual_arm")


@pytest.mark.filterwarnings(
    "ignore:.*errors grow:UserWarning"
)  # these gains require a shorter control period
def test_controllers_of_disjoint_joints_run_simultaneously(tmp_path: Path) -> None:
    done = convert([*write(tmp_path, control="talos:\n" + SIDES + HEAD), DUAL])
    scenario = load(done.scenario)
    assert [(law.name, law.kind) for law in scenario.laws] == [
        ("right_arm_controller", "computed_torque"),
        ("left_arm_controller", "computed_torque"),
        ("wrist_controller", "joint_pid"),
    ]
    right, left, wrist = done.scenario["controllers"]
    assert (right["tool"], left["tool"], right["kp"], left["kd"]) == ("right_tool", "left_tool", 100.0, 20.0)
    assert left["joints"] == [f"left_joint_{index}" for index in range(1, 7)]
    assert left["reference"]["duration"] == scenario.simulation.duration == 4.0
    assert (wrist["joints"], wrist["p"], wrist["d"], "i" in wrist) == (["left_joint_7"], [50.0], [1.0], False)
    texts = verdicts(done)
    assert texts["joint_state_controller"] == "no meaning" and texts["left_arm_controller"] == "understood"
    assert any("i without i_clamp has no effect" in note.text for note in done.notes)
    build(scenario).simulation.run(0.05)
    # a single controller
    one = convert([*write(tmp_path, control="talos:\n" + SIDES), DUAL], controller="left_arm_controller")
    assert one.scenario["tool"] == "left_tool" and "controllers" not in one.scenario


@pytest.mark.filterwarnings(
    "ignore:.*errors grow:UserWarning"
)  # these gains require a shorter control period
def test_gains_of_ros_control_become_those_of_a_pid(tmp_path: Path) -> None:
    joints = oo.robots.load("humanoid_torso").joint_names
    gains = "".join(
        f"    {name}: {{p: {100 + k}, d: 2, i: 1, i_clamp: 3}}\n" for k, name in enumerate(joints)
    )
    text = "arm:\n  type: effort_controllers/JointTrajectoryController\n"
    done = convert([*write(tmp_path, pid=f"{text}  joints: [{', '.join(joints)}]\n  gains:\n{gains}"), ROBOT])
    (arm,) = done.scenario["controllers"]
    assert (arm["p"], arm["i"], arm["i_limit"]) == ([100.0 + k for k in range(7)], [1.0] * 7, [3.0] * 7)
    build(load(done.scenario)).simulation.run(0.01)


def test_controllers_that_share_joints_are_alternatives(tmp_path: Path) -> None:
    shared = SIDES.replace("left_joint_6", "right_joint_1")
    done = convert([*write(tmp_path, control="talos:\n" + shared), DUAL])
    assert done.scenario["tool"] == "right_tool" and "controllers" not in done.scenario
    (texts,) = (note.text for note in done.notes if note.key == "left_arm_controller")
    assert "drives joints of another controller" in texts and "choose one with controller=" in texts


def test_a_list_of_controllers_is_written_with_its_lines(tmp_path: Path) -> None:
    write(tmp_path, control="talos:\n" + SIDES)
    done = onorbit("convert", "control.yaml", DUAL, "--out", "mine.yaml", cwd=tmp_path)
    assert done.returncode == 0, done
    text = (tmp_path / "mine.yaml").read_text()
    assert '\n  - name: "right_arm_controller"\n    tool: "right_tool"' in text
    assert re.search(r"\n    kp: 100.0 +# control.yaml:7: kp_value: 100.0\n", text), text
    assert re.search(r"\n    reference: .*# the target was sent over a ROS topic", text), text
    assert onorbit("check", "mine.yaml", cwd=tmp_path).returncode == 0


# as in ets_vii/config of OnOrbitROS, and a controller that passes efforts on
DRIVEN = """\
right_arm_controller:
  type: effort_controllers/JointTrajectoryController
  joints: [right_joint_1, right_joint_2]
  state_publish_rate: 50
  gains:
    right_joint_1: {p: 2000, d: 100, i: 10, i_clamp: 1}
    right_joint_2: {p: 2000, d: 100, i: 10, i_clamp: 1}
left_joint_1_controller:
  type: effort_controllers/JointVelocityController
  joint: left_joint_1
  pid: {p: 50.0, i: 10.0, d: 1.0}
hand_controller:
  type: effort_controllers/JointGroupEffortController
  joints: [left_joint_6, left_joint_7]
"""


def test_controllers_that_a_node_drove_follow_commands(tmp_path: Path) -> None:
    files = write(tmp_path, control=DRIVEN)
    done = convert([*files, DUAL], external=True)
    arm, joint, hand = done.scenario["controllers"]
    assert (arm["kind"], arm["kp"], arm["kd"]) == ("external", 100.0, 20.0)
    assert arm["joints"] == ["right_joint_1", "right_joint_2"]
    assert (joint["kind"], joint["kd"], "kp" in joint) == ("external", 20.0, False)
    assert hand == {
        "name": "hand_controller", "kind": "external", "joints": ["left_joint_6", "left_joint_7"],
    }  # fmt: skip
    notes = "\n".join(note.text for note in done.notes)
    for topic in ("/right_arm_controller/joint_trajectory", "/left_joint_1_controller/commands"):
        assert f"send them to {topic} of onorbit ros2" in notes
    stepper = build(load(done.scenario)).simulation.start()
    assert stepper.external == {
        "right_arm_controller": arm["joints"], "left_joint_1_controller": ["left_joint_1"],
        "hand_controller": hand["joints"],
    }  # fmt: skip
    stepper.send("right_arm_controller", position=[0.1, 0.0])
    stepper.send("hand_controller", effort=[0.01, 0.0])
    stepper.advance(0.1)
    assert stepper.v[6:].any()


def test_without_the_option_only_efforts_follow_commands(tmp_path: Path) -> None:
    done = convert([*write(tmp_path, control=DRIVEN), DUAL])
    assert [entry["kind"] for entry in done.scenario["controllers"]] == ["joint_pid", "joint_pid", "external"]


def test_the_command_writes_external_controllers(tmp_path: Path) -> None:
    done = onorbit("convert", *write(tmp_path, control=DRIVEN), DUAL, "--external")
    assert re.search(
        r'kind: "external" +# .*: type: effort_controllers/JointGroupEffortController', done.stdout
    )
    assert "PID gains do not apply to computed torque, whose gains are kp 100 1/s², kd 20 1/s" in done.stderr
