"""``onorbit new CHASER TARGET``: scenarios of a capture that pass their certificates."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from chain_robots import SEVEN, arm
from commands import onorbit, refusal

import onorbit_rs as oo
from onorbit_rs.exceptions import FrameError, ScenarioError
from onorbit_rs.scenario import WorldScenario, load
from onorbit_rs.scenario.build_world import build_world
from onorbit_rs.tools.new_scenario import Source, draft_capture
from onorbit_rs.tools.new_scenario.approach import GAP_M, find_handle

ROBOTS = Path(__file__).parent / "fixtures" / "robots"

pytestmark = pytest.mark.usefixtures("no_pictures")


def ran(file: Path) -> dict[str, Any]:
    """Returns the summary of a certified run of a drafted file, in which both events happen."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of the robots' files
        summary = oo.run(file, quiet=True).summary
    assert summary["certificate_passed"], summary["certificate_failures"]
    assert [event["name"] for event in summary["events"]] == ["grasp", "let_go"]
    return summary


@pytest.mark.parametrize(
    ("chaser", "target", "tool", "handle"),
    [
        ("servicer", "target_satellite", "tool", "handle"),
        ("ets_vii", "small_satellite", "tool", "handle"),
        ("station_arm", "target_satellite", "tool", "handle"),
        ("humanoid_dual_arm", "small_satellite", "right_tool", "handle"),
        ("humanoid_torso", "humanoid_torso", "tool", "torso"),
        ("small_satellite", "target_satellite", "handle", "handle"),
    ],
)
def test_bundled_robots_capture_each_other(
    chaser: str, target: str, tool: str, handle: str, tmp_path: Path
) -> None:
    done = onorbit("new", chaser, target, "--out", "mine.yaml", cwd=tmp_path)
    assert done.returncode == 0, done
    assert done.stdout.splitlines()[0] == f"scenario: mine.yaml (chaser/{tool} captures target/{handle})"
    checked = onorbit("check", "mine.yaml", cwd=tmp_path)
    assert checked.returncode == 0 and "ok: " in checked.stdout, checked
    summary = ran(tmp_path / "mine.yaml")
    grasp, let_go = summary["events"]
    assert grasp["systems"] == ["chaser", "target"] and let_go["energy_lost_j"] < 0.0  # of the spring
    for system in summary["systems"].values():
        assert system.get("joint_limits_exceeded", "") == ""


def test_the_frames_approach_each_other_along_an_axis_of_the_tool(tmp_path: Path) -> None:
    drafted = draft_capture(Source("servicer"), Source("target_satellite"))
    file = tmp_path / "mine.yaml"
    file.write_text(drafted.text)
    scenario = load(file)
    assert isinstance(scenario, WorldScenario)
    built = build_world(scenario)
    chaser, target = built.systems["chaser"], built.systems["target"]
    pose_wt = chaser.model.frame_pose(chaser.q, drafted.tool)
    between = np.linalg.inv(pose_wt) @ target.model.frame_pose(target.q, drafted.handle)
    np.testing.assert_allclose(between[:3, 3], [0, 0, GAP_M], atol=1e-5)
    np.testing.assert_allclose(between[:3, :3], np.eye(3), atol=1e-8)
    speed = target.model.frame_velocity(target.q, target.v, drafted.handle)[:3]
    np.testing.assert_allclose(pose_wt[:3, :3].T @ speed, [0, 0, -0.02], atol=1e-9)
    # the target is farther from the chaser than its handle
    away = pose_wt[:3, 3] - chaser.model.center_of_mass(chaser.q)
    assert away @ (target.model.center_of_mass(target.q) - pose_wt[:3, 3]) > 0.0
    # the picture shows both
    assert drafted.model.mass == pytest.approx(chaser.model.mass + target.model.mass)


def test_frames_that_are_not_parallel_are_captured_at_any_angle(tmp_path: Path) -> None:
    """The target lies behind its handle whatever the axis, because the handle points into it."""
    target = """<robot name="box"><link name="body"><inertial><origin xyz="0 0 -1"/><mass value="50"/>
    <inertia ixx="5" iyy="5" izz="5" ixy="0" ixz="0" iyz="0"/></inertial></link><link name="docking_port"/>
    <joint name="port" type="fixed"><parent link="body"/><child link="docking_port"/>
    <origin xyz="ORIGIN" rpy="0 0 0"/></joint></robot>"""
    angles = []
    for number, origin in enumerate(("0 0 -2", "0 0 0.1")):
        (tmp_path / "box.urdf").write_text(target.replace("ORIGIN", origin))
        file = tmp_path / f"mine_{number}.yaml"
        drafted = draft_capture(Source("servicer"), Source(str(tmp_path / "box.urdf")), beside=tmp_path)
        assert drafted.handle == "docking_port"
        file.write_text(drafted.text)
        ran(file)
        angles.append(load(file).events[0].when.latch.within[1])  # type: ignore[union-attr]
    assert angles == [pytest.approx(np.radians(2.0)), pytest.approx(np.radians(180.0))]


def test_the_handle_is_the_frame_with_such_a_name() -> None:
    assert find_handle(oo.robots.load("target_satellite")) == "handle"
    assert find_handle(oo.robots.load("small_satellite")) == "handle"
    assert find_handle(oo.robots.load("humanoid_torso")) == "torso"


def test_files_with_a_hand_a_bus_and_frames_of_choice(tmp_path: Path) -> None:
    (tmp_path / "arm.urdf").write_text(arm(SEVEN, names="tool"))
    done = onorbit(
        "new", "arm.urdf", str(ROBOTS / "arm_with_hand.urdf"), "--bus", "small_satellite", "--at", "handle",
        "--prefix", "my_", "--tool", "my_tool", "--target-frame", "hand_tcp", "--out", "mine.yaml",
        "--picture", "both.png", cwd=tmp_path,
    )  # fmt: skip
    assert done.returncode == 0, done
    assert (tmp_path / "both.png").stat().st_size > 10_000
    data = yaml.safe_load((tmp_path / "mine.yaml").read_text())
    chaser, target = data["systems"]["chaser"], data["systems"]["target"]
    assert chaser["robot"]["bus"] == "small_satellite" and chaser["tool"] == "my_tool"
    assert data["events"][0]["do"]["capture"] == ["chaser/my_tool", "target/hand_tcp"]
    assert target["controller"]["kind"] == "joint_computed_torque"
    first = (tmp_path / "mine.yaml").read_text().splitlines()[0]
    assert "onorbit new arm.urdf" in first and "--target-frame hand_tcp" in first
    ran(tmp_path / "mine.yaml")


def test_wrong_frames_and_options_are_refused(tmp_path: Path) -> None:
    with pytest.raises(FrameError, match="handel"):
        draft_capture(Source("servicer"), Source("target_satellite"), handle="handel")
    with pytest.raises(FrameError, match="toool"):
        draft_capture(Source("servicer"), Source("target_satellite"), tool="toool")
    message = refusal("new", "servicer", "--target-frame", "handle")
    assert "--target-frame handle applies only with a target" in message
    assert "no bundled robot is named 'nobody'" in refusal("new", "servicer", "nobody")


def test_a_plan_that_cannot_pass_is_refused_with_its_reasons(monkeypatch: pytest.MonkeyPatch) -> None:
    from onorbit_rs.tools.new_scenario import capture

    monkeypatch.setattr(capture, "LONGEST_S", 1e-3)
    with pytest.raises(
        ScenarioError,
        match=r"every trial run of servicer_captures_.* failed; .*; reasons: too slow to simulate",
    ):
        draft_capture(Source("servicer"), Source("target_satellite"))
