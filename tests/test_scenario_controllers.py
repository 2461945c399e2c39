"""Controllers in YAML: all kinds, joint groups, times, goals, Python, invalid input."""

from __future__ import annotations

import json
import signal
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from test_output_checkpoint import scenario_file, stopped_run

import onorbit_rs as oo
from onorbit_rs.cli.summary import print_summary
from onorbit_rs.exceptions import (
    ControlError,
    NotFoundError,
    OnOrbitError,
    ShapeError,
)
from onorbit_rs.scenario import load
from onorbit_rs.scenario.build import build
from onorbit_rs.scenario.control.selection import joint_group

REST = [0.5342, -2.341, -2.0077, -2.2249, -2.2693, -0.1342, -0.1974]
TASK_GAINS = {"kp": 100, "kd": 20, "null_space_damping": 2}
JOINT = {"kind": "joint_computed_torque", "kp": 100, "kd": 20}


def one(**parts: Any) -> dict[str, Any]:
    return {
        "robot": "humanoid_torso",
        "initial": {"joints": REST},
        "simulation": {"duration": 0.5, "time_step": 0.001},
    } | parts


def two(*controls: dict[str, Any], **parts: Any) -> dict[str, Any]:
    return one(
        **{"robot": "humanoid_dual_arm", "initial": {"joints": REST + REST}, "controllers": list(controls)}
        | parts
    )


def arm(side: str, **parts: Any) -> dict[str, Any]:
    """Returns a joint-space control that moves the first joint of an arm."""
    path = {"kind": "joint_waypoints", "points": [{f"{side}_joint_1": 0.6}], "times": [0.2]}
    return {"name": side, "joints": f"{side}_*", "reference": path} | JOINT | parts


def run(data: dict[str, Any], **known: Any) -> oo.Run:
    return oo.run(data, quiet=True, **known)


def joint(result: oo.Run, name: str) -> Any:
    return result.trace.q[:, 7 + list(result.model.joint_names).index(name)]


def test_joint_computed_torque_follows_ramps_in_joint_space() -> None:
    ramps = {"kind": "joint_ramps", "speed": "20 deg/s", "moves": [{"joint": "right_joint_4", "to": -2.2}]}
    name = next(name for name in oo.robots.load("humanoid_torso").joint_names if name.endswith("4"))
    ramps["moves"][0]["joint"] = name  # type: ignore[index]
    result = run(one(controller=JOINT, reference=ramps))
    others = [i for i, other in enumerate(result.model.joint_names) if other != name]
    assert joint(result, name)[-1] == pytest.approx(-2.2, abs=1e-5)
    np.testing.assert_allclose(result.trace.q[-1, 7:][others], np.array(REST)[others], atol=1e-5)


def test_a_pid_resists_a_spin_within_its_limit() -> None:
    pid = {"kind": "joint_pid", "p": 5, "d": [1, 1, 1, 1, 0.1, 0.1, 0.05], "effort_limit": "100 mNm"}
    spin = {"joints": REST, "angular_velocity": [0, 0, "20 deg/s"]}
    result = run(one(controller=pid, initial=spin))
    assert 0.01 < np.abs(result.trace.tau).max() <= 0.1
    assert np.abs(result.trace.q[-1, 7:] - REST).max() < 0.1


def test_efforts_are_applied_as_commanded(tmp_path: Path) -> None:
    names = oo.robots.load("humanoid_torso").joint_names
    header, zeros = ",".join(["time", *names]), ",".join(["0"] * (len(names) - 1))
    (tmp_path / "efforts.csv").write_text(f"{header}\n0,0.02,{zeros}\n0.25,0.02,{zeros}\n0.5,0.02,{zeros}\n")
    efforts = {"kind": "joint_sampled", "file": "efforts.csv"}
    data = one(controller={"kind": "joint_pid", "interface": "effort"}, reference=efforts)
    (tmp_path / "mine.yaml").write_text(yaml.safe_dump(data))
    tau = oo.run(tmp_path / "mine.yaml", quiet=True).trace.tau
    np.testing.assert_allclose(tau[1:], np.broadcast_to([0.02, *[0.0] * 6], tau[1:].shape), atol=1e-15)


