"""Records of a robot's bodies, joints and frames, and ``onorbit info``."""

from __future__ import annotations

import io
import json
import warnings
from pathlib import Path

import numpy as np
import pytest
from border import joint, massive, urdf
from commands import onorbit, refusal
from rich.console import Console

import onorbit_rs as oo
from onorbit_rs.cli.robot_info import _mimic, print_info
from onorbit_rs.robots.describe import describe

MODEL = oo.robots.load("humanoid_dual_arm")


def text_of(model: oo.Model) -> str:
    console = Console(file=io.StringIO(), width=80, highlight=False)
    print_info(model, console)
    return console.file.getvalue()  # type: ignore[attr-defined]  # a StringIO


def test_records_give_the_mass_matrix_s_base_block() -> None:
    """Masses, centres and inertias of the records, moved by the link poses, sum to those of the robot."""
    q = MODEL.neutral()
    total, about_base = 0.0, np.zeros((3, 3))
    for body in MODEL.bodies:
        pose = MODEL.frame_pose(q, body.name)
        rot, com = pose[:3, :3], pose[:3, :3] @ body.com + pose[:3, 3]
        total += body.mass
        about_base += rot @ body.inertia @ rot.T + body.mass * (com @ com * np.eye(3) - np.outer(com, com))
    assert total == pytest.approx(MODEL.mass, rel=1e-14)
    np.testing.assert_allclose(about_base, MODEL.mass_matrix(q)[3:6, 3:6], atol=1e-12)


def test_records_of_joints_and_frames_give_the_poses_of_links() -> None:
    q = MODEL.neutral()
    for record in MODEL.joints:
        parent, child = MODEL.frame_pose(q, record.parent), MODEL.frame_pose(q, record.child)
        np.testing.assert_allclose(parent @ record.pose, child, atol=1e-14)
    for frame in MODEL.frames:
        pose = MODEL.frame_pose(q, frame.body) @ frame.pose
        np.testing.assert_allclose(pose, MODEL.frame_pose(q, frame.name), atol=1e-14)
    # the axis equals that of the Jacobian
    first = MODEL.joints[0]
    column = MODEL.frame_jacobian(q, first.child)[3:, 6]
    np.testing.assert_allclose(MODEL.frame_pose(q, first.child)[:3, :3] @ first.axis, column, atol=1e-14)


def test_limits_friction_and_rotors_are_listed() -> None:
    builder = oo.ModelBuilder("r", base="b", mass=1.0, inertia=np.eye(3))
    builder.add_link(
        "l",
        parent="b",
        joint="j",
        kind="prismatic",
        axis=[0, -2, 0],
        mass=1.0,
        inertia=np.eye(3),
        damping=0.1,
        friction=0.2,
        rotor_inertia=0.3,
        lower=-1.0,
        velocity=2.0,
        upper=float("inf"),
    )
    (record,) = builder.build().joints
    assert (record.kind, list(record.axis)) == ("prismatic", [0.0, -1.0, 0.0])
    assert (record.lower, record.upper, record.velocity, record.effort) == (-1.0, None, 2.0, None)
    assert (record.damping, record.friction, record.rotor_inertia) == (0.1, 0.2, 0.3)
    text = text_of(builder.build())
    assert "prismatic" in text and "-y" in text and "rotor inertia" in text


@pytest.mark.parametrize("name", oo.robots.names())
def test_info_fits_a_terminal_of_80_columns(name: str) -> None:
    done = onorbit("info", name)
    assert done.returncode == 0, done
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # for a robot with deliberate warnings
        model = oo.robots.load(name)
    lines = [line for line in done.stdout.splitlines() if not line.startswith("  - ")]  # the warnings as text
    assert all(len(line) <= 80 for line in lines)
    for word in (*model.body_names, *model.joint_names, *model.frame_names, f"mass {model.mass:.6g} kg"):
        assert word in done.stdout, word
    assert "\x1b" not in done.stdout


def test_info_as_data() -> None:
    data = json.loads(onorbit("info", "humanoid_dual_arm", "--json").stdout)
    assert data == json.loads(json.dumps(describe(MODEL)))
    assert len(data["joints"]) == 14 and data["mass_kg"] == MODEL.mass
    moments = data["bodies"][0]["principal_moments_kg_m2"]
    assert moments == sorted(moments)


def test_warnings_are_printed_at_the_end(tmp_path: Path) -> None:
    file = tmp_path / "odd.urdf"
    ball = massive("a") + massive("b") + joint("j", "a", "b", "ball")
    file.write_text(f'<robot name="odd [bold]">{ball}</robot>')
    done = onorbit("info", file)
    assert (done.returncode, done.stderr) == (0, "")
    assert "odd [bold]: 4 bodies, 3 joints" in done.stdout  # user text is not markup
    assert "warnings (1):" in done.stdout and "'j' is a ball joint" in " ".join(done.stdout.split())


def test_a_chain_of_500_links_is_printed_completely() -> None:
    body = massive("l0") + "".join(
        massive(f"l{i}") + joint(f"j{i}", f"l{i - 1}", f"l{i}") for i in range(1, 500)
    )
    lines = text_of(urdf(body)).splitlines()
    assert any("l499 by j499 on l498" in line for line in lines)
    assert max(map(len, lines)) <= 80


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["humanoid_tors"], ("humanoid_torso",)),
        (["/nowhere/robot.urdf"], ("/nowhere/robot.urdf", "no such file")),
        (["humanoid_torso", "--arg", "side"], ("NAME=VALUE",)),
        (["humanoid_reach", "--arg", "side=left"], ("humanoid_reach is a scenario", "omit them")),
    ],
)
def test_an_error_is_reported_in_one_line(arguments: list[str], words: tuple[str, ...]) -> None:
    done = onorbit("info", *arguments)
    assert done.returncode == 2
    assert len(done.stderr.splitlines()) == 1
    assert all(word in done.stderr for word in words), done.stderr


def test_options_of_robot_files_are_refused_for_a_scenario_in_a_folder(tmp_path: Path) -> None:
    file = tmp_path / "mine.yaml"
    file.write_text("robot: ball\nsimulation: {duration: 1 s}\n")
    assert onorbit("info", file).stdout.endswith(f"next: onorbit run {file} --out DIR\n")
    for options in (["--package-path", str(tmp_path)], ["--arg", "a=1"], ["--xacro"]):
        assert f"{file} is a scenario; omit them" in refusal("info", file, *options)


@pytest.mark.parametrize(("offset", "end"), [(0.2, "3 left + 0.2"), (-0.2, "3 left - 0.2"), (0.0, "3 left")])
def test_the_equation_of_a_mimic_joint_has_the_sign_of_its_offset(offset: float, end: str) -> None:
    assert _mimic("right", "left", 3.0, offset) == f"mimic joint: right = {end}"
