"""``onorbit new``: its scenarios pass ``onorbit check`` and their runs pass their certificates."""

from __future__ import annotations

import re
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from chain_robots import SEVEN, arm
from commands import onorbit, refusal

import onorbit_rs as oo
from onorbit_rs.common.rotations import angle_between
from onorbit_rs.exceptions import ScenarioError, SimulationError
from onorbit_rs.scenario import load
from onorbit_rs.tools.new_scenario import draft, trial
from onorbit_rs.tools.new_scenario.arm import find_arm
from onorbit_rs.tools.new_scenario.motion import configuration, home, lines
from onorbit_rs.tools.new_scenario.reaction import GENTLE, rotation_per_metre, smallest_rotation

ROBOTS = Path(__file__).parent / "fixtures" / "robots"


def ran(file: Path) -> dict[str, Any]:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of the robot's file
        run = oo.run(file, quiet=True)
    assert run.summary["certificate_passed"], run.summary["certificate_failures"]
    return run.summary


@pytest.mark.parametrize("robot", oo.robots.names())
def test_every_bundled_robot_gets_a_scenario_that_passes_its_certificate(robot: str, tmp_path: Path) -> None:
    done = onorbit("new", robot, "--out", "mine.yaml", cwd=tmp_path)
    assert done.returncode == 0, done
    assert done.stdout.endswith("next: onorbit check mine.yaml\n")
    checked = onorbit("check", "mine.yaml", cwd=tmp_path)
    assert checked.returncode == 0 and "ok: " in checked.stdout, checked
    summary = ran(tmp_path / "mine.yaml")
    if "a body without joints" in done.stdout:
        assert not oo.robots.load(load(tmp_path / "mine.yaml").robot.bundled).joints
        return
    assert summary["joint_limits_exceeded"] == ""
    if "control_arm_result" not in summary:
        # too few joints to move a tool in six directions, so the draft moves or holds the joints
        assert robot in (
            "pusher", "four_bar_gripper", "parallel_gripper",
            "jaw_hand", "three_finger_hand", "docking_probe", "docking_ring_active",
        )  # fmt: skip
        errors = [error for key, error in summary.items() if key.endswith("joint_error_max_rad")]
        # the loops of the gripper are declared in its scenario; without them, its passive joints are not held
        assert robot == "four_bar_gripper" or all(error < 1e-3 for error in errors)
        return
    assert summary["control_arm_result"] == "succeeded"
    assert summary["tracking_position_error_max_m"] < 1e-3


@pytest.mark.slow
@pytest.mark.parametrize(
    ("robot", "tool", "joints"),
    [
        ("arm_with_hand.urdf", "hand_tcp", 7),
        ("long_arm_description/urdf/long_arm.urdf.xacro", "latch", 7),
    ],
)
def test_robots_on_an_empty_world_link_get_one_too(
    robot: str, tool: str, joints: int, tmp_path: Path
) -> None:
    """A hand whose fingers must stay within their limits; a 15 m arm heavier than its base."""
    file = tmp_path / "mine.yaml"
    drafted = draft(str(ROBOTS / robot), beside=tmp_path)
    assert (drafted.tool, len(drafted.joints)) == (tool, joints)
    file.write_text(drafted.text)
    summary = ran(file)
    assert summary["base_rotation_max_rad"] < 0.4
    assert summary["joint_limits_exceeded"] == ""


def fingers(friction: float) -> str:
    """Returns a robot with seven joints with friction and two light sliding fingers, closed at zero."""
    held = arm(SEVEN, names="tool").replace("<axis", f'<dynamics friction="{friction}" damping="1"/><axis')
    parts = [
        f'<link name="finger_{side}"><inertial><mass value="0.05"/>'
        '<inertia ixx="1e-4" iyy="1e-4" izz="1e-4" ixy="0" ixz="0" iyz="0"/></inertial></link>'
        f'<joint name="finger_{side}" type="prismatic"><parent link="tool"/><child link="finger_{side}"/>'
        f'<axis xyz="{axis}"/><dynamics damping="1"/>'
        '<limit lower="0" upper="0.045" effort="9" velocity="1"/></joint>'
        for side, axis in (("left", "0 1 0"), ("right", "0 -1 0"))
    ]
    return held.replace("</robot>", "".join(parts) + "</robot>")