def test_compliance_keeps_a_tool_at_its_pose() -> None:
    soft = {
        "kind": "compliance",
        "stiffness": ["200 N/m", "200 N/m", "0.2 N/mm", "5 N m/rad", 5, 5],
        "damping": ["10 N s/m", 10, 10, 0.1, 0.1, 0.1],
        "null_space_damping": 0.02,
    }
    assert (
        load(one(tool="tool", controller=soft)).resolved()["controller"]["stiffness"] == [200] * 3 + [5] * 3
    )
    push = {"kind": "body_wrench", "body": "torso", "force": [50, 0, 0], "end": 0.1}
    settings = {"duration": 2, "time_step": 0.001}
    held, free = (
        run(one(tool="tool", environment=[push], simulation=settings) | law)
        for law in ({"controller": soft}, {})
    )
    moved = [np.linalg.norm(r.trace.tool_pose[-1, :3, 3] - r.trace.tool_pose[0, :3, 3]) for r in (held, free)]
    print(moved)
    assert moved[0] < 0.2 * moved[1]
    assert held.summary["tracking_position_error_final_m"] == pytest.approx(moved[0], rel=1e-6)


def test_groups_move_simultaneously_with_separate_summaries(tmp_path: Path) -> None:
    result = run(
        two(arm("right"), arm("left", goal={"tolerance": "0.1 deg", "time": 1})), out=tmp_path / "run"
    )
    assert joint(result, "right_joint_1")[-1] == pytest.approx(0.6, abs=1e-4)
    assert joint(result, "left_joint_1")[-1] == pytest.approx(0.6, abs=1e-4)
    assert result.summary["tracking_left_joint_error_max_rad"] < 1e-3
    assert result.summary["control_left_result"] == "succeeded"
    assert "control_right_result" not in result.summary
    with np.load(tmp_path / "run" / "trace.npz") as columns:
        assert columns["tracking_right"].shape == (len(result.trace.time), 7)
    assert "control_left_result" in (tmp_path / "run" / "summary.json").read_text()


SLIDER = """<robot name="crane">
<link name="bus"><inertial><mass value="10"/><inertia ixx="1"
iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="turn" type="revolute"><parent link="bus"/><child link="boom"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" effort="9" velocity="9"/></joint>
<link name="boom"><inertial><mass value="1"/><inertia ixx=".1"
iyy=".1" izz=".1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="slide" type="prismatic"><parent link="boom"/><child link="rod"/><axis xyz="0 1 0"/>
<limit lower="0" upper="1" effort="9" velocity="9"/></joint>
<link name="rod"><inertial><mass value="1"/><inertia ixx=".1"
iyy=".1" izz=".1" ixy="0" ixz="0" iyz="0"/></inertial></link>
</robot>"""


def crane(folder: Path, **parts: Any) -> dict[str, Any]:
    (folder / "crane.urdf").write_text(SLIDER)
    start = {"initial": {"joints": {"turn": 0.1, "slide": 0.2}}}
    return one(**start, robot=str(folder / "crane.urdf"), **parts)


def test_prismatic_joints_have_metres_and_newtons_revolute_joints_radians(tmp_path: Path) -> None:
    path = {"kind": "joint_waypoints", "points": [{"slide": 0.3}], "times": [0.3]}
    control = {"name": "arm", "joints": ["slide", "turn"], "reference": path} | JOINT
    result = run(crane(tmp_path, controllers=[control]))
    summary, trace = result.summary, result.trace
    tau, errors = np.abs(trace.tau).max(axis=0), np.abs(trace.tracking["arm"]).max(axis=0)
    assert (summary["joint_torque_max_nm"], summary["joint_force_max_n"]) == tuple(tau)
    assert summary["joint_rate_final_max_m_s"] == abs(trace.v[-1, 7])
    assert summary["joint_rate_final_max_rad_s"] == abs(trace.v[-1, 6])
    assert summary["tracking_arm_joint_error_max_m"] == errors[0]
    assert summary["tracking_arm_joint_error_max_rad"] == errors[1]


