"""Campaigns whose workers are killed, by a case or at random; no case may be lost or repeated."""

from __future__ import annotations

import os
import random
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import psutil
import pytest
from campaign_files import BODY, campaign_of, same

from onorbit_rs.campaigns import run as campaign_run

LAW = """
import os, signal
from pathlib import Path
import numpy as np

class Law:
    def __init__(self, folder, draw, share):
        self.marker, self.kills, self.calls = Path(folder) / f"{draw!r}", draw < share, 0

    def update(self, t, state):
        self.calls += 1
        if self.kills and self.calls == 3 and not self.marker.exists():
            self.marker.touch()
            os.kill(os.getpid(), signal.SIGKILL)
        return np.zeros(len(state.joints))
"""
"""A controller that kills the worker in the middle of some cases, the first time that they run."""


def check_killed_workers(
    folder: Path, cases: int, run: Callable[[dict[str, Any]], Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Runs a campaign in which 1 of 40 cases, and at least two, kill their worker when they first run.

    The draws of a Latin hypercube are in intervals of equal width, so that their number below ``share`` is
    known.
    """
    (folder / "law.py").write_text(LAW)
    markers = folder / "markers"
    markers.mkdir()
    deaths = max(2, cases // 40)
    share = deaths / cases
    controller = {"kind": "python", "file": str(folder / "law.py"), "class": "Law"}
    controller["arguments"] = {"folder": str(markers), "draw": 1.0, "share": share}
    scenario = BODY | {"robot": "humanoid_torso", "controller": controller}
    scenario |= {"simulation": {"duration": 5e-3, "time_step": 1e-3}}
    vary = {
        "controller.arguments.draw": {"set": {"uniform": [0.0, 1.0]}},
        "initial.angular_velocity": {"add": {"normal": [0.0, "1 deg/s"]}},
    }
    campaign = campaign_of(scenario, vary, cases)
    campaign["campaign"]["sampling"] = "latin_hypercube"
    seen = recorded(monkeypatch)
    table = run(campaign)
    draws = table["controller.arguments.draw"].to_pylist()
    killers = {repr(draw) for draw in draws if draw < share}
    assert {marker.name for marker in markers.iterdir()} == killers
    print(f"{len(killers)} workers killed during {cases} cases")
    assert len(killers) == deaths
    assert sorted(seen) == list(range(cases)), "no case is lost, and none is recorded twice"
    with monkeypatch.context() as patched:  # the markers exist, so no case kills this process
        patched.setattr(campaign_run, "on_processes", campaign_run.on_threads)
        assert same(table).equals(same(campaign_run.campaign(campaign)))


SLOW = """
import time
import numpy as np

class Law:
    def __init__(self, pause):
        self.pause = pause

    def update(self, t, state):
        time.sleep(self.pause)
        return np.zeros(len(state.joints))
"""
"""A controller that makes a case of five steps last about 0.1 s."""


def check_random_kills(
    folder: Path,
    cases: int,
    run: Callable[[dict[str, Any]], Any],
    workers: Callable[[], list[psutil.Process]],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Runs a campaign during which random workers are killed at random instants."""
    (folder / "slow.py").write_text(SLOW)
    seen = recorded(monkeypatch)
    with killing(workers, most=max(1, cases // 20)) as killed:
        table = run(_slow(folder, cases, pause=0.02))
    print(f"{len(killed)} workers killed at random during {cases} cases")
    assert killed
    assert sorted(seen) == list(range(cases)), "no case is lost, and none is recorded twice"
    with monkeypatch.context() as patched:
        patched.setattr(campaign_run, "on_processes", campaign_run.on_threads)
        expected = same(campaign_run.campaign(_slow(folder, cases, pause=0.0)))
    assert same(table).equals(expected)
    assert set(table["status"].to_pylist()) == {"complete"}


def _slow(folder: Path, cases: int, pause: float) -> dict[str, Any]:
    controller = {"kind": "python", "file": str(folder / "slow.py"), "class": "Law"}
    scenario = BODY | {"robot": "humanoid_torso", "controller": controller | {"arguments": {"pause": pause}}}
    scenario |= {"simulation": {"duration": 5e-3, "time_step": 1e-3}}
    return campaign_of(scenario, {"initial.angular_velocity": {"add": {"normal": [0.0, "1 deg/s"]}}}, cases)


@contextmanager
def killing(workers: Callable[[], list[psutil.Process]], most: int) -> Iterator[list[int]]:
    """Kills up to ``most`` random workers during the block, one every 1.3 s on average.

    Yields the list of their process numbers.
    """
    killed: list[int] = []
    is_over, chance = threading.Event(), random.Random(20261128)

    def kill() -> None:
        while len(killed) < most and not is_over.wait(0.3 + chance.expovariate(1.0)):
            with suppress(psutil.Error, IndexError):  # it has just ended, or none has started
                victim = chance.choice(workers())
                if victim.status() != psutil.STATUS_ZOMBIE:
                    victim.kill()
                    killed.append(victim.pid)

    thread = threading.Thread(target=kill)
    thread.start()
    try:
        yield killed
    finally:
        is_over.set()
        thread.join()


def recorded(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Returns a list to which the number of every recorded case is added."""
    seen: list[int] = []
    original = campaign_run.CampaignFolder.add

    def add(self: Any, outcome: Any) -> None:
        seen.append(outcome.case)
        original(self, outcome)

    monkeypatch.setattr(campaign_run.CampaignFolder, "add", add)
    return seen


def number_of_cases(usual: int) -> int:
    """Returns the environment variable CASES; ``make test-campaign`` uses 1000."""
    return int(os.environ.get("CASES", str(usual)))