@pytest.mark.parametrize("friction", [0.0, 2.0])
def test_fingers_stay_within_their_limits_while_the_arm_sticks(friction: float, tmp_path: Path) -> None:
    """With a gain of 25 1/s² at the limit they slid out: the law assumes motions that friction prevents."""
    (tmp_path / "mine.urdf").write_text(fingers(friction))
    file = tmp_path / "mine.yaml"
    file.write_text(draft(str(tmp_path / "mine.urdf"), tool="tool", beside=tmp_path).text)
    assert load(file).initial.joints["finger_left"] == 0.0225
    assert ran(file)["joint_limits_exceeded"] == ""


@pytest.mark.parametrize(("joints", "key"), [(SEVEN, "duration"), (SEVEN[:3], "times")])
def test_a_motion_is_as_slow_as_the_rate_limits_require(
    joints: list[tuple[str, str, str]], key: str, tmp_path: Path
) -> None:
    """At 0.1 m/s, or in 4 s, joints limited to 0.02 rad/s would be too fast."""
    (tmp_path / "mine.urdf").write_text(arm(joints, names="tool").replace('velocity="1"', 'velocity="0.02"'))
    file = tmp_path / "mine.yaml"
    file.write_text(draft(str(tmp_path / "mine.urdf"), beside=tmp_path).text)
    line = next(line for line in file.read_text().splitlines() if line.strip().startswith(f"{key}: "))
    assert line.endswith("# long enough for the limits of the joints")
    summary = ran(file)
    assert summary["joint_rates_exceeded"] == ""
    assert summary["simulated_s"] > 6.0
    hasty = re.sub(rf"({key}: \[?)[\d.]+ s", r"\g<1>4 s", file.read_text())
    file.write_text(hasty)
    assert ran(file)["joint_rates_exceeded"] != ""


def drafted(urdf: str, folder: Path) -> tuple[str, dict[str, Any]]:
    """Returns the text of a new scenario and the summary of its run."""
    (folder / "mine.urdf").write_text(urdf)
    text = draft(str(folder / "mine.urdf"), beside=folder).text
    (folder / "mine.yaml").write_text(text)
    return text, ran(folder / "mine.yaml")


def dynamics(urdf: str, values: str) -> str:
    return urdf.replace("<axis", f"<dynamics {values}/><axis")