@pytest.mark.parametrize("has_reference", [True, False])
def test_a_single_joint_controller_reports_errors_like_one_in_a_list(
    tmp_path: Path, has_reference: bool, capsys: pytest.CaptureFixture[str]
) -> None:
    path = {"kind": "joint_waypoints", "points": [{"slide": 0.3, "turn": 0.3}], "times": [0.3]}
    tracked = {"reference": path} if has_reference else {}
    push = [{"kind": "body_wrench", "body": "rod", "force": [5, 5, 0], "end": 0.1}]
    soft = {"kind": "joint_pid", "p": 9, "d": 3}
    alone = run(crane(tmp_path, controller=soft, environment=push, **tracked)).summary
    listed = {"name": "arm"} | soft | tracked
    several = run(crane(tmp_path, controllers=[listed], environment=push)).summary
    print_summary(alone, None)
    printed = capsys.readouterr().out
    assert "\njoint error, largest" in printed and "\nprismatic joint error, largest" in printed
    for unit in ("rad", "m"):
        assert alone[f"tracking_joint_error_max_{unit}"] > 1e-4
        assert alone[f"tracking_joint_error_max_{unit}"] == several[f"tracking_arm_joint_error_max_{unit}"]


def test_a_joint_name_with_brackets_is_matched_before_patterns() -> None:
    joints = ["a[x]", "ax", "b*", "bc"]
    assert joint_group(["a[x]"], joints) == ["a[x]"]
    assert joint_group(["b*"], joints) == ["b*"]
    assert joint_group(["a[xy]", "?c"], joints) == ["ax", "bc"]


def test_joints_without_a_controller_are_free() -> None:
    result = run(two(arm("right", joints=["right_joint_1", "right_joint_[2-7]"])))
    left = [i for i, name in enumerate(result.model.joint_names) if name.startswith("left")]
    assert not result.trace.tau[:, left].any() and np.ptp(result.trace.q[:, 7:][:, left]) > 0.0


def test_controllers_follow_each_other_by_time_and_by_goal() -> None:
    goal = {"tolerance": ["1 mm", "0.5 deg"], "time": 1}
    line = {"kind": "line", "goal": {"displacement": [0.05, 0, 0]}, "duration": 0.3}
    reach = {
        "name": "reach",
        "kind": "computed_torque",
        "tool": "right_tool",
        "joints": "right_*",
    } | TASK_GAINS
    first = reach | {"reference": line, "goal": goal}
    rest = {"name": "rest", "joints": "right_*", "after": "reach", "starts_at_present": True} | JOINT
    result = run(
        two(first, rest, arm("left", start=0.1, end=0.2), simulation={"duration": 1, "time_step": 0.001})
    )
    assert {r["name"]: r["outcome"] for r in result.trace.results}["reach"] == "succeeded"
    assert result.summary["tracking_reach_position_error_max_m"] < 1e-3
    left = [i for i, name in enumerate(result.model.joint_names) if name.startswith("left")]
    driven = result.trace.time[np.abs(result.trace.tau[:, left]).max(axis=1) > 0.0]
    assert driven[0] >= 0.1 - 1e-9 and driven[-1] <= 0.2 + 1e-3 + 1e-9
    later = result.trace.time > 0.5
    assert np.ptp(joint(result, "right_joint_1")[later]) < 1e-3  # held at the end of the reach


