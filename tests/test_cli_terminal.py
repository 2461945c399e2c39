"""Output on a terminal and in a pipe."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from commands import SPIN, onorbit, refusal
from test_cli import SHORT_REACH

from onorbit_rs import robots, scenarios
from onorbit_rs.campaigns.bundled import CAMPAIGNS
from onorbit_rs.common import progress

COLOR = re.compile(r"\x1b\[[0-9;]*3[0-9][0-9;]*m")
"""A sequence that sets a foreground colour."""


@pytest.fixture
def reach(tmp_path: Path) -> Path:
    file = tmp_path / "mine.yaml"
    file.write_text(SHORT_REACH)
    return file


@pytest.fixture
def spin(tmp_path: Path) -> Path:
    file = tmp_path / "mine.yaml"
    file.write_text(SPIN)
    return file


def on_terminal(*arguments: str | Path, cwd: Path, **environment: str) -> tuple[int, str]:
    """Returns the exit code and everything written to a terminal of 100 columns."""
    pty = pytest.importorskip("pty", reason="this system has no pseudo-terminals")
    master, slave = pty.openpty()
    settings = {name: value for name, value in os.environ.items() if name not in ("NO_COLOR", "FORCE_COLOR")}
    settings |= {"TERM": "xterm-256color", "COLUMNS": "100"} | environment
    command = [sys.executable, "-m", "onorbit_rs", *map(str, arguments)]
    with subprocess.Popen(command, stdin=slave, stdout=slave, stderr=slave, cwd=cwd, env=settings) as run:
        os.close(slave)
        written = b"".join(_chunks(master))
        code = run.wait(timeout=60)
    os.close(master)
    return code, written.decode()


def _chunks(master: int) -> Iterator[bytes]:
    while True:
        try:
            chunk = os.read(master, 65536)
        except OSError:  # the other end is closed
            return
        if not chunk:
            return
        yield chunk


@pytest.mark.usefixtures("no_pictures")
def test_json_output_of_a_run_is_the_summary_only(spin: Path) -> None:
    done = onorbit("run", spin.name, "--out", "out", "--json", cwd=spin.parent)
    assert (done.returncode, done.stderr) == (0, "")
    assert json.loads(done.stdout) == json.loads((spin.parent / "out" / "summary.json").read_text())
    shown = onorbit("show", "out", "--json", cwd=spin.parent)
    assert json.loads(shown.stdout) == json.loads(done.stdout)
    reported = onorbit("report", "out", "--json", "--no-pdf", cwd=spin.parent)
    made = json.loads(reported.stdout)
    assert (spin.parent / made["report"]).stat().st_size == made["bytes"]
    assert not list((spin.parent / "out" / "figures").glob("*.pdf"))


def test_json_of_a_run_without_a_folder(reach: Path) -> None:
    done = onorbit("run", reach, "--json")
    assert json.loads(done.stdout)["status"] == "complete"


def test_json_of_list_and_check(reach: Path) -> None:
    listed = json.loads(onorbit("list", "--json").stdout)
    assert [entry["name"] for entry in listed["scenarios"]] == scenarios.names()
    assert all(entry["description"] for entry in listed["scenarios"])
    assert [entry["name"] for entry in listed["campaigns"]] == CAMPAIGNS.names()
    assert all(entry["description"] for entry in listed["campaigns"])
    assert listed["robots"] == robots.names()
    checked = json.loads(onorbit("check", reach, "--json").stdout)
    assert checked["ok"] is True
    assert (checked["orbit"], checked["environment"]) == ("kepler", ["gravity_gradient"])
    assert checked["duration_s"] == 0.1 and len(checked["joints"]) == 7
    assert checked["engine"] == "native"


def test_check_says_which_engine_would_run(reach: Path) -> None:
    assert onorbit("check", reach).stdout.splitlines()[0].endswith("s with rk4")
    pytest.importorskip("mujoco", reason="MuJoCo is not installed: pip install 'onorbit-rs[mujoco]'")
    reach.write_text(reach.read_text() + "\nengine: mujoco\n")
    assert onorbit("check", reach).stdout.splitlines()[0].endswith("s with rk4 on mujoco")
    assert json.loads(onorbit("check", reach, "--json").stdout)["engine"] == "mujoco"


def test_an_error_leaves_stdout_empty_for_programs(tmp_path: Path) -> None:
    for arguments in (("run", "no_such"), ("check", "no_such"), ("show", "nowhere"), ("report", "nowhere")):
        done = onorbit(*arguments, "--json", cwd=tmp_path)
        assert (done.returncode, done.stdout) == (2, "")
        assert len(done.stderr.splitlines()) == 1


@pytest.mark.usefixtures("no_pictures")
def test_quiet_prints_nothing(spin: Path) -> None:
    for arguments in (
        ("check", "mine.yaml"),
        ("run", "mine.yaml", "--out", "out"),
        ("report", "out", "--no-pdf"),
        ("new", "ets_vii", "--out", "new.yaml"),
    ):
        done = onorbit(*arguments, "--quiet", cwd=spin.parent)
        assert (done.returncode, done.stdout, done.stderr) == (0, "", ""), arguments


@pytest.mark.usefixtures("no_pictures")
def test_every_command_suggests_the_next(spin: Path) -> None:
    folder = spin.parent
    assert "next: onorbit run mine.yaml --out DIR" in onorbit("check", "mine.yaml", cwd=folder).stdout
    ran = onorbit("run", "mine.yaml", "--out", "a b", cwd=folder).stdout
    assert "next: onorbit show 'a b'" in ran and "onorbit report 'a b'" in ran
    reported = onorbit("report", "a b", "--no-pdf", cwd=folder).stdout
    assert "report: a b/report.html" in reported and "next: open it in a browser" in reported
    assert "next: onorbit new ets_vii --out FILE" in onorbit("info", "ets_vii").stdout
    shown = onorbit("show", "a b", "--no-viewer", cwd=folder).stdout
    assert "report.html" in shown


def test_lines_in_a_pipe_are_not_wrapped() -> None:
    lines = onorbit("list").stdout.splitlines()
    for name in scenarios.names():
        (line,) = [line for line in lines if line.split()[:1] == [name]]
        assert line.rstrip().endswith(".")
    assert "\x1b" not in "".join(lines)


def test_a_terminal_shows_progress_in_colour(spin: Path) -> None:
    code, written = on_terminal("run", spin, "--out", spin.parent / "out", cwd=spin.parent)
    assert code == 0, written
    assert COLOR.search(written)
    assert "drawing" in written and "recording" in written
    assert "certificate passed" in written


def test_no_color_and_dumb_terminals_get_no_colour(reach: Path) -> None:
    for environment, arguments in (
        ({"NO_COLOR": "1"}, ("run", reach)),
        ({"NO_COLOR": "1"}, ("run", "no_such")),
        ({"TERM": "dumb"}, ("list",)),
        ({"TERM": "dumb"}, ("run", "no_such")),
    ):
        _, written = on_terminal(*arguments, cwd=reach.parent, **environment)
        assert not COLOR.search(written), (environment, written)
    code, written = on_terminal("run", "no_such", cwd=reach.parent)
    assert code == 2 and COLOR.search(written) and "onorbit:" in written


def test_quiet_on_a_terminal_shows_no_bar(reach: Path) -> None:
    assert on_terminal("run", reach, "--quiet", cwd=reach.parent) == (0, "")


class Bar:
    """Records the calls of rich's progress bar."""

    def __init__(self) -> None:
        self.updates: list[dict[str, Any]] = []

    def reset(self, task: int, **updates: Any) -> None:
        self.updates.append(updates)

    def update(self, task: int, **updates: Any) -> None:
        self.updates.append(updates)


