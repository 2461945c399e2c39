"""Closed loops and mimic joints in scenarios: keys, starts, and errors with file, line and path."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs import robots
from onorbit_rs.cli import main
from onorbit_rs.exceptions import OnOrbitError
from onorbit_rs.scenario import load
from onorbit_rs.scenario.build import build

FOUR_BAR = """\
robot: four_bar_gripper
loops:
  - {name: left, kind: revolute, between: [left_pin, left_rod_tip], project: false}
initial:
  joints: {left_crank: 0}
simulation: {duration: 0.1 s, time_step: 5 ms}
"""
WORLD = """\
systems:
  a: {robot: four_bar_gripper}
  b: {robot: four_bar_gripper, initial: {position: [3, 0, 0]}}
loops:
  - {name: left, kind: revolute, between: [a/left_pin, a/left_rod_tip]}
simulation: {duration: 0.1 s, time_step: 5 ms}
"""


OTHER = "{name: left, kind: weld, between: [b/bus, b/tool]}"


def write(folder: Path, text: str, *changes: tuple[str, str]) -> Path:
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    file = folder / "mine.yaml"
    file.write_text(text)
    return file


def refused(file: Path) -> str:
    """Return the message with which a scenario is refused."""
    with pytest.raises(OnOrbitError) as caught:
        oo.run(file, quiet=True)
    return str(caught.value).removeprefix(f"{file}:")


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        (
            [("left_pin,", "left_pn,")],
            "3: loops[0].between: there is no frame 'left_pn'; did you mean 'left_pin'",
        ),
        ([("left_rod_tip", "left_pin")], "3: loops[0].between: both frames are 'left_pin'; give"),
        (
            [("left_rod_tip", "left_finger")],
            "3: loops[0].between: loop 'left' connects the frames 'left_pin' and",
        ),
        ([("revolute", "ball")], "3: loops[0].kind: "),
        ([("between", "frames")], "3: loops[0].frames: unknown key; did you mean 'between'?"),
        ([("project: false", "length: 1 m")], "3: loops[0]: loop 'left' has a length"),
        ([("crank: 0", "crank: 0.1")], "3: loops[0]: the initial configuration opens the loop 'left' by 0.0"),
        (
            [("project: false", "pose_a: {position: [1 m, 0, 0]}, project: true")],
            "2: loops: no configuration near the given one satisfies all constraints of loops and mimic "
            "joints: the loop 'left' stays open by 0.",
        ),
        (
            [("crank: 0", "crank: 0, right_crank: 0.2")],
            "5: initial.joints: the position of right_crank is 0.2 rad, but the joint mimics left_crank",
        ),
        (
            [("initial:", "initial:\n  joint_rates: {left_crank: 0.1}")],
            "3: loops[0]: the initial velocity opens the loop 'left' by ",
        ),
    ],
)
def test_errors_name_line_and_path(tmp_path: Path, changes: Any, expected: str) -> None:
    message = refused(write(tmp_path, FOUR_BAR, *changes))
    assert message.startswith(expected), message


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ([("[a/left_pin", "[c/left_pin")], "5: loops[0].between[0]: no system"),
        ([("[a/left_pin", "[left_pin")], "5: loops[0].between[0]: 'left_pin' is not a frame"),
        (
            [("[a/left_pin", "[b/left_pin")],
            "5: loops[0].between: the frames belong to two systems, 'b' and 'a'",
        ),
        ([("[a/left_pin", "[a/left_pn")], "5: loops[0].between: there is no frame 'left_pn'"),
        ([("gripper}", "gripper, loops: []}")], "2: systems.a.loops: unknown key; it belongs"),
        ([("loops:\n", f"loops:\n  - {OTHER}\n")], "6: loops[1].name: two loops are named 'left'"),
    ],
)
def test_errors_in_a_world_name_line_and_path(tmp_path: Path, changes: Any, expected: str) -> None:
    message = refused(write(tmp_path, WORLD, *changes))
    assert message.startswith(expected), message


def test_a_capture_at_the_start_takes_the_place_of_a_loop_of_two_systems(tmp_path: Path) -> None:
    message = refused(write(tmp_path, WORLD, ("[a/left_pin", "[b/left_pin")))
    assert "{name: left, when: {at: 0 s}, do: {capture: [b/left_pin, a/left_rod_tip]}}" in message


def test_project_closes_the_start(tmp_path: Path) -> None:
    changes = ("crank: 0", "crank: 0.3"), ("project: false", "project: true")
    built = build(load(write(tmp_path, FOUR_BAR, *changes)))
    assert np.abs(built.model.loop_errors(built.q)).max() < 1e-15
    joints = dict(zip(built.model.joint_names, built.q[7:], strict=True))
    assert 0.2 < joints["left_crank"] < 0.4
    assert joints["left_hinge"] == pytest.approx(-joints["left_crank"], abs=1e-12)
    assert joints["right_crank"] == pytest.approx(joints["left_crank"], abs=1e-15)
    trace: Any = built.simulation.run(0.1)
    assert np.abs(trace.q[0] - built.q).max() < 1e-12


def test_a_loop_of_a_world_is_that_of_its_system(tmp_path: Path) -> None:
    moving = "gripper, initial: {joint_rates: {right_rod: 1}}}"
    trace: Any = oo.run(write(tmp_path, WORLD, ("gripper}", moving)), quiet=True).trace
    looped = robots.load("four_bar_gripper").with_loops(
        [oo.Loop("left", "revolute", "left_pin", "left_rod_tip")]
    )
    assert np.abs(looped.loop_errors(trace["a"].q)).max() < 1e-15


def test_a_mimic_joint_that_is_not_given_follows_its_leader(tmp_path: Path) -> None:
    state = "initial: {joints: {left_jaw: 3 cm}, joint_rates: {left_jaw: 1 cm/s}}\n"
    settings = "simulation: {duration: 1 s, time_step: 10 ms}\n"
    file = write(tmp_path, f"robot: parallel_gripper\n{state}{settings}")
    built = build(load(file))
    assert [*built.q[7:], *built.v[6:]] == pytest.approx([0.03, 0.03, 0.01, 0.01], abs=1e-15)


@pytest.mark.parametrize(
    ("name", "opened"), [("parallel_gripper", 0.08), ("four_bar_gripper", np.deg2rad(55.0))]
)
def test_the_fingers_of_the_bundled_grippers_move_together(name: str, opened: float) -> None:
    run: Any = oo.run(name, quiet=True)
    joints = run.trace.q[:, 7:]
    assert joints[400, 0] == pytest.approx(opened, rel=1e-2)
    assert np.abs(np.abs(joints) - np.abs(joints[:, :1])).max() < 1e-12  # parallelograms: equal angles
    if name == "four_bar_gripper":
        model = build(load(name)).model
        attitudes = [model.frame_pose(run.trace.q, frame)[:, :3, :3] for frame in ("bus", "left_finger")]
        assert np.abs(attitudes[0] - attitudes[1]).max() < 1e-12  # the finger does not turn


@pytest.mark.parametrize(
    ("leader", "problem"),
    [("left_jew", "did you mean 'left_jaw'"), ("right_jaw", "mimics itself"), ("tool_mount", "fixed")],
)
def test_a_mimic_of_no_moving_joint_is_refused(tmp_path: Path, leader: str, problem: str) -> None:
    text = robots.path("parallel_gripper").read_text()
    (tmp_path / "arm.urdf").write_text(
        text.replace('<mimic joint="left_jaw"/>', f'<mimic joint="{leader}"/>')
    )
    file = write(tmp_path, "robot: arm.urdf\nsimulation: {duration: 1 s, time_step: 10 ms}\n")
    message = refused(file)
    assert message.startswith("1: robot: ")
    assert "arm.urdf" in message
    assert problem in message


def test_info_lists_loops_and_mimic_joints(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["info", str(write(tmp_path, FOUR_BAR))])
    shown = capsys.readouterr().out
    assert "mimic joint: right_crank = 1 left_crank" in shown
    assert "loop left: revolute between left_pin and left_rod_tip" in shown


@pytest.mark.parametrize("text", [FOUR_BAR, WORLD])
def test_mujoco_refuses_prismatic_loops(tmp_path: Path, text: str) -> None:
    pytest.importorskip("mujoco")
    lines = len(text.splitlines())
    message = refused(write(tmp_path, f"{text.replace('revolute', 'prismatic')}engine: mujoco\n"))
    assert message.startswith(f"{lines + 1}: engine: loop 'left' is prismatic, but MuJoCo has no equality")


def test_a_world_with_loops_runs_on_mujoco(tmp_path: Path) -> None:
    pytest.importorskip("mujoco")
    trace = oo.run(write(tmp_path, f"{WORLD}engine: mujoco\n")).trace
    (opening,) = (loop.opening for name in trace.names for loop in trace[name].loops.values())
    assert 0.0 < np.abs(opening).max() < 1e-6