def test_a_violated_path_tolerance_is_in_the_results() -> None:
    strict = {"tolerance": 1, "path_tolerance": 1e-9}
    result = run(
        two(
            arm("right", kp=1, kd=1, goal=strict),
            initial={"joints": REST + REST, "joint_rates": {"right_joint_2": 0.1}},
        )
    )
    assert result.summary["control_right_result"] == "path_tolerance_violated"


PYTHON = """
import numpy as np
import onorbit_rs

class Damp:
    def __init__(self, gain=0.1):
        if gain < 0:
            raise ValueError(f"gain {gain} is negative")
        self.gain, self.calls = gain, 0

    def update(self, t, state):
        self.calls += 1
        assert self.calls > 1 or t == 0.0, "another run's memory"
        return -self.gain * state.v[6:][:len(state.joints)]

class NoUpdate:
    pass

class Inherits(onorbit_rs.Controller):
    pass
"""


def python(folder: Path, text: str = PYTHON, **controller: Any) -> Path:
    (folder / "mine.py").write_text(text)
    file = folder / "mine.yaml"
    spin = {"joints": REST, "joint_rates": [0.1] * 7}
    part = {"kind": "python", "file": "mine.py", "class": "Damp"} | controller
    part = {key: value for key, value in part.items() if value is not None}
    file.write_text(yaml.safe_dump(one(initial=spin, controller=part)))
    return file


def test_a_python_controller_is_constructed_for_each_run_with_its_arguments(tmp_path: Path) -> None:
    result = oo.run(python(tmp_path, arguments={"gain": 0.5}), quiet=True)
    np.testing.assert_allclose(result.trace.tau[:-1], -0.5 * result.trace.v[:-1, 6:], atol=1e-15)
    assert result.trace.kinetic_energy[-1] < result.trace.kinetic_energy[0]


def test_a_controller_from_an_installed_module(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "a_module_of_mine.py").write_text(PYTHON)
    monkeypatch.syspath_prepend(tmp_path)
    result = run(one(controller={"kind": "python", "module": "a_module_of_mine", "class": "Damp"}))
    assert len(result.trace.time) > 1
    sys.modules.pop("a_module_of_mine")


BESIDE = """
class Push:
    def update(self, t, state):
        assert state.joints == [f"left_joint_{i}" for i in range(1, 8)]
        return [0.01] * COUNT
"""


def test_a_python_controller_drives_its_group_beside_another(tmp_path: Path) -> None:
    law = {
        "kind": "python",
        "file": str(tmp_path / "push.py"),
        "class": "Push",
        "joints": "left_*",
        "name": "left",
    }
    (tmp_path / "push.py").write_text(BESIDE.replace("COUNT", "7"))
    result = run(two(arm("right"), law))
    left = [i for i, name in enumerate(result.model.joint_names) if name.startswith("left")]
    assert (result.trace.tau[:-1, left] == 0.01).all()
    assert joint(result, "right_joint_1")[-1] == pytest.approx(0.6, abs=1e-4)
    (tmp_path / "push.py").write_text(BESIDE.replace("COUNT", "14"))
    with pytest.raises(ShapeError, match=r"controllers: .*one torque per joint"):
        run(two(arm("right"), law))


@pytest.mark.parametrize(
    "data",
    [
        two(arm("right"), arm("left", start=0.1)),
        one(tool="tool", controller={"kind": "compliance", "stiffness": 10, "damping": 0.1}),
        one(controller={"kind": "joint_pid", "p": 5, "d": 0.1, "interface": "position"}),
    ],
)
def test_a_resolved_scenario_resolves_to_itself(data: dict[str, Any], tmp_path: Path) -> None:
    first = run(data, out=tmp_path / "first")
    again = oo.run(tmp_path / "first" / "scenario.yaml", quiet=True)
    assert np.array_equal(first.trace.q, again.trace.q)
    assert again.scenario.resolved() == load(tmp_path / "first" / "scenario.yaml").resolved()