def test_the_speed_of_a_resumed_run_excludes_earlier_time(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = iter([100.0, 102.0])
    monkeypatch.setattr(progress.time, "perf_counter", lambda: next(clock))
    bar = Bar()
    move = progress._Mover(bar, 0)
    move(5000.0, 6000.0)  # stopped at 5000 s
    move(5010.0, 6000.0)  # 10 s of simulation in 2 s
    assert bar.updates[0] == {"completed": 5000.0, "total": 6000.0, "start": True}
    assert bar.updates[1]["doing"] == "t = 5000 / 6000 s"
    assert bar.updates[-1] == {"completed": 5010.0, "doing": "t = 5010 / 6000 s, 5x real time"}


@pytest.mark.parametrize(
    ("words", "offered", "not_offered"),
    [
        ("run hum", {"humanoid_reach"}, {"dual_arm_reach", "humanoid_torso"}),
        ("check ", {*scenarios.names(), "mine.yaml", "folder/"}, {"robot.urdf", ".hidden.yaml"}),
        ("run folder/", {"folder/inner.yml"}, {"mine.yaml"}),
        ("new ", {*robots.names(), "robot.urdf"}, {"mine.yaml"}),
        ("info humanoid_d", {"humanoid_dual_arm"}, {"humanoid_torso"}),
        ("rep", {"report"}, {"run"}),
    ],
)
def test_the_shell_completes_names_and_files(
    words: str, offered: set[str], not_offered: set[str], tmp_path: Path
) -> None:
    (tmp_path / "folder").mkdir()
    for name in ("mine.yaml", "robot.urdf", ".hidden.yaml", "folder/inner.yml"):
        (tmp_path / name).touch()
    line = f"onorbit {words}"
    asked = {"_ONORBIT_COMPLETE": "complete_bash", "COMP_WORDS": line, "COMP_CWORD": str(line.count(" "))}
    done = subprocess.run(
        [sys.executable, "-m", "onorbit_rs"], capture_output=True, text=True, cwd=tmp_path, timeout=60,
        env=os.environ | asked, check=False,
    )  # fmt: skip
    answers = set(done.stdout.split())
    assert offered <= answers and not answers & not_offered, done


def test_bad_arguments_of_report_are_reported_in_one_line(tmp_path: Path) -> None:
    assert "no such folder" in refusal("report", tmp_path / "nowhere")
    assert "no run in this folder" in refusal("report", tmp_path)
    assert "DIR" in refusal("report")
