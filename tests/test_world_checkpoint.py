"""A killed or interrupted run of a world is resumed with the bits of an uninterrupted one."""

from __future__ import annotations

import copy
import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from world_runs import data

import onorbit_rs as oo
from onorbit_rs.exceptions import CheckpointError, InputError, RunInterrupted, WorldError
from onorbit_rs.output.read import SavedRun
from onorbit_rs.output.sealed import sealed, unsealed

pytestmark = pytest.mark.usefixtures("no_pictures")

SCENARIO = data(simulation={"duration": "4 s", "time_step": "100 us", "record_every": 100})
SCENARIO["systems"] = {
    "chaser": SCENARIO["systems"]["chaser"],
    "witness": {"robot": "humanoid_torso", "initial": {"position": [0, 100, 0], "joint_rates": [0.1] * 7}},
    "target": SCENARIO["systems"]["target"],
}
SCENARIO["events"][0]["when"] = {"latch": {"within": ["5 cm", "2 deg"], "held_for": "1 s"}}
SCENARIO["events"][1]["when"]["delay"] = "2 s"
"""The latch is held for 1 s, and the craft are connected until 3 s; ``witness`` is another group."""

SEATED = copy.deepcopy(SCENARIO)
SEATED["events"][0]["do"] |= {"seat": "1.5 s"}
"""The same with a seating from 1 s to 2.5 s."""

PROGRAM = """
import json, os, signal, sys
import onorbit_rs as oo
from onorbit_rs.output import CheckpointWriter
from onorbit_rs.simulation import finish

scenario, out, stop, how = sys.argv[1:]
finish.write_pictures = lambda *_, **__: None
write = CheckpointWriter.__call__

def stopped(writer, checkpoint):
    done = write(writer, checkpoint)
    if json.loads(checkpoint.state)["groups"][0]["time"] >= float(stop):
        os.kill(os.getpid(), getattr(signal, how))
    return done

CheckpointWriter.__call__ = stopped
if scenario == "resume":
    oo.resume(out, quiet=True, checkpoint_every=0.0)
else:
    oo.run(json.loads(scenario), out, quiet=True, checkpoint_every=0.0)
"""
"""Stops itself by a signal after the first checkpoint from a given time on."""


def stopped_at(
    out: Path,
    time: float,
    how: str,
    *,
    scenario: dict[str, Any] = SCENARIO,
    resumes: bool = False,
    threads: int = 1,
) -> dict[str, Any]:
    """Runs or resumes the scenario until a signal stops the process; returns the state of the first group."""
    source = "resume" if resumes else json.dumps(scenario)
    command = [sys.executable, "-c", PROGRAM, source, str(out), str(time), how]
    done = subprocess.run(
        command, env=dict(os.environ) | {"RAYON_NUM_THREADS": str(threads)}, capture_output=True, text=True,
        timeout=300, check=False,
    )  # fmt: skip
    assert done.returncode == (-9 if how == "SIGKILL" else 1), done.stderr
    group: dict[str, Any] = state_of(out)["engine"]["groups"][0]
    assert group["time"] >= time
    return group


