"""A killed or interrupted run is resumed from its folder with the same bits."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.exceptions import CheckpointError, NotFoundError, RunInterrupted
from onorbit_rs.output.names import NAMES
from onorbit_rs.output.sealed import sealed, unsealed
from onorbit_rs.scenario import load


@pytest.fixture(autouse=True)
def without_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    """Turns off figures in this process; runs on the command line still draw them."""
    monkeypatch.setattr("onorbit_rs.simulation.finish.write_pictures", lambda *_, **__: None)


def long_reach(duration: float = 8.0, **simulation: Any) -> dict[str, Any]:
    data = load("humanoid_reach").resolved()
    data["simulation"] |= {"duration": duration, "time_step": 1e-4} | simulation
    return data


def scenario_file(folder: Path, data: dict[str, Any]) -> Path:
    file = folder / "mine.yaml"
    file.write_text(json.dumps(data))  # JSON is YAML
    return file


def wait_for(path: Path, process: subprocess.Popen[bytes]) -> None:
    for _ in range(2000):
        if path.exists() or process.poll() is not None:
            return
        time.sleep(0.01)


def stopped_run(tmp_path: Path, data: dict[str, Any], how: signal.Signals) -> Path:
    """Returns the folder of a run that a signal ended after its first checkpoint."""
    out = tmp_path / "out"
    command = [
        sys.executable,
        "-m",
        "onorbit_rs",
        "run",
        str(scenario_file(tmp_path, data)),
        "--out",
        str(out),
    ]
    process = subprocess.Popen([*command, "--checkpoint-every", "0.1"], stderr=subprocess.PIPE)
    wait_for(out / "checkpoint" / "state.json", process)
    process.send_signal(how)
    process.communicate(timeout=60)
    assert process.returncode not in (0, None), "the run ended before it could be stopped"
    return out


def rows_of(out: Path, column: str = "time") -> int:
    """Returns the number of rows of a column in the checkpoint of a folder."""
    rows: int = json.loads((out / "checkpoint" / "state.json").read_text())["columns"][column]["rows"]
    return rows


def assert_same_trace(out: Path, whole: oo.Run) -> None:
    with np.load(out / "trace.npz") as stored:
        assert set(stored.files) == {*whole.trace.columns(), *NAMES}
        for name in NAMES:
            assert stored[name].tolist() == list(getattr(whole.model, name)), name
        for name in whole.trace.columns():
            assert stored[name].tobytes() == np.asarray(getattr(whole.trace, name)).tobytes(), name


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGINT])
def test_a_resumed_run_has_the_same_bits(tmp_path: Path, how: signal.Signals) -> None:
    data = long_reach(record_every=3)
    whole = oo.run(data, quiet=True)
    out = stopped_run(tmp_path, data, how)
    rows = rows_of(out)
    assert 0 < rows < len(whole.trace)
    again = oo.resume(out, quiet=True)
    assert_same_trace(out, whole)
    assert again.trace.certificate() == whole.trace.certificate()
    assert again.summary["status"] == "complete"
    assert not (out / "checkpoint").exists()
    assert json.loads((out / "summary.json").read_text())["rows"] == len(whole.trace)


def test_a_run_killed_twice_and_while_rows_were_written_has_the_same_bits(tmp_path: Path) -> None:
    data = long_reach()
    out = stopped_run(tmp_path, data, signal.SIGKILL)
    with (out / "checkpoint" / "q.f64").open("ab") as stream:  # rows not included in the state's count
        stream.write(b"\x7f" * 1001)
    first = rows_of(out)
    command = [sys.executable, "-m", "onorbit_rs", "resume", str(out), "--checkpoint-every", "0"]
    process = subprocess.Popen(command, stderr=subprocess.PIPE)
    while rows_of(out) == first:
        assert process.poll() is None, "ended before a second checkpoint"
        time.sleep(0.01)
    process.kill()
    process.communicate(timeout=60)
    oo.resume(out, quiet=True)
    assert_same_trace(out, oo.run(data, quiet=True))


def test_checkpoints_in_python() -> None:
    """Without a folder, checkpoints are passed from one run to the next."""
    model = oo.robots.load("humanoid_torso")
    v = np.full(model.nv, 0.02)
    simulation = oo.Simulation(model, model.neutral(), v, time_step=1e-4)
    kept: list[oo.Checkpoint] = []

    def stop(t: float, duration: float) -> None:
        if len(kept) == 2:
            raise KeyboardInterrupt

    with pytest.raises(RunInterrupted):
        simulation.run(20.0, progress=stop, checkpoint=kept.append, checkpoint_every=0.0)
    names = kept[0].columns
    columns = {name: np.concatenate([part.columns[name] for part in kept]) for name in names}
    last = oo.Checkpoint(kept[-1].state, columns, wall_s=kept[-1].wall_s)
    rest, whole = simulation.run(20.0, resume=last), simulation.run(20.0)
    assert rest.q.tobytes() == whole.q.tobytes() and rest.v.tobytes() == whole.v.tobytes()
    assert rest.wall_s > last.wall_s > 0.0
    assert "rows" in repr(last)


@pytest.fixture(scope="module")
def killed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return stopped_run(tmp_path_factory.mktemp("killed"), long_reach(), signal.SIGKILL)


def state_of(out: Path) -> dict[str, Any]:
    return unsealed((out / "checkpoint" / "state.json").read_bytes())


def first_tree(record: Any) -> Any:
    """Return the state of the first tree of the engine's state."""
    return record["engine"]["groups"][0]["progress"]["state"]["trees"][0]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda out, record: (out / "scenario.yaml").write_text(
            (out / "scenario.yaml").read_text().replace("kp: 100", "kp: 101")), "another scenario"),
        (lambda out, record: record["engine"].update(version="0.0.1"), "version 0.0.1"),
        (lambda out, record: record["engine"].update(instruction_set="sse9"), "ONORBIT_INSTRUCTION_SET=sse9"),
        (lambda out, record: record.pop("columns"), "damaged"),
        (lambda out, record: first_tree(record).pop("q"), "damaged"),
        (lambda out, record: record["columns"]["q"].update(width=13), "checksum"),
        (lambda out, record: record["columns"]["q"].pop("sha256"), "damaged"),
        (lambda out, record: record["columns"]["q"].update(rows=10**17), "damaged.*expected"),
        (lambda out, record: record.update(columns={"../../out/checkpoint/v": {"rows": 1, "width": 3}}),
         "No such file"),
        (lambda out, record: (out / "checkpoint" / "v.f64").write_bytes(b"short"), "v.f64"),
        (lambda out, record: (out / "checkpoint" / "v.f64").unlink(), "damaged"),
    ],
)  # fmt: skip
def test_runs_that_cannot_be_resumed_are_rejected(
    killed: Path, tmp_path: Path, change: Any, words: str
) -> None:
    out = tmp_path / "copy"
    subprocess.run(["cp", "-r", str(killed), str(out)], check=True)
    record = state_of(out)
    change(out, record)
    (out / "checkpoint" / "state.json").write_bytes(sealed(record))
    with pytest.raises(CheckpointError, match=words) as caught:
        oo.resume(out, quiet=True)
    assert isinstance(caught.value, ValueError)
    assert (out / "checkpoint" / "state.json").exists()  # the checkpoint is kept


def test_folders_without_a_checkpoint(tmp_path: Path) -> None:
    with pytest.raises(NotFoundError, match="is a file, but the output folder of a run is required"):
        oo.resume(__file__)
    with pytest.raises(NotFoundError, match="no such folder"):
        oo.resume(tmp_path / "none")
    with pytest.raises(NotFoundError, match="no run in this folder"):
        oo.resume(tmp_path)
    out = tmp_path / "out"
    oo.run(long_reach(0.01), out=out, quiet=True)
    with pytest.raises(CheckpointError, match="the run is complete"):
        oo.resume(out)


def test_a_new_run_in_the_folder_removes_the_checkpoint(killed: Path, tmp_path: Path) -> None:
    out = tmp_path / "copy"
    subprocess.run(["cp", "-r", str(killed), str(out)], check=True)
    oo.run(long_reach(0.01), out=out, force=True, quiet=True)
    assert not (out / "checkpoint").exists()
