"""A run with many rows writes them to its folder while it is computed: the same bits, with bounded memory."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from run_files import SHORT, columns_of, plain, stream_all, without_times

import onorbit_rs as oo
from onorbit_rs.exceptions import RunInterrupted
from onorbit_rs.output import checkpoint as checkpoints
from onorbit_rs.output.streamed_trace import StreamedTrace, StreamedWorldTrace
from onorbit_rs.simulation import streaming
from onorbit_rs.simulation.world_columns import WorldColumns

# a block that hangs, because the end of an advance is rounded, fails at once
pytestmark = [pytest.mark.timeout(60), pytest.mark.filterwarnings("ignore:event .* did not happen")]


@pytest.mark.parametrize(
    ("name", "changes"),
    [
        ("humanoid_reach", SHORT),
        ("humanoid_reach", SHORT | {"simulation.record_every": 2}),
        ("humanoid_reach", SHORT | {"simulation.integrator": "dormand_prince"}),
        ("free_tumble", SHORT),
        ("parallel_gripper", SHORT),
        ("two_spheres", SHORT),
        ("release_and_retreat", {"simulation.record_every": 1, "simulation.duration": "6 s"}),
        ("formation", {"simulation.record_every": 1}),
    ],
)
def test_a_streamed_run_has_the_bits_of_a_run_in_memory(
    name: str, changes: dict[str, Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = plain(name, tmp_path / "memory", changes=changes)
    stream_all(monkeypatch)
    run = plain(name, tmp_path / "disk", changes=changes)
    assert isinstance(run.trace, StreamedTrace | StreamedWorldTrace)
    assert columns_of(tmp_path / "disk") == columns_of(tmp_path / "memory")
    assert without_times(run.summary) == without_times(whole.summary)
    assert run.trace.certificate() == whole.trace.certificate()
    assert not (tmp_path / "disk" / "checkpoint").exists()
    assert len(pickle.loads(pickle.dumps(run.trace))) == len(whole.trace) == len(run.trace)


def test_a_lost_row_changes_the_certificate(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Without the checks of removed rows, checks are missing: the comparison above can fail."""
    simulation = oo.scenario.build.build(oo.scenario.load("humanoid_reach", changes=SHORT)).simulation
    stepper = simulation.start(duration=0.3)
    stepper.advance_to(0.2)
    stepper.drop_rows(64)
    stepper.advance_to(0.3)
    assert stepper.finish().certificate() != simulation.run(0.3).certificate()


@pytest.mark.parametrize(
    ("name", "changes", "stop_s"),
    [
        ("humanoid_reach", SHORT, 0.17),
        ("two_spheres", SHORT, 0.2),
        ("formation", {"simulation.record_every": 1}, 2500.0),
        ("release_and_retreat", {"simulation.record_every": 1, "simulation.duration": "6 s"}, 4.0),
    ],
)
def test_an_interrupted_run_keeps_its_rows_and_resumes_with_the_same_bits(
    name: str, changes: dict[str, Any], stop_s: float, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    plain(name, tmp_path / "whole", changes=changes)
    whole = columns_of(tmp_path / "whole")
    stream_all(monkeypatch, block=60)
    out = tmp_path / "out"
    stop = interrupted(name, out, changes, stop_s, monkeypatch)
    assert len(stop.trace) > 100
    with np.load(out / "trace.npz") as part:
        for path in part.files:
            if (
                path.rpartition("/")[2] == "time" and path != "events/time"
            ):  # the last row is at the time of the interruption
                rows = part[path][:-1].tobytes()
                assert whole[path][1].startswith(rows) and rows
    run = oo.resume(out, quiet=True, figures=False, recording=False)
    assert columns_of(out) == whole
    assert not (out / "checkpoint").exists()
    traces = [run.trace] if name == "humanoid_reach" else run.trace.systems.values()
    assert all(len(trace.ending) < 60 + 64 + 10 < len(trace) for trace in traces), "few rows are in memory"


def interrupted(
    name: str, out: Path, changes: dict[str, Any], stop_s: float, monkeypatch: pytest.MonkeyPatch
) -> RunInterrupted:
    """Returns the exception of a run that is interrupted after ``stop_s``."""
    apply_due = streaming.Queue.apply_due

    def interrupt(queue: streaming.Queue, stepper: oo.Stepper) -> None:
        apply_due(queue, stepper)
        if stepper.time > stop_s:
            raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(streaming.Queue, "apply_due", interrupt)
        with pytest.raises(RunInterrupted, match="continue with: onorbit resume") as stop:
            plain(name, out, changes=changes)
    return stop.value


@pytest.mark.parametrize("is_stale", [False, True])
def test_a_world_without_columns_of_all_systems_resumes_with_all_rows(
    is_stale: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Checkpoints of runs in memory lack these columns, or have them only up to an earlier time."""
    plain("two_spheres", tmp_path / "whole", changes=SHORT)
    stream_all(monkeypatch, block=60)

    def write(self: WorldColumns, in_memory: dict[str, int], kept: int) -> bool:
        return is_stale and kept > 16 and original(self, in_memory, kept)

    original = WorldColumns.write
    with monkeypatch.context() as patch:
        patch.setattr(WorldColumns, "write", write)
        interrupted("two_spheres", tmp_path / "out", SHORT, 0.2, monkeypatch)
    started = []
    start = streaming.is_bounded
    monkeypatch.setattr(streaming, "is_bounded", lambda *given: started.append(start(*given)) or started[-1])
    oo.resume(tmp_path / "out", quiet=True, figures=False, recording=False)
    assert started == [False]
    assert columns_of(tmp_path / "out") == columns_of(tmp_path / "whole")


def test_rows_that_cannot_be_written_stay_in_memory_until_they_can(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    plain("humanoid_reach", tmp_path / "whole", changes=SHORT)
    stream_all(monkeypatch, block=60)
    append, failed = checkpoints._append, []

    def full_at_first(file: Path, content: bytes, *, after: int, sync: bool) -> None:
        if file.name == "q.f64" and len(failed) < 2:
            failed.append(append(file, content[:100], after=after, sync=sync))
            raise OSError(28, "No space left on device")
        append(file, content, after=after, sync=sync)

    monkeypatch.setattr(checkpoints, "_append", full_at_first)
    with pytest.warns(UserWarning, match="No space left on device") as caught:
        plain("humanoid_reach", tmp_path / "out", changes=SHORT)
    assert len(caught) == 1 and len(failed) == 2
    assert columns_of(tmp_path / "out") == columns_of(tmp_path / "whole")


def test_few_rows_stay_in_memory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    stream_all(monkeypatch, block=50)
    run = plain("free_tumble", tmp_path / "out", changes=SHORT)
    assert len(run.trace) == 301
    assert len(run.trace.ending) <= 50 + 64 + 1
