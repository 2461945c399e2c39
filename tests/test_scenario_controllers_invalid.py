"""Controllers in YAML that do not fit each other, the robot or their references are reported with place."""

from __future__ import annotations

from typing import Any

import pytest
from test_scenario_controllers import JOINT, arm, one, two

from onorbit_rs.exceptions import ControlError, FrameError, OnOrbitError, ScenarioError, ShapeError
from onorbit_rs.scenario import load
from onorbit_rs.scenario.build import build

TASK = {"kind": "computed_torque"}
LINE = {"kind": "line", "goal": {"displacement": [0.1, 0, 0]}, "duration": 1}
HOLD = {"kind": "joint_hold"}
REFUSED: dict[str, tuple[dict[str, Any], type[OnOrbitError], tuple[str, ...]]] = {
    "both": (two(arm("right"), controller=JOINT), ScenarioError, ("controllers", "both given")),
    "empty list": (two(), ScenarioError, ("controllers",)),
    "reference of none": (
        two(arm("right"), reference=LINE, tool="right_tool"),
        ScenarioError,
        ("reference", "move this 'reference'"),
    ),
    "task for joints": (
        one(controller=JOINT, reference=LINE),
        ScenarioError,
        ("reference", "joint_waypoints"),
    ),
    "joints for task": (
        one(tool="tool", controller=TASK, reference=HOLD),
        ScenarioError,
        ("reference", "joint_computed_torque"),
    ),
    "no tool": (one(controller=TASK), ScenarioError, ("tool", "'tool' is missing")),
    "no tool in list": (two(TASK | {"name": "a"}), ScenarioError, ("controllers[0].tool",)),
    "no orbit": (
        two(
            TASK
            | {"name": "a", "tool": "right_tool", "joints": "right_*", "reference": LINE | {"frame": "lvlh"}}
        ),
        ScenarioError,
        ("controllers[0].reference.frame", "requires an orbit"),
    ),
    "one name twice": (
        two(arm("right"), arm("left", name="right")),
        ScenarioError,
        ("controllers[1].name", "two"),
    ),
    "no such predecessor": (
        two(arm("right"), arm("left", after="rihgt")),
        ScenarioError,
        ("controllers[1].after", "did you mean 'right'"),
    ),
    "time and predecessor": (
        two(arm("right", end=0.1), arm("left", after="right", start=0.2)),
        ScenarioError,
        ("controllers[1].start", "are both given"),
    ),
    "misspelt joint": (
        two(arm("right", joints=["right_jiont_1"], reference=HOLD)),
        FrameError,
        ("controllers[0]", "did you mean 'right_joint_1'"),
    ),
    "pattern of none": (
        two(arm("right", joints="rihgt_*", reference=HOLD)),
        FrameError,
        ("no joint matches 'rihgt_*'",),
    ),
    "overlap": (
        two(arm("right"), arm("left", joints=["left_*", "right_joint_3"])),
        ControlError,
        ("controllers", "right_joint_3"),
    ),
    "efforts of nothing": (
        one(controller={"kind": "joint_pid", "interface": "effort"}),
        ScenarioError,
        ("reference", "efforts"),
    ),
    "gains of another number": (
        one(controller=JOINT | {"kp": [1, 2]}),
        ShapeError,
        ("'kp' has 2 numbers",),
    ),
    "unit of another kind": (
        one(controller=JOINT | {"kp": "3 N"}),
        ScenarioError,
        ("controller.kp", "1/s^2"),
    ),
    "tolerance of a tool": (
        two(TASK | {"name": "a", "tool": "right_tool", "goal": {"tolerance": 0.1}}),
        ScenarioError,
        ("controllers[0].goal.tolerance", "a distance and an angle"),
    ),
    "bad name": (two(arm("right", name="a b")), ScenarioError, ("controllers[0].name",)),
    "misspelt kind": (one(controller={"kind": "joint_pidd"}), ScenarioError, ("did you mean 'joint_pid'",)),
    "misspelt key": (two(arm("right", tol=1)), ScenarioError, ("controllers[0]", "unknown key")),
    "python from two places": (
        one(controller={"kind": "python", "file": "a.py", "module": "a", "class": "A"}),
        ScenarioError,
        ("exactly one of 'file'",),
    ),
    "python without class": (
        one(controller={"kind": "python", "file": "a.py"}),
        ScenarioError,
        ("controller.class",),
    ),
    "python and joints": (
        one(controller={"kind": "python", "file": "a.py", "class": "A"}, reference=HOLD),
        ScenarioError,
        ("reference", "accepts only tool references"),
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_inconsistent_controllers_are_rejected_with_their_place(name: str) -> None:
    data, kind, words = REFUSED[name]
    with pytest.raises(OnOrbitError) as caught:
        build(load(data))
    message = str(caught.value)
    assert type(caught.value) is kind, message
    assert all(word in message for word in words), message
    assert "\n" not in message and not message.endswith(".")
