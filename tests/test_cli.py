"""The command line: an error is one line and exit code 2, and successful commands name their output."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import time
from functools import partial
from pathlib import Path

import pytest
from commands import SPIN, onorbit, refusal

from onorbit_rs import scenarios
from onorbit_rs.campaigns.bundled import CAMPAIGNS

SHORT_REACH = (
    scenarios.path("humanoid_reach")
    .read_text()
    .replace("duration: 6 s", "duration: 0.1 s")
    .replace("time_step: 1 ms", "time_step: 5 ms")
)


def in_a_process(*arguments: str | Path, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "onorbit_rs", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, cwd=cwd, timeout=120, check=False)


def test_list_names_every_bundled_scenario() -> None:
    done = in_a_process("list")
    assert done.returncode == 0
    for name in ("humanoid_reach", "kepler_orbit", "free_tumble", "humanoid_torso", "humanoid_dual_arm"):
        assert name in done.stdout


@pytest.mark.parametrize("name", scenarios.names())
def test_check_accepts_every_bundled_scenario(name: str) -> None:
    done = onorbit("check", name)
    assert done.returncode == 0, done
    assert done.stdout.startswith(f"ok: {name}: ")


def test_run_writes_the_folder_and_show_reads_it(tmp_path: Path) -> None:
    (tmp_path / "mine.yaml").write_text(SHORT_REACH)
    done = onorbit("run", "mine.yaml", "--out", "out", cwd=tmp_path)
    assert done.returncode == 0, done
    assert "certificate passed" in done.stdout
    assert "onorbit show out" in done.stdout
    assert (tmp_path / "out" / "run.rrd").is_file()
    shown = onorbit("show", "out", "--no-viewer", cwd=tmp_path)
    assert shown.returncode == 0, shown
    assert "tool position error" in shown.stdout
    assert "--force" in refusal("run", "mine.yaml", "--out", "out", cwd=tmp_path)
    (tmp_path / "mine.yaml").write_text(SPIN)
    again = onorbit("run", "mine.yaml", "--out", "out", "--force", "--quiet", cwd=tmp_path)
    assert (again.returncode, again.stdout, again.stderr) == (0, "", "")


@pytest.mark.parametrize(
    ("right", "wrong", "says"),
    [
        ("semi_major_axis", "semi_major_axix", ":12: orbit.semi_major_axix: unknown key; did you mean"),
        ("tool: tool ", "tool: toll ", "tool"),
        ("robot: humanoid_torso", "robot: humanoid_torsoo", ":6: robot: no bundled robot"),
        ("robot: humanoid_torso", "robot: missing.urdf", ":6: robot: "),
        ("[0.5342, -2.341", "[-2.341", "joints has 6 entries, but the robot has 7"),
        (
            "joints: [0.5342, -2.341, -2.0077, -2.2249, -2.2693, -0.1342, -0.1974]",
            "joints: {elbow: 0}",
            "elbow",
        ),
        ("robot: humanoid_torso", "robot: [", "invalid YAML"),
    ],
)
def test_an_invalid_scenario_is_reported_in_one_line(
    tmp_path: Path, right: str, wrong: str, says: str
) -> None:
    assert right in SHORT_REACH
    file = tmp_path / "mine.yaml"
    file.write_text(SHORT_REACH.replace(right, wrong))
    for command in ("check", "run"):
        line = refusal(command, file)
        assert says in line
        assert str(file) in line


@pytest.mark.parametrize(
    ("urdf", "says"),
    [
        ("", "mine.urdf"),
        ("not xml", "mine.urdf"),
        ("<robot name='x'>", "mine.urdf"),
        ("<robot name='x'/>", "mine.urdf"),
    ],
)
def test_an_invalid_urdf_is_reported_in_one_line(tmp_path: Path, urdf: str, says: str) -> None:
    (tmp_path / "mine.urdf").write_text(urdf)
    file = tmp_path / "mine.yaml"
    file.write_text(SHORT_REACH.replace("robot: humanoid_torso", "robot: mine.urdf"))
    assert says in refusal("check", file)


@pytest.mark.usefixtures("no_pictures")
def test_text_in_brackets_is_not_markup(tmp_path: Path) -> None:
    (tmp_path / "mine.yaml").write_text(SPIN.replace("name: spin", 'name: "[/oops]"'))
    done = onorbit("run", "mine.yaml", "--out", "o [x]", cwd=tmp_path)
    assert done.returncode == 0, done
    assert done.stdout.startswith("[/oops]: complete")
    assert "next: onorbit show 'o [x]'" in done.stdout
    for moment in ("nan", "7"):
        assert "outside the run" in refusal(
            "show", "o [x]", "--picture", "p.png", "--at", moment, cwd=tmp_path
        )


@pytest.mark.parametrize("name", ["x.jpg", "x", "x.png.svg"])
def test_a_picture_without_the_extension_png_is_rejected(tmp_path: Path, name: str) -> None:
    (tmp_path / "summary.json").write_text('{"simulated_s": 1.0}')
    expected = f"--picture: the file name {name} must end in .png"
    assert expected in refusal("show", ".", "--picture", name, cwd=tmp_path)
    assert not (tmp_path / name).exists()


def test_a_position_in_km_instead_of_m_is_rejected_by_check_without_a_folder(tmp_path: Path) -> None:
    file = tmp_path / "mine.yaml"
    file.write_text("robot: humanoid_torso\norbit: {semi_major_axis: 6778}\nsimulation: {duration: 1 s}\n")
    assert f"{file}:2: orbit: " in refusal("check", file)
    assert f"{file}:2: orbit: " in refusal("run", file, "--out", tmp_path / "out")
    assert not (tmp_path / "out").exists()


def certificate_lines(folder: Path, simulation: str) -> dict[str, list[str]]:
    """Returns value, gate, unit and verdict of each check printed by ``onorbit run``."""
    (folder / "mine.yaml").write_text(SHORT_REACH.replace("time_step: 5 ms", simulation))
    done = onorbit("run", "mine.yaml", cwd=folder)
    assert done.returncode == 0, done
    lines = [line for line in done.stdout.splitlines() if line.startswith("  ") and line.strip()]
    checks = (re.split(r" {2,}", line.strip(), maxsplit=1) for line in lines[1:])
    return {name: values.split() for name, values in checks}


def test_omitted_rows_omit_no_check(tmp_path: Path) -> None:
    whole = certificate_lines(tmp_path, "time_step: 5 ms")
    sparse = certificate_lines(tmp_path, "time_step: 5 ms\n  record_every: 2")
    assert list(whole) == list(sparse) and len(whole) == 9
    assert {values[-1] for values in (*whole.values(), *sparse.values())} == {"holds"}
    compared = [name for name in whole if name.endswith("step doubling")]
    assert len(compared) == 3  # the same steps are halved, independent of recording
    assert [sparse[name] for name in compared] == [whole[name] for name in compared]


def test_the_summary_names_the_checks_omitted_with_adaptive_steps(tmp_path: Path) -> None:
    adaptive = certificate_lines(tmp_path, "integrator: dormand_prince\n  time_step: 5 ms")
    absent = [name for name, values in adaptive.items() if values[-2:] == ["not", "evaluated"]]
    assert {"base rows residual", "attitude consistency"} <= set(absent) < set(adaptive)
    assert all(values[-1] == "holds" for name, values in adaptive.items() if name not in absent)


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
def test_a_full_device_at_stdout_is_reported_in_one_line() -> None:
    command = [sys.executable, "-m", "onorbit_rs", "list"]
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(
            command, stdout=full, stderr=subprocess.PIPE, text=True, timeout=60, check=False
        )
    assert (done.returncode, done.stderr) == (
        2,
        "onorbit: cannot write the output: No space left on device\n",
    )


def test_invalid_arguments_are_reported_in_one_line(tmp_path: Path) -> None:
    assert "NAME_OR_FILE" in refusal("run")
    assert "No such option" in refusal("run", "humanoid_reach", "--bar")
    commands = "run, resume, campaign, ros2, list, check, show, info, convert, new, copy, report, export"
    assert f"Commands are: {commands}" in refusal("rum")
    assert "did you mean 'humanoid_reach'" in refusal("run", "humanoid_rech")
    assert "no such folder" in refusal("show", tmp_path / "nowhere")
    assert "no run in this folder" in refusal("show", tmp_path)
    (tmp_path / "cases.parquet").touch()
    assert "it contains a campaign: its results are in cases.parquet" in refusal("show", tmp_path)
    for command in ("run", "check"):
        assert "'capture_campaign' is a campaign; run it with: onorbit campaign" in refusal(
            command, "capture_campaign"
        )
    campaign = CAMPAIGNS.path("capture_campaign")
    assert "the content is a campaign, not a scenario" in refusal("run", campaign)
    (tmp_path / "summary.json").write_text("[")
    assert "cannot read" in refusal("show", tmp_path)
    assert "is a folder" in refusal("check", tmp_path)


def test_a_binary_scenario_is_reported_in_one_line(tmp_path: Path) -> None:
    file = tmp_path / "mine.yaml"
    file.write_bytes(bytes(range(256)))
    assert "binary" in refusal("check", file)


@pytest.mark.skipif(os.name != "posix", reason="sends SIGINT")
def test_ctrl_c_keeps_the_partial_trace_and_reports_it(tmp_path: Path) -> None:
    file = tmp_path / "mine.yaml"
    file.write_text(SHORT_REACH.replace("duration: 0.1 s", "duration: 10 h\n  record_every: 1000"))
    command = [sys.executable, "-m", "onorbit_rs", "run", str(file), "--out", str(tmp_path / "out")]
    command += ["--checkpoint-every", "0", "--quiet"]
    listens = partial(
        signal.signal, signal.SIGINT, signal.SIG_DFL
    )  # background jobs of a shell ignore SIGINT
    with subprocess.Popen(
        command, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True, preexec_fn=listens
    ) as run:
        deadline = time.monotonic() + 60.0
        while not (tmp_path / "out" / "checkpoint" / "state.json").exists():  # inside the simulation loop
            assert run.poll() is None and time.monotonic() < deadline
            time.sleep(0.05)
        run.send_signal(signal.SIGINT)
        _, stderr = run.communicate(timeout=60)
    assert run.returncode == 130
    assert stderr.startswith("onorbit: stopped by Ctrl-C at t = ")
    assert "the trace up to this time is in" in stderr
    assert len(stderr.splitlines()) == 1
    assert (tmp_path / "out" / "trace.npz").is_file()


@pytest.mark.usefixtures("no_pictures")
def test_a_warning_is_printed_in_one_line_and_in_the_summary(tmp_path: Path) -> None:
    (tmp_path / "w.urdf").write_text(
        '<robot name="x"><link name="a"><inertial><mass value="1"/>'
        '<inertia ixx="1" iyy="1" izz="5" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>'
    )
    (tmp_path / "w.yaml").write_text("robot: w.urdf\nsimulation: {duration: 0.1 s}\n")
    done = onorbit("run", "w.yaml", "--quiet", "--out", "out", cwd=tmp_path)
    assert done.stderr.startswith("onorbit: warning: the inertia of link 'a'")
    assert (done.returncode, len(done.stderr.splitlines())) == (0, 1)
    assert "triangle inequality" in (tmp_path / "out" / "summary.json").read_text()


def test_a_run_that_diverges_on_mujoco_writes_no_log(tmp_path: Path) -> None:
    """MuJoCo and numpy print no warnings, and MUJOCO_LOG.TXT is not written to the working directory."""
    mujoco = pytest.importorskip("mujoco", reason="MuJoCo is not installed: pip install 'onorbit-rs[mujoco]'")
    loud = mujoco.MjLogConfig.get()
    assert loud.logto_file  # like MuJoCo
    (tmp_path / "blow.yaml").write_text(
        "robot: humanoid_torso\nengine: mujoco\ncontroller: {kind: joint_pid, p: 100000, d: 3000}\n"
        "reference: {kind: joint_waypoints, points: [[1,1,1,1,1,1,1]], times: [1 s]}\n"
        "simulation: {duration: 5 s, time_step: 10 ms}\n"
    )
    done = in_a_process("run", "blow.yaml", "--out", "out", "--quiet", cwd=tmp_path)
    assert done.returncode != 0
    ours = ("onorbit: warning: controller.", "onorbit: the run diverged")
    assert all(line.startswith(ours) for line in done.stderr.splitlines()), done.stderr
    assert sorted(file.name for file in tmp_path.iterdir()) == ["blow.yaml", "out"]