def state_of(out: Path) -> dict[str, Any]:
    return unsealed((out / "checkpoint" / "state.json").read_bytes())


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Returns the folder of an uninterrupted run."""
    out = tmp_path_factory.mktemp("whole") / "out"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("onorbit_rs.simulation.finish.write_pictures", lambda *_, **__: None)
        oo.run(SCENARIO, out, quiet=True)
    return out


def test_a_world_killed_during_a_seating_has_the_bits_of_an_uninterrupted_run(tmp_path: Path) -> None:
    whole, out = tmp_path / "whole", tmp_path / "out"
    oo.run(SEATED, whole, quiet=True)
    for time, resumes in ((1.3, False), (2.0, True)):
        world = stopped_at(out, time, "SIGKILL", scenario=SEATED, resumes=resumes)["progress"]["world"]
        (weld,) = world["members"]["active"]["welds"]
        start = weld["seating"]["start"]
        assert 0.99 < start < time < start + weld["seating"]["duration"]
    oo.resume(out, quiet=True)
    assert_same_results(out, whole)


def without_clock(value: Any) -> Any:
    """Returns a summary without wall-clock times."""
    if isinstance(value, dict):
        return {key: without_clock(entry) for key, entry in value.items()
                if key not in ("wall_s", "real_time_factor")}  # fmt: skip
    return value


def assert_same_results(out: Path, whole: Path) -> None:
    with np.load(out / "trace.npz") as found, np.load(whole / "trace.npz") as expected:
        assert found.files == expected.files
        for name in expected.files:
            assert found[name].tobytes() == expected[name].tobytes(), name
    summaries = [without_clock(SavedRun(folder).summary()) for folder in (out, whole)]
    assert summaries[0] == summaries[1]
    assert summaries[0]["certificate_passed"], summaries[0]["certificate_failures"]
    assert [event["name"] for event in summaries[0]["events"]] == ["grasp", "let_go"]
    assert not (out / "checkpoint").exists()


def test_a_world_killed_in_every_phase_has_the_bits_of_an_uninterrupted_run(
    tmp_path: Path, whole: Path
) -> None:
    """Killed while the latch is half held, while the craft are connected, and after their release."""
    out = tmp_path / "out"
    held = stopped_at(out, 0.3, "SIGKILL")["progress"]["world"]
    assert held["events"][0]["is_held"] and held["events"][0]["happened"] is None and not held["records"]
    connected = stopped_at(out, 1.5, "SIGKILL", resumes=True, threads=2)["progress"]["world"]
    assert len(connected["members"]["active"]["welds"]) == len(connected["records"]) == 1
    released = stopped_at(out, 3.3, "SIGKILL", resumes=True)["progress"]["world"]
    assert not released["members"]["active"]["welds"] and len(released["records"]) == 2
    rows = {name: entry["rows"] for name, entry in state_of(out)["columns"].items()}
    assert (
        rows["chaser/time"] == rows["target/q"] != rows["witness/time"]
    )  # rows before and after both events
    run = oo.resume(out, quiet=True)
    assert_same_results(out, whole)
    assert isinstance(run.trace, oo.WorldTrace)
    assert run.trace.events == SavedRun(whole).world_trace().events


def test_a_world_stopped_by_ctrl_c_keeps_its_rows_and_resumes(tmp_path: Path, whole: Path) -> None:
    out = tmp_path / "out"
    stopped_at(out, 1.5, "SIGINT")
    saved = SavedRun(out)
    assert saved.summary()["status"] == "interrupted"
    assert [event.name for event in saved.world_trace().events] == ["grasp"]
    oo.resume(out, quiet=True)
    assert_same_results(out, whole)


@pytest.fixture(scope="module")
def killed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("killed") / "out"
    stopped_at(out, 1.5, "SIGKILL")
    return out


def first_weld(record: Any) -> Any:
    return record["engine"]["groups"][0]["progress"]["world"]["members"]["active"]["welds"][0]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda out, record: (out / "scenario.yaml").write_text(
            (out / "scenario.yaml").read_text().replace("kp: 1", "kp: 2")), "another scenario"),
        (lambda out, record: record["engine"]["groups"].pop(), "groups of systems"),
        (lambda out, record: first_weld(record)["by"].update(system=9), "frames of the run"),
        (lambda out, record: record["columns"].pop("target/v"), "0 entries for 'v'"),
        (lambda out, record: record["columns"]["target/time"].update(rows=1), "checksum"),
        (lambda out, record: (out / "checkpoint" / "witness%2Fq.f64").unlink(), "damaged"),
    ],
)  # fmt: skip
def test_worlds_that_cannot_be_resumed_are_rejected(
    killed: Path, tmp_path: Path, change: Any, words: str
) -> None:
    out = tmp_path / "copy"
    subprocess.run(["cp", "-r", str(killed), str(out)], check=True)
    record = state_of(out)
    change(out, record)
    (out / "checkpoint" / "state.json").write_bytes(sealed(record))
    with pytest.raises(CheckpointError, match=words):
        oo.resume(out, quiet=True)
    assert (out / "checkpoint" / "state.json").exists()


def two_arms() -> oo.Simulation:
    """Returns two systems that never interact; the control ticks of the second give it more rows."""
    model = oo.robots.load("humanoid_torso")
    law = oo.JointComputedTorque(kp=1.0, kd=2.0)
    q, v = model.neutral(), np.full(model.nv, 0.02)
    second = oo.System(
        "second", model, q, v, controller=law, reference=oo.JointHold(q[7:]), control_period=3e-4
    )
    return oo.Simulation(oo.World([oo.System("first", model, q, v), second]), time_step=2e-4)


def test_checkpoints_of_systems_with_different_rows() -> None:
    kept: list[oo.Checkpoint] = []

    def stop(t: float, duration: float) -> None:
        if len(kept) == 2:
            raise KeyboardInterrupt

    with pytest.raises(RunInterrupted):
        two_arms().run(20.0, progress=stop, checkpoint=kept.append, checkpoint_every=0.0)
    columns = {name: np.concatenate([part.columns[name] for part in kept]) for name in kept[0].columns}
    assert len(columns["first/time"]) < len(columns["second/time"])
    last = oo.Checkpoint(kept[-1].state, columns, wall_s=kept[-1].wall_s)
    end = json.loads(last.state)["groups"][0]["time"] + 0.1
    traces = []
    for resume in (last, None):
        stepper = two_arms().start(duration=20.0, resume=resume)
        stepper.advance_to(end)
        traces.append(stepper.finish())
    for name in ("first", "second"):
        for column in traces[0][name].columns():
            found, expected = (getattr(trace[name], column) for trace in traces)
            assert found.tobytes() == expected.tobytes(), (name, column)


def test_rows_are_returned_from_a_row_of_each_system_on() -> None:
    stepper = two_arms().start()
    stepper.advance_to(0.01)
    whole = stepper.columns()
    late = stepper.columns({"second": 60})
    assert len(late["second/time"]) == len(whole["second/time"]) - 60
    assert len(late["first/time"]) == len(whole["first/time"])
    assert stepper.checkpoint(since={"first": 3}).columns["first/q"].shape == (len(whole["first/q"]) - 3, 14)
    with pytest.raises(InputError, match=r"since is 60, but system 'first' has 5. rows"):
        stepper.columns(60)
    with pytest.raises(WorldError, match="no system 'third'"):
        stepper.columns({"third": 0})