@pytest.mark.parametrize("quick", [trial.FAST, 1e9])
def test_stiff_dampers_use_the_adaptive_integrator(
    quick: float, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Stiffness is detected before the first run, or after fixed steps fail."""
    monkeypatch.setattr(trial, "FAST", quick)
    text, summary = drafted(dynamics(arm(SEVEN[:2], names="tool"), 'damping="200"'), tmp_path)
    assert "\n  integrator: dormand_prince " in text
    assert summary["certificate_passed"]
    (tmp_path / "mine.yaml").write_text(text.replace("dormand_prince", "rk4"))
    with pytest.raises((AssertionError, SimulationError)):
        ran(tmp_path / "mine.yaml")


def test_joints_hold_if_no_motion_can_be_simulated_in_time(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A damper that stops a joint in 0.1 µs costs millions of steps per second; friction holds it at once."""
    monkeypatch.setattr("onorbit_rs.tools.new_scenario.write.LONGEST_S", 2.0)
    monkeypatch.setattr(trial, "_FIRST_ESTIMATE_S", 0.1)
    stiff = dynamics(arm(SEVEN[:4]), 'damping="1e6" friction="5"')
    text, summary = drafted(stiff, tmp_path)
    assert "trial runs of arm motions failed: too slow to simulate (2 runs), the damping" in text
    assert "  - name: hold                  # all joints keep" in text
    assert summary["simulated_s"] == 1.0
    with pytest.raises(ScenarioError, match=r"too slow to simulate \(3 runs\), the damping of j"):
        drafted(stiff.replace(' friction="5"', ""), tmp_path)


def test_joints_hold_if_their_limits_permit_no_motion(tmp_path: Path) -> None:
    """Some exporters write such limits for unknown values."""
    text, _ = drafted(arm(SEVEN[:2], limits='lower="0" upper="0"'), tmp_path)
    assert "trial runs of arm motions failed: position limits leave no range of motion\n" in text


def test_a_motion_is_as_slow_as_the_effort_limits_require(tmp_path: Path) -> None:
    urdf = arm(SEVEN[:3])
    assert "long enough for" not in drafted(urdf, tmp_path)[0]
    text, summary = drafted(urdf.replace('effort="100"', 'effort="0.1"'), tmp_path)
    assert "# long enough for the limits of the joints" in text
    assert summary["joint_efforts_exceeded"] == ""
    sticky = dynamics(urdf.replace('effort="100"', 'effort="1"'), 'friction="2"')
    text, summary = drafted(sticky, tmp_path)
    assert "# Joints that exceed their effort limits however slow the motion is: j0, j1, j2\n" in text
    assert summary["joint_efforts_exceeded"] == "j0, j1, j2"


@pytest.mark.parametrize(
    ("urdf", "kind", "moves"),
    [
        (arm(SEVEN, names="tool"), "computed_torque", "tool along a line"),
        (arm(SEVEN[:3]), "joint_computed_torque", "joints"),
        (
            arm([("slide", "prismatic", "1 0 0")], limits='lower="0" upper="0.5"'),
            "joint_computed_torque",
            "joints",
        ),
        (arm([("spin", "continuous", "0 0 1")]), "joint_computed_torque", "joints"),
        (
            arm([(name, "continuous", axis) for name, _, axis in SEVEN]),
            "computed_torque",
            "tool along a line",
        ),
        (arm([]), None, "rotates freely"),
        (
            arm([("- {a: b}", "revolute", "0 1 0"), ("#true", "revolute", "0 0 1")]),
            "joint_computed_torque",
            "joints",
        ),
    ],
)
def test_arms_with_any_number_and_kind_of_joints(
    urdf: str, kind: str | None, moves: str, tmp_path: Path
) -> None:
    (tmp_path / "mine.urdf").write_text(urdf)
    file = tmp_path / "mine.yaml"
    file.write_text(draft(str(tmp_path / "mine.urdf"), beside=tmp_path).text)
    scenario = load(file)
    assert [law.kind for law in scenario.laws] == ([kind] if kind else [])
    assert moves in scenario.description
    assert scenario.robot.urdf == Path("mine.urdf")
    ran(file)


def test_a_heavy_arm_hardly_rotates_its_base(tmp_path: Path) -> None:
    """With links of 3 kg on 1 kg, the longest of the lines would rotate the base by 54 degrees."""
    (tmp_path / "mine.urdf").write_text(arm(SEVEN, names="tool", base=(1, 0.01)))
    file = tmp_path / "mine.yaml"
    file.write_text(draft(str(tmp_path / "mine.urdf"), beside=tmp_path).text)
    assert 0.01 < ran(file)["base_rotation_max_rad"] < 0.4


def test_the_line_has_the_direction_that_rotates_the_base_least() -> None:
    """The last singular vector rotates the base least and is tried at full length."""
    model = oo.Model.from_urdf_string(arm(SEVEN, names="tool", base=(1, 0.01)))
    found = find_arm(model)
    assert found is not None
    pose = home(model, found)
    turns = rotation_per_metre(model, found, configuration(model, pose))
    hide_rounding = smallest_rotation(turns)
    rng = np.random.default_rng(3)
    others = rng.normal(size=(200, 3))
    others /= np.linalg.norm(others, axis=1)[:, None]
    assert np.linalg.norm(turns @ hide_rounding) <= np.linalg.norm(others @ turns.T, axis=1).min()
    longest = np.array(next(lines(model, found, pose))[0])
    along_axes = GENTLE / np.linalg.norm(turns, axis=0).min()
    assert np.linalg.norm(longest) > along_axes  # the limit for the coordinate axes
    assert abs(longest @ hide_rounding) == pytest.approx(np.linalg.norm(longest), rel=1e-3)


def test_the_rotation_of_the_base_is_predicted() -> None:
    """A small motion agrees to first order with the Jacobians at its start."""
    model = oo.robots.load("humanoid_torso")
    joints = dict(zip(model.joint_names, [0.53, -2.34, -2.0, -2.22, -2.27, -0.13, -0.2], strict=True))
    found = find_arm(model)
    assert found is not None
    q = configuration(model, joints)
    foretold = np.linalg.norm(rotation_per_metre(model, found, q), axis=0)
    for axis in range(3):
        step = np.zeros(3)
        step[axis] = 0.01
        start = model.frame_pose(q, found.tool)
        trace = oo.Simulation(
            model, q, np.zeros(model.nv), controller=oo.ComputedTorque(model, found.tool, kp=100, kd=20),
            reference=oo.LineParabola(start, displacement=step, duration=1.0), time_step=1e-2,
        ).run(1.5)  # fmt: skip
        turned = angle_between(trace.q[-1, 3:7], trace.q[0, 3:7])
        assert turned == pytest.approx(0.01 * foretold[axis], rel=0.1)


def test_every_section_and_number_has_a_comment() -> None:
    text = draft("humanoid_dual_arm").text
    data = yaml.safe_load(text)
    said = text.splitlines()
    for section in ("orbit", "environment", "controllers", "initial", "robot", "tool"):
        line = next(line for line in said if line.startswith(f"{section}:"))
        assert "# " in line, line
    for words in ("semi_major_axis: 6778 km", "kp: 25 ", "displacement: ", "duration: ", "time_step: "):
        line = next(line for line in said if words in line)
        assert "# " in line or line.rstrip().endswith(" s"), line
    assert {control["name"] for control in data["controllers"]} == {"arm", "hold"}
    assert all(len(line) <= 110 for line in said)


def test_commented_sections_work_when_uncommented(tmp_path: Path) -> None:
    text = draft("humanoid_dual_arm").text
    wanted = re.sub(r"(?m)^( +)# ", r"\1", text).replace(
        "\norbit:", "\nepoch: 2026-03-20 12:00:00 UTC\norbit:"
    )
    scenario = load(yaml.safe_load(wanted))
    kinds = [effect.kind for effect in scenario.environment]
    assert kinds == ["gravity_gradient", "drag", "radiation_pressure"]
    assert scenario.simulation.integrator == "dormand_prince" and scenario.simulation.record_wrenches
    file = tmp_path / "mine.yaml"
    file.write_text(wanted)
    ran(file)


def test_joints_whose_limits_exclude_zero_start_within_them(tmp_path: Path) -> None:
    urdf = arm(SEVEN, limits='lower="0.3" upper="1.5"', names="tool")
    (tmp_path / "mine.urdf").write_text(urdf)
    data = yaml.safe_load(draft(str(tmp_path / "mine.urdf")).text)
    positions = np.array(list(data["initial"]["joints"].values()))
    assert np.all((positions > 0.3) & (positions < 1.5))


def test_an_existing_file_is_not_overwritten(tmp_path: Path) -> None:
    file = tmp_path / "mine.yaml"
    file.write_text("mine")
    assert "--force" in refusal("new", "ets_vii", "--out", file)
    assert file.read_text() == "mine"
    done = onorbit("new", "humanoid_torso", "--out", file, "--force", "--quiet")
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert load(file).name == "humanoid_torso_first"


def test_without_a_file_stdout_contains_only_the_scenario() -> None:
    done = onorbit("new", "humanoid_torso")
    assert done.returncode == 0 and load(yaml.safe_load(done.stdout)).tool == "tool"


def test_bad_input_is_reported_in_one_line(tmp_path: Path) -> None:
    assert "did you mean 'ets_vii'" in refusal("new", "ets_vi")
    assert "missing.urdf" in refusal("new", tmp_path / "missing.urdf")
    assert "nowhere does not exist; create it first" in refusal(
        "new", "ets_vii", "--out", tmp_path / "nowhere" / "a.yaml"
    )
    assert "did you mean 'tool'" in refusal("new", "humanoid_torso", "--tool", "toool")
    assert "no joint moves the frame 'torso'" in refusal("new", "humanoid_torso", "--tool", "torso")
    (tmp_path / "bad.urdf").write_text("<robot")
    assert "bad.urdf" in refusal("new", tmp_path / "bad.urdf")
    (tmp_path / "light.urdf").write_text('<robot name="x"><link name="a"/></robot>')
    assert "no mass" in refusal("new", tmp_path / "light.urdf")
