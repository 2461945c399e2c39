"""Output of a run on the terminal: checks beside their gates, controllers by name, divergence in one line."""

from __future__ import annotations

import json
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import world_runs
from commands import SPIN, onorbit, refusal
from results import listed

import onorbit_rs as oo
from onorbit_rs.cli.summary import print_summary
from onorbit_rs.exceptions import InputError, SimulationError
from onorbit_rs.output.checks import CHECKS, GATE, LOOPS
from onorbit_rs.scenario import load


def short(name: str, **settings: Any) -> dict[str, Any]:
    data = load(name).resolved()
    data["simulation"] |= {"duration": 0.1, "time_step": 5e-3, **settings}
    return data


def printed(capsys: pytest.CaptureFixture[str], summary: dict[str, Any]) -> list[str]:
    capsys.readouterr()
    print_summary(summary, None)
    return capsys.readouterr().out.splitlines()


def test_every_check_is_printed_beside_its_gate_and_unit(capsys: pytest.CaptureFixture[str]) -> None:
    run = oo.run(short("humanoid_reach"), quiet=True)
    lines = printed(capsys, run.summary)
    rows = run.trace.certificate()
    assert len(rows) == len(CHECKS) - len(LOOPS)
    for key, value, gate, passed in rows:
        assert run.summary[GATE + key] == gate
        name = key.removesuffix("_rel").removesuffix("_rad").replace("_", " ")
        (line,) = [line for line in lines if line.startswith(f"  {name} ")]
        unit = "rad" if key.endswith("_rad") else "relative"
        assert line.split()[-4:] == [f"{value:.2g}", f"{gate:.2g}", unit, "holds"] and passed


def test_the_checks_of_events_have_the_names_of_the_events(capsys: pytest.CaptureFixture[str]) -> None:
    lines = printed(capsys, oo.run(world_runs.data(), quiet=True).summary)
    names = {line.split("  ")[1] for line in lines if "/" in line}
    assert {"chaser+target/energy balance error", "let_go/linear momentum error"} <= names


def test_systems_that_no_event_connects_have_no_certificate_of_their_group(
    capsys: pytest.CaptureFixture[str],
) -> None:
    lines = printed(capsys, oo.run(world_runs.data(events=[]), quiet=True).summary)
    assert [line.strip() for line in lines[-2:]] == [
        "certificate passed: every value is within its gate",
        "nothing was written; save the results with --out DIR",
    ]


def test_a_failed_check_is_distinguished_from_passed_ones(capsys: pytest.CaptureFixture[str]) -> None:
    data = load("free_tumble").resolved()
    data["simulation"] |= {"duration": 10.0, "time_step": 0.1}
    summary = oo.run(data, quiet=True).summary
    broken = {line.split("  ")[1] for line in printed(capsys, summary) if line.rstrip().endswith("BROKEN")}
    failed = {
        name.removesuffix("_rel").removesuffix("_rad").replace("_", " ")
        for name in summary["certificate_failures"].split(", ")
    }
    assert broken == failed and 0 < len(broken) < len(CHECKS)


def test_a_summary_of_an_earlier_version_without_gates_is_printed(capsys: pytest.CaptureFixture[str]) -> None:
    summary = {"certificate_passed": True, "energy_balance_error_rel": 1e-9}
    assert printed(capsys, summary)[-2].split() == [
        "energy",
        "balance",
        "error",
        "1e-09",
        "-",
        "relative",
        "holds",
    ]
    assert "nothing was checked" in "".join(printed(capsys, {"status": "complete"}))


