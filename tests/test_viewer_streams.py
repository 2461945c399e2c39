"""Recordings release rerun's threads and memory; each once leaked four threads and 4.5 MB."""

from __future__ import annotations

import sys
import time
from pathlib import Path

import pytest
import rerun as rr

import onorbit_rs as oo
from onorbit_rs import viewer
from onorbit_rs.scenario import Scenario, load
from onorbit_rs.scenario.build import Built, build
from onorbit_rs.viewer.live import LiveView

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="threads and memory are read from /proc")


def rerun_threads() -> int:
    """Return the number of threads that rerun has started for its streams in this process."""
    return sum(
        _name(task).startswith(("RecordingStream", "ChunkBatcher"))
        for task in Path("/proc/self/task").iterdir()
    )


def _name(task: Path) -> str:
    try:
        return (task / "comm").read_text()
    except OSError:  # the thread has ended since the folder was listed
        return ""


def assert_no_more_threads_than(before: int) -> None:
    """Fail unless rerun's threads end; released threads end soon, but not at once, and leaked ones never."""
    end = time.monotonic() + 10.0
    while rerun_threads() > before and time.monotonic() < end:
        time.sleep(0.01)
    assert rerun_threads() <= before


def resident_mb() -> float:
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * 4096 / 1e6


def humanoid(duration: float = 0.5) -> Built:
    data = load("humanoid_reach").resolved()
    data["simulation"] |= {"duration": duration, "time_step": 1e-3}
    return build(Scenario(**data))


def test_ten_recordings_leak_neither_threads_nor_memory(tmp_path: Path) -> None:
    built = humanoid()
    trace, setting = built.simulation.run(0.5), viewer.Setting.of(built)
    before = rerun_threads()
    resident = []
    for _ in range(14):
        viewer.write_recording(tmp_path / "run.rrd", trace, setting)
        assert_no_more_threads_than(before)
        resident.append(resident_mb())
    grown = min(resident[-4:]) - max(resident[:4])  # after ten recordings, which once leaked 45 MB
    assert grown < 10.0, resident


def test_a_stream_in_use_is_not_released_by_another_recording(tmp_path: Path) -> None:
    mine = rr.RecordingStream("mine", send_properties=False)
    mine.save(tmp_path / "mine.rrd")
    mine.log("before", rr.TextDocument("one"))
    oo.run({"robot": {"rigid_body": {"mass": 1, "inertia": [1, 2, 3]}}, "simulation": {"duration": 0.1}},
           tmp_path / "out", quiet=True)  # fmt: skip
    mine.log("after", rr.TextDocument("two"))
    mine.flush()
    mine.disconnect()
    text = (tmp_path / "mine.rrd").read_bytes()
    assert b"before" in text and b"after" in text


def test_a_live_view_leaks_no_thread(tmp_path: Path) -> None:
    built = humanoid()
    before = rerun_threads()
    for k in range(3):
        recording = rr.RecordingStream("onorbit", send_properties=False)
        recording.save(tmp_path / f"{k}.rrd")
        view = LiveView(recording, viewer.Setting.of(built), 0.5)
        del recording
        view.finish(built.simulation.run(0.5, checkpoint=lambda c, v=view: v.take(c.columns)))
        assert_no_more_threads_than(before)
