"""Brakes in scenarios of one robot and of several systems: effect, and errors with line and path."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.exceptions import OnOrbitError

ONE_ROBOT = """\
robot: four_bar_gripper
actuators: [BRAKES]
loops:
  - {name: left, kind: revolute, between: [left_pin, left_rod_tip], project: true}
initial: {joint_rates: {left_crank: RATE}}
simulation: {duration: 0.2 s, time_step: 5 ms}
"""
ONE_SYSTEM = """\
systems:
  a: {robot: four_bar_gripper, actuators: [BRAKES], initial: {joint_rates: {left_crank: RATE}}}
loops:
  - {name: left, kind: revolute, between: [a/left_pin, a/left_rod_tip], project: true}
simulation: {duration: 0.2 s, time_step: 5 ms}
"""
FAR = "  far: {robot: {rigid_body: {mass: 1, inertia: [1, 1, 1]}}, initial: {position: [99, 0, 0]}}\n"
TWO_SYSTEMS = ONE_SYSTEM.replace("loops:", f"{FAR}loops:")
EVENT = "events:\n  - {name: hold, when: {at: 0.1 s}, do: {engage: a/b}}\n"
CASES = {"one robot": ONE_ROBOT, "one system": ONE_SYSTEM, "two systems": TWO_SYSTEMS}


def scenario(folder: Path, text: str, brakes: str = "", rate: str = "0.3") -> Path:
    file = folder / "mine.yaml"
    file.write_text(text.replace("BRAKES", brakes).replace("RATE", rate))
    return file


def rates(file: Path) -> Any:
    """Returns the rates of the joints at the end."""
    trace: Any = oo.run(file, quiet=True).trace
    return (trace["a"] if isinstance(trace, oo.WorldTrace) else trace).v[-1, 6:]


@pytest.mark.parametrize("text", CASES.values(), ids=CASES)
def test_a_slipping_brake_stops_a_looped_gripper(tmp_path: Path, text: str) -> None:
    brake = "{brake: b, joint: left_crank, slip_torque: 0.5 N m, engaged: true}"
    assert np.abs(rates(scenario(tmp_path, text, brake))[:4]).max() < 1e-14
    assert abs(rates(scenario(tmp_path, text))[0]) > 0.1  # negative control: no brake


@pytest.mark.parametrize("joint", ["left_hinge", "right_hinge"])
@pytest.mark.parametrize("text", CASES.values(), ids=CASES)
def test_a_brake_in_a_loop_holds_a_projected_start(tmp_path: Path, text: str, joint: str) -> None:
    # the nearest velocity of the given one has a rate of the hinge, unless a brake holds it
    brake = f"{{brake: b, joint: {joint}, engaged: true}}"
    moving = rates(scenario(tmp_path, text, brake))
    index = oo.robots.load("four_bar_gripper").joint_names.index(joint)
    assert abs(moving[index]) < 1e-15
    assert abs(rates(scenario(tmp_path, text, ""))[0]) > 0.1


@pytest.mark.parametrize(
    ("brakes", "expected"),
    [
        ("{brake: b, joint: left_krank}", "]: the robot has no moving joint 'left_krank'; did you mean"),
        ("{brake: b, joint: tool_mount}", "]: the robot has no moving joint 'tool_mount'; known names: "),
        ("{brake: '', joint: left_crank}", "].brake: the name is empty; give the brake a name"),
        ("{brake: b, joint: left_crank, slip_torque: 3 N}", "]: the slip torque is a force, but the joint"),
        ("{brake: b, joint: left_crank, slip_torque: -1 N m}", "].slip_torque: '-1 N m' is out of range"),
        (
            "{brake: b, joint: left_crank, engaged: true}",
            "]: the brake 'b' holds the joint 'left_crank' from",
        ),
    ],
)
@pytest.mark.parametrize("name", CASES)
def test_invalid_brakes_name_line_and_path(tmp_path: Path, name: str, brakes: str, expected: str) -> None:
    file = scenario(tmp_path, CASES[name], brakes)
    with pytest.raises(OnOrbitError) as caught:
        oo.run(file, quiet=True)
    path = "actuators[0" if name == "one robot" else "systems.a.actuators[0"
    assert str(caught.value).startswith(f"{file}:2: {path}{expected}"), caught.value


def test_two_brakes_of_one_name_or_joint_are_refused(tmp_path: Path) -> None:
    for second, expected in [
        ("{brake: b, joint: right_crank}", "actuators[1].brake: two actuators are named 'b'"),
        ("{brake: c, joint: left_crank}", "actuators[1].joint: the joint 'left_crank' already has the brake"),
    ]:
        file = scenario(tmp_path, ONE_ROBOT, f"{{brake: b, joint: left_crank}}, {second}")
        with pytest.raises(OnOrbitError) as caught:
            oo.run(file, quiet=True)
        assert str(caught.value).startswith(f"{file}:2: {expected}"), caught.value


def test_an_event_stops_a_looped_gripper(tmp_path: Path) -> None:
    brake = "{brake: b, joint: left_crank}"
    assert np.abs(rates(scenario(tmp_path, TWO_SYSTEMS + EVENT, brake))[:4]).max() < 1e-14
    with pytest.raises(OnOrbitError, match="6: events: events require at least two systems"):
        oo.run(scenario(tmp_path, ONE_SYSTEM + EVENT, brake), quiet=True)