def test_errors_of_several_controllers_are_printed_with_their_names(
    capsys: pytest.CaptureFixture[str],
) -> None:
    summary = oo.run(short("dual_arm_reach"), quiet=True).summary
    lines = printed(capsys, summary)
    for name in ("left", "right"):
        for kind, unit in (("position", "m"), ("attitude", "rad")):
            (line,) = [line for line in lines if line.startswith(f"{name}: {kind} error, largest")]
            value = summary[f"tracking_{name}_{kind}_error_max_{unit}"]
            assert line.split()[-2:] == [f"{value:.4g}", unit]
        (line,) = [line for line in lines if line.startswith(f"{name}: goal")]
        assert line.split()[-1] == summary[f"control_{name}_result"]
    assert not any(line.startswith("tool ") for line in lines)  # the error of the first controller
    one = printed(capsys, oo.run(short("humanoid_reach"), quiet=True).summary)
    assert [line.split(",")[0] for line in one if line.startswith("tool ")] == [
        "tool position error", "tool attitude error",
    ]  # fmt: skip


def test_exceeded_joint_limits_are_reported(capsys: pytest.CaptureFixture[str]) -> None:
    assert "joint limits were exceeded: elbow" in printed(capsys, {"joint_limits_exceeded": "elbow"})
    assert not any("limits" in line for line in printed(capsys, {"joint_limits_exceeded": ""}))


BLOWING = (
    "robot: humanoid_torso\ncontroller: {kind: joint_pid, p: 100000, d: 3000}\n"
    "reference: {kind: joint_waypoints, points: [[1,1,1,1,1,1,1]], times: [1 s]}\n"
    "simulation: {duration: 5 s, time_step: 10 ms}\n"
)


def test_a_diverged_run_names_the_fastest_joint_and_keeps_the_state_in_the_error(tmp_path: Path) -> None:
    (tmp_path / "blow.yaml").write_text(BLOWING)
    with pytest.raises(SimulationError) as caught, pytest.warns(UserWarning, match="errors grow"):
        oo.run(tmp_path / "blow.yaml", quiet=True)
    error = caught.value
    joint = oo.robots.load("humanoid_torso").joint_names[int(np.argmax(np.abs(error.v))) - 6]
    done = onorbit("run", "blow.yaml", cwd=tmp_path)
    assert done.returncode == 2
    warned, said = done.stderr.splitlines()[0], done.stderr.splitlines()[-1]
    assert "controller.p corrects errors at a rate of 1.67e+04 1/s" in warned
    assert f"diverged at t = {error.time:.6g} s, in step {round(error.time / 0.01) + 1}:" in said
    assert f"joint '{joint}', {np.abs(error.v).max():.3g} rad/s" in said.replace("-", "")
    assert "try a time_step shorter than 0.01 s, or lower gains" in said
    assert len(said) < 300 and "[" not in said
    assert len(error.q) == 14 and len(error.v) == 13
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(error)).v, error.v)


@pytest.mark.parametrize("value", ["nan", "inf", "-1"])
def test_an_invalid_checkpoint_interval_is_rejected_before_the_run(value: str, tmp_path: Path) -> None:
    said = refusal("run", "free_tumble", "--out", "out", "--checkpoint-every", value, cwd=tmp_path)
    assert "checkpoint_every is" in said and "at least 0" in said
    assert not (tmp_path / "out").exists()
    with pytest.raises(InputError, match="checkpoint_every"):
        oo.run("free_tumble", quiet=True, checkpoint_every=float(value))


def test_checkpoints_without_a_folder_are_rejected_with_a_fix() -> None:
    assert refusal("run", "free_tumble", "--checkpoint-every", "5").endswith("add --out DIR")


def test_an_instant_is_checked_before_anything_is_printed(tmp_path: Path) -> None:
    (tmp_path / "summary.json").write_text('{"simulated_s": 1.0}')
    listed(tmp_path)
    for moment in ("7", "nan", "-1"):
        assert "outside the run" in refusal("show", ".", "--picture", "p.png", "--at", moment, cwd=tmp_path)
    assert "add --picture FILE" in refusal("show", ".", "--at", "0.5", cwd=tmp_path)
    (tmp_path / "p.png").touch()
    assert "replace it with --force" in refusal("show", ".", "--picture", "p.png", cwd=tmp_path)


