"""Campaigns in processes: Python controllers, workers that are killed, cases that kill their worker."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import psutil
import pytest
from campaign_files import BODY, campaign_of, same, spin, write
from killed_workers import check_killed_workers, check_random_kills, number_of_cases

import onorbit_rs as oo
from onorbit_rs.campaigns import run as campaign_run
from onorbit_rs.campaigns.pool import Board
from onorbit_rs.exceptions import CampaignError

pytestmark = pytest.mark.usefixtures("no_campaign_report")

SPIN = {"initial.angular_velocity": {"add": {"normal": [0.0, 0.1]}}}
CONTROLLER = """
import os, signal
import numpy as np

class Law:
    def __init__(self, crashes=0.0, raises=0.0):
        self.crashes, self.raises = crashes, raises

    def update(self, t, state):
        print("noise of the user on standard output")
        if self.crashes:
            os.kill(os.getpid(), signal.SIGKILL)
        if self.raises:
            raise RuntimeError("no such thing")
        return np.zeros(len(state.joints))
"""


def with_law(folder: Path) -> dict[str, Any]:
    """Returns a scenario of one body with a controller in Python."""
    (folder / "law.py").write_text(CONTROLLER)
    controller = {
        "kind": "python",
        "file": str(folder / "law.py"),
        "class": "Law",
        "arguments": {"crashes": 0.0},
    }
    robot = {"robot": "humanoid_torso", "initial": {"angular_velocity": [0.1, 0.2, 0.3]}}
    return BODY | robot | {"controller": controller, "simulation": {"duration": 5e-3, "time_step": 1e-3}}


@contextmanager
def in_processes(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Runs campaigns in processes, although no Python code is in the loop."""
    with monkeypatch.context() as patched:
        patched.setattr(campaign_run, "on_threads", campaign_run.on_processes)
        yield


def workers() -> list[psutil.Process]:
    """Returns the worker processes of this process."""
    found = []
    for child in psutil.Process().children():
        try:
            if "onorbit_rs.campaigns.worker" in child.cmdline():
                found.append(child)
        except psutil.Error:  # it has just ended
            continue
    return found


def test_controllers_in_python_run_in_processes(tmp_path: Path) -> None:
    campaign = campaign_of(with_law(tmp_path), SPIN, 3)
    table = oo.campaign(campaign, workers=1)
    assert table["status"].to_pylist() == ["complete"] * 3
    run = oo.campaign_case(campaign, 1)
    assert run.summary["base_rotation_max_rad"] == table["base_rotation_max_rad"][1].as_py()
    assert not workers()


def test_processes_give_the_bits_of_threads(monkeypatch: pytest.MonkeyPatch) -> None:
    campaign = spin(keep={"columns": ["v"]})
    threads = oo.campaign(campaign)
    with in_processes(monkeypatch):
        assert same(oo.campaign(campaign, workers=2)).equals(same(threads))


def test_a_case_that_kills_its_worker_fails_alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("onorbit_rs.campaigns.pool.MOST_DEATHS", 2)
    vary = {"controller.arguments.crashes": {"set": {"choice": [0.0, 1.0]}}}
    table = oo.campaign(campaign_of(with_law(tmp_path), vary, 2, seed=0), workers=1)
    crashes = table["controller.arguments.crashes"].to_pylist()
    assert {*crashes} == {0.0, 1.0}
    expected = ["failed" if crash else "complete" for crash in crashes]
    assert table["status"].to_pylist() == expected
    error = next(filter(None, table["error"].to_pylist()))
    assert error == "the worker process was ended by SIGKILL, 2 times during this case"


def test_an_error_of_a_controller_is_kept(tmp_path: Path) -> None:
    scenario = with_law(tmp_path)
    scenario["controller"]["arguments"] = {"raises": 0.0}
    vary = {"controller.arguments.raises": {"set": {"choice": [1.0]}}}
    table = oo.campaign(campaign_of(scenario, vary, 2), workers=1)
    assert table["status"].to_pylist() == ["failed"] * 2
    assert "RuntimeError: no such thing" in table["error"][0].as_py()


def test_killed_workers_lose_no_case_and_repeat_none(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    check_killed_workers(
        tmp_path,
        number_of_cases(12),
        lambda campaign: oo.campaign(campaign, tmp_path / "out", workers=2),
        monkeypatch,
    )


def test_workers_killed_at_random_lose_no_case(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    check_random_kills(
        tmp_path,
        number_of_cases(30),
        lambda campaign: oo.campaign(campaign, tmp_path / "out", workers=2),
        workers,
        monkeypatch,
    )


def test_a_killed_campaign_continues(tmp_path: Path) -> None:
    campaign = spin(40)
    campaign["campaign"]["scenario"] = BODY | {"simulation": {"duration": 4.0, "time_step": 1e-3}}
    file, out = write(campaign, tmp_path / "spin.yaml"), tmp_path / "out"
    command = [sys.executable, "-m", "onorbit_rs", "campaign", str(file), "--out", str(out), "-q"]
    process = subprocess.Popen(command)
    parts: list[Path] = []
    end = time.monotonic() + 120
    while process.poll() is None and len(parts) < 1 and time.monotonic() < end:
        time.sleep(0.02)
        parts = list(out.glob("cases/part-*.json"))
    process.kill()
    process.wait()
    assert parts
    assert not (out / "cases.parquet").exists(), "the campaign ended before it was killed"
    table = oo.campaign(file, out)
    assert same(table).equals(same(oo.campaign(campaign)))


def test_the_workers_end_with_the_process_that_started_them(tmp_path: Path) -> None:
    scenario = with_law(tmp_path)
    scenario["simulation"] = {"duration": 1000.0, "time_step": 1e-3}
    file = write(campaign_of(scenario, SPIN, 2), tmp_path / "long.yaml")
    program = f"import onorbit_rs as oo; oo.campaign({str(file)!r}, workers=1)"
    process = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.DEVNULL)
    end = time.monotonic() + 120
    found: list[psutil.Process] = []
    while not found and time.monotonic() < end:
        time.sleep(0.05)
        found = psutil.Process(process.pid).children()
    process.send_signal(signal.SIGKILL)
    process.wait()
    gone, alive = psutil.wait_procs(found, timeout=60)
    assert gone
    assert not alive


def test_workers_that_never_start_end_the_campaign(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        "onorbit_rs.campaigns.on_processes._COMMAND", (sys.executable, "-c", "raise SystemExit(3)")
    )
    with in_processes(monkeypatch), pytest.raises(CampaignError, match="ended before they began a case"):
        oo.campaign(spin(), workers=1)


def test_a_board_hands_out_every_case_once() -> None:
    board = Board(range(10), 2)
    assert board.take() == [0]
    board.report(1e-3)
    taken = [0, *board.take()]
    assert board.give_back([0])
    assert board.take() == [0]
    while cases := board.take():
        taken += cases
    assert sorted(taken) == list(range(10))
