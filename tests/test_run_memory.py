"""The memory of a run is estimated before its start. Many rows are written to the folder during the run; if
they stay in memory, they cause a warning or, if they do not fit, an error.
"""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.exceptions import InputError, OutputFolderError
from onorbit_rs.output.pickling import arrays_of
from onorbit_rs.output.world import world_arrays
from onorbit_rs.scenario import WorldScenario, load
from onorbit_rs.scenario.build import build
from onorbit_rs.scenario.build_world import build_world
from onorbit_rs.simulation import memory

LONG = {"simulation.duration": "4000 s", "simulation.time_step": "1 ms"}
SHORT = {"simulation.duration": "0.2 s", "simulation.time_step": "2 ms"}


def built(name: str, changes: dict[str, Any]) -> Any:
    scenario = load(name, changes=changes)
    return build_world(scenario) if isinstance(scenario, WorldScenario) else build(scenario)


@pytest.mark.parametrize(
    "name", ["humanoid_reach", "free_tumble", "dual_arm_reach", "parallel_gripper", "two_spheres"]
)
def test_the_estimate_is_the_size_of_the_trace(name: str) -> None:
    run = built(name, SHORT)
    trace = run.simulation.run(0.2)
    arrays = world_arrays(trace) if isinstance(run.scenario, WorldScenario) else arrays_of(trace)
    size = sum(np.asarray(rows).nbytes for rows in arrays.values())
    assert memory.estimated_bytes(run) == pytest.approx(size, rel=0.1)
    sparse = built(name, SHORT | {"simulation.record_every": 10})
    assert memory.estimated_bytes(sparse) == pytest.approx(size / 10.0, rel=0.2)


def test_a_run_that_does_not_fit_is_refused_before_it_starts(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(memory, "_available_memory", lambda: 2e9)
    what = r"records 4000001 rows, about .* but 2 GB is available; give the run a folder \(--out DIR, or out="
    with pytest.raises(InputError, match=what) as error:
        oo.run("free_tumble", quiet=True, changes=LONG)
    assert error.value.name == "record_every" and error.value.got == 1
    with pytest.warns(UserWarning, match="its trace.npz will have about"):
        memory.check_size(built("free_tumble", LONG), tmp_path)  # the rows are not kept in memory
    with pytest.raises(InputError, match="but 2 GB is available; do not view the run"):
        memory.check_size(built("free_tumble", LONG), tmp_path, is_viewed=True)
    every = int(str(error.value.expected).removeprefix(">= "))
    fitting = built("free_tumble", LONG | {"simulation.record_every": every})
    assert memory.estimated_memory(fitting, has_folder=True) < 500e6
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        memory.check_size(fitting, tmp_path)  # the suggested value is accepted without a warning


def test_a_full_disk_is_noticed_before_the_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memory, "_available_memory", lambda: 1e12)
    usage = type("Usage", (), {"free": 1e9})
    monkeypatch.setattr(memory.shutil, "disk_usage", lambda path: usage)
    with pytest.raises(
        OutputFolderError,
        match=r"where 1 GB is available; delete files to make room, or set simulation.record_every to",
    ):
        memory.check_size(built("free_tumble", LONG), tmp_path)


def test_a_large_run_that_fits_causes_a_warning(monkeypatch: pytest.MonkeyPatch) -> None:
    run = built("free_tumble", LONG)
    for free in (1e12, None):
        monkeypatch.setattr(memory, "_available_memory", lambda free=free: free)
        with pytest.warns(
            UserWarning, match="GB of memory; give the run a folder .* set simulation.record_every to 50"
        ):
            memory.check_size(run, None)


@pytest.mark.parametrize(
    ("value", "rounded"), [(1.0, 1), (1.2, 2), (3.0, 5), (7.0, 10), (10.0, 10), (11.0, 20)]
)
def test_suggestions_are_round_numbers(value: float, rounded: int) -> None:
    assert memory._rounded_up(value) == rounded