def test_a_figure_of_a_comparison_is_not_replaced_without_force(tmp_path: Path) -> None:
    (tmp_path / "mine.yaml").write_text(SPIN)
    figure = tmp_path / "d.svg"
    figure.write_text("mine")
    words = ("compare", "mine.yaml", "mine.yaml", "--out", "d.svg")
    assert "d.svg already exists; replace it with --force" in refusal(*words, cwd=tmp_path)
    assert figure.read_text() == "mine"
    done = onorbit(*words, "--force", "--json", cwd=tmp_path)
    assert done.returncode == 0 and json.loads(done.stdout)["agrees"] is True
    assert "<svg" in figure.read_text()


PLAIN = (
    '<robot name="{name}"><link name="a"><inertial><mass value="1"/>'
    '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>'
)


@pytest.mark.parametrize("command", ["info", "new"])
def test_robot_options_without_effect_are_rejected(command: str, tmp_path: Path) -> None:
    (tmp_path / "plain.urdf").write_text(PLAIN.format(name="x"))
    said = refusal(command, "plain.urdf", "--package-path", "nowhere", cwd=tmp_path)
    assert "--package-path nowhere is not an existing folder; give a folder" in said
    said = refusal(command, "plain.urdf", "--arg", "a=1", cwd=tmp_path)
    assert (
        said
        == "onorbit: --arg applies only to xacro files, but plain.urdf does not end in .xacro; omit --arg or "
        "add --xacro"
    )
    for option in (("--arg", "a=1"), ("--package-path", ".")):
        assert "apply only to robot files" in refusal(command, "ets_vii", *option, cwd=tmp_path)
    assert "NAME=VALUE" in refusal(command, "plain.urdf", "--arg", "a", cwd=tmp_path)
    done = onorbit(command, "plain.urdf", "--package-path", ".", cwd=tmp_path)
    assert done.returncode == 0, done


def test_the_suggested_command_repeats_the_robot_options(tmp_path: Path) -> None:
    pytest.importorskip("xacro", reason="xacro is not installed: pip install 'onorbit-rs[xacro]'")
    text = PLAIN.format(name="$(arg who)").replace(
        "<robot ", '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" '
    )
    (tmp_path / "r.xacro").write_text(text)
    words = ("r.xacro", "--package-path", ".", "--arg", "who=a b")
    last_line = onorbit("info", *words, cwd=tmp_path).stdout.splitlines()[-1]
    assert last_line == "next: onorbit new r.xacro --package-path . --arg 'who=a b' --out FILE"
    made = onorbit("new", *words, cwd=tmp_path).stdout.splitlines()[0]
    assert made == "# Written by: onorbit new r.xacro --package-path . --arg 'who=a b'"


def test_the_number_of_joints_is_singular_for_one(tmp_path: Path) -> None:
    (tmp_path / "one.urdf").write_text(
        '<robot name="one"><link name="a"><inertial><mass value="5"/>'
        '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>'
        '<link name="b"><inertial><origin xyz="0.3 0 0"/><mass value="1"/>'
        '<inertia ixx=".1" iyy=".1" izz=".1" ixy="0" ixz="0" iyz="0"/>'
        '</inertial></link><joint name="j" type="revolute"><parent link="a"/><child link="b"/>'
        '<axis xyz="0 0 1"/><limit lower="-2" upper="2" effort="9" velocity="1"/></joint></robot>'
    )
    made = onorbit("new", "one.urdf", "--out", "one.yaml", cwd=tmp_path)
    assert "moved by 1 joint)" in made.stdout, made
    assert "one (1 joint, 6 kg)" in onorbit("check", "one.yaml", cwd=tmp_path).stdout
    assert "2 bodies, 1 joint, " in onorbit("info", "one.urdf", cwd=tmp_path).stdout