def test_a_resolved_scenario_finds_its_python_file_from_anywhere(tmp_path: Path) -> None:
    (tmp_path / "here").mkdir()
    first = oo.run(python(tmp_path / "here"), out=tmp_path / "out", quiet=True)
    again = oo.run(tmp_path / "out" / "scenario.yaml", quiet=True)
    assert np.array_equal(first.trace.q, again.trace.q)


@pytest.mark.parametrize(
    ("controller", "text", "kind", "words"),
    [
        ({"file": "none.py"}, PYTHON, NotFoundError, ("no such file", "none.py")),
        ({"class": "Dmap"}, PYTHON, ControlError, ("no class 'Dmap'", "did you mean 'Damp'")),
        ({"class": "NoUpdate"}, PYTHON, ControlError, ("no method update(t, state)",)),
        ({"class": "Inherits"}, PYTHON, ControlError, ("no method update(t, state)",)),
        ({"arguments": {"gain": -1}}, PYTHON, ControlError, ("raised ValueError: gain -1 is negative",)),
        ({"arguments": {"gian": 1}}, PYTHON, ControlError, ("Damp(...) of", "gian")),
        ({}, "import nothing_of_that_name", ControlError, ("mine.py", "ModuleNotFoundError")),
        ({}, "def broken(:", ControlError, ("mine.py", "SyntaxError")),
        (
            {"file": None, "module": "no_such_module_here"},
            PYTHON,
            NotFoundError,
            ("no_such_module_here", "install"),
        ),
    ],
)
def test_errors_of_a_python_controller_are_reported(
    controller: dict[str, Any], text: str, kind: type[OnOrbitError], words: tuple[str, ...], tmp_path: Path
) -> None:
    with pytest.raises(OnOrbitError) as caught:
        build(load(python(tmp_path, text, **controller)))
    message = str(caught.value)
    assert type(caught.value) is kind, message
    assert all(word in message for word in (*words, "mine.yaml", "controller")), message
    assert "\n" not in message


def test_an_exception_of_update_is_re_raised_unchanged(tmp_path: Path) -> None:
    text = "class Damp:\n    def update(self, t, state):\n        raise KeyError('mine')\n"
    with pytest.raises(KeyError, match="mine"):
        oo.run(python(tmp_path, text), quiet=True)


def test_a_check_names_every_controller(capsys: pytest.CaptureFixture[str]) -> None:
    from onorbit_rs.cli.check import print_checked

    print_checked(
        build(load(two(arm("right"), {"name": "left", "kind": "joint_pid", "p": 1, "joints": "left_*"})))
    )
    assert "joint_computed_torque, joint_pid" in capsys.readouterr().out


RAMP = """
import onorbit_rs as oo

class Ramp(oo.Controller):
    def reset(self):
        self.calls = 0

    def update(self, t, state):
        self.calls += 1
        return [1e-6 * self.calls] * len(state.joints)
"""


def test_a_killed_run_with_several_controllers_resumes_with_the_same_bits(tmp_path: Path) -> None:
    (tmp_path / "ramp.py").write_text(RAMP)
    ramp = {"name": "ramp", "joints": "left_*", "kind": "python", "file": "ramp.py", "class": "Ramp"}
    pid = {"name": "right", "joints": "right_*", "kind": "joint_pid", "p": 0.5, "i": 0.5, "d": 0.002}
    settings = {"duration": 4, "time_step": 1e-4, "control_period": 1e-3, "record_every": 10}
    file = scenario_file(tmp_path, two(ramp, pid, simulation=settings))
    out = stopped_run(tmp_path, json.loads(file.read_text()), signal.SIGKILL)
    whole, again = oo.run(file, quiet=True).trace, oo.resume(out, quiet=True).trace
    assert whole.tau[-1].max() > 3e-3  # the Python controller continued to count
    assert np.array_equal(again.q, whole.q) and np.array_equal(again.tau, whole.tau)
    assert np.array_equal(again.tracking["right"], whole.tracking["right"])
