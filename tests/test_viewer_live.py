"""Live view of a run: rows are shown or decimated, and the viewer neither stops nor changes the run."""

from __future__ import annotations

import itertools
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rerun as rr
from recordings import FrameTree, column, rows_by_entity

import onorbit_rs as oo
from onorbit_rs import viewer
from onorbit_rs.scenario import Scenario, load
from onorbit_rs.scenario.build import Built, build
from onorbit_rs.simulation.live import watched
from onorbit_rs.viewer import live, screen
from onorbit_rs.viewer.live import LiveView
from onorbit_rs.viewer.series import ANGLES, Series
from onorbit_rs.viewer.trace_rows import TraceRows


def built_reach(**simulation: Any) -> Built:
    data = load("humanoid_reach").resolved()
    data["simulation"] |= {"duration": 4.0, "time_step": 1e-3} | simulation
    return build(Scenario(**data))


class Watched:
    """A run with a live view that writes to a file."""

    def __init__(self, folder: Path, built: Built, every_s: float = 0.05) -> None:
        self.path, self.columns = folder / "live.rrd", []
        recording = rr.RecordingStream("onorbit", send_properties=False)
        recording.save(self.path)
        self._live = LiveView(recording, viewer.Setting.of(built), 4.0)
        duration = built.scenario.simulation.duration
        self.trace = built.simulation.run(duration, checkpoint=self._take, checkpoint_every=every_s)
        self._live.finish(self.trace)

    def _take(self, checkpoint: oo.Checkpoint) -> None:
        self.columns.append(checkpoint.columns)
        self._live.take(checkpoint.columns)


def test_a_short_run_is_shown_completely_at_its_end(tmp_path: Path) -> None:
    built = built_reach(duration=0.3)
    watched = Watched(tmp_path, built, every_s=1e3)
    assert not watched.columns
    moving, static = rows_by_entity(watched.path)
    assert moving["/frames/robot/torso"] == moving["/plots/joint_torque"] == len(watched.trace) == 301
    assert moving["/world/tool/obtained/trail"] == moving["/world/tool/desired/trail"] == 300
    assert "/orbit/planet" in static and "/world/robot/torso/visual_0" in static
    poses = FrameTree(watched.path).pose("robot/tool")
    np.testing.assert_allclose(poses, watched.trace.tool_pose, atol=1e-6)


def test_a_long_run_is_sent_in_adjacent_parts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(live, "MOST_ROWS", 40)
    watched = Watched(tmp_path, built_reach(duration=40.0, time_step=5e-4))
    looks = len(watched.columns)
    assert looks >= 2, "the run ended before a second update"
    moving, _ = rows_by_entity(watched.path)
    rows = moving["/frames/robot/torso"]
    assert rows == moving["/plots/joint_torque"] <= 40 * (looks + 1)
    times = column(watched.path, "/plots/joint_torque", "Scalars:scalars")
    assert len(times) == rows
    np.testing.assert_array_equal(times[-1], watched.trace.tau[-1])
    strips = [strip[0] for strip in column(watched.path, "/world/tool/obtained/trail", "LineStrips3D:strips")]
    for before, after in itertools.pairwise(strips):
        assert before[1] == after[0]  # no gap between two updates


def test_the_motion_relative_to_the_reference_is_shown_live(tmp_path: Path) -> None:
    built = build(load("hill_relative"))
    watched = Watched(tmp_path, built)
    moving, static = rows_by_entity(watched.path)
    assert moving["/world/flight/base/trail"] > 0 and "/world/flight/axes" in static
    strips = [strip[0] for strip in column(watched.path, "/world/flight/base/trail", "LineStrips3D:strips")]
    for before, after in itertools.pairwise(strips):
        assert before[1] == after[0]
    assert "/world/flight/base/whole" not in static  # which is not known yet


def test_the_columns_of_checkpoints_equal_those_of_the_trace(tmp_path: Path) -> None:
    watched = Watched(tmp_path, built_reach(duration=20.0))
    whole = TraceRows.of_trace(watched.trace)
    assert watched.columns
    part = TraceRows.of_checkpoint(watched.columns[0])
    assert set(part.columns) == set(whole.columns)
    for name, values in part.columns.items():
        np.testing.assert_array_equal(values, whole[name][: len(part)])


def test_angles_are_continuous_across_updates() -> None:
    model = oo.Model.rigid_body(10.0, np.eye(3))
    view = LiveView(rr.RecordingStream("onorbit"), viewer.Setting(model), 1.0)
    sent = []
    for first in (170.0, 350.0, 530.0):  # degrees; a single update knows them only modulo a turn
        values = np.array([[first, 0.0, 0.0], [first + 90.0, 0.0, 0.0]])
        values[:, 0] -= 360.0 * np.round(first / 360.0)
        series = Series("Base", "plots/base_attitude", "Base attitude", "deg", ANGLES, values)
        sent += list(view._continued(series).values[:, 0])
    assert sent == [170.0, 260.0, 350.0, 440.0, 530.0, 620.0]


def test_an_error_of_the_viewer_is_a_warning_and_the_run_continues(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object) -> None:
        raise RuntimeError("gone")

    monkeypatch.setattr(live, "send_rows", refuse)
    with pytest.warns(
        UserWarning, match=r"the viewer was closed or failed .gone.; the run continues without the viewer"
    ) as caught:
        watched = Watched(tmp_path, built_reach(duration=20.0))
    assert len(caught) == 1 and watched.trace.is_complete


@pytest.mark.parametrize("error", [KeyError("q"), ZeroDivisionError(), OverflowError(), StopIteration()])
def test_no_exception_of_the_viewer_stops_the_run(
    error: Exception, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object) -> None:
        raise error

    monkeypatch.setattr(live, "send_rows", refuse)
    with pytest.warns(UserWarning, match="the viewer was closed"):
        watched = Watched(tmp_path, built_reach(duration=0.1), every_s=0.0)
    assert watched.trace.is_complete


def test_rows_that_the_viewer_cannot_read_cause_a_warning() -> None:
    model = oo.Model.rigid_body(10.0, np.eye(3))
    view = LiveView(rr.RecordingStream("onorbit"), viewer.Setting(model), 1.0)
    with pytest.warns(UserWarning, match="the viewer was closed"):
        view.take({"time": np.zeros((2, 1)), "tool_pose": np.zeros((2, 7))})
    view.take({})  # and no second one


class Eye:
    """A view that counts the rows that it receives."""

    def __init__(self) -> None:
        self.seen, self.ended = 0, []

    @property
    def shown(self) -> int:
        return self.seen

    def take(self, columns: Any, events: Any) -> None:
        self.seen += len(columns["time"])

    def finish(self, trace: object) -> None:
        self.ended.append(trace)


def test_a_watched_run_that_is_interrupted_reports_a_checkpoint_that_cannot_be_written(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    class Interrupted:
        time = 0.0

        def advance_to(self, _: float, *, wall_s: float) -> None:
            raise oo.exceptions.RunInterrupted("stopped")

        def checkpoint(self, _: int) -> None:
            return None

    class Simulation:
        def start(self, **_: object) -> Interrupted:
            return Interrupted()

    def full(_: oo.Checkpoint) -> None:
        raise OSError("disk full")

    eye = Eye()
    monkeypatch.setattr(live, "open_live", lambda *_: eye)
    failing = replace(built_reach(), simulation=Simulation())  # type: ignore[arg-type]  # all that is used of it
    with pytest.raises(oo.exceptions.RunInterrupted, match="stopped") as caught:
        watched(failing, None, full, checkpoint_every=1e3)  # type: ignore[arg-type]  # any writer
    assert any("disk full" in note for note in caught.value.__notes__)
    assert eye.ended == [None]


def test_ctrl_c_while_the_viewer_is_updated_keeps_the_rows_and_a_checkpoint(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    class Impatient(Eye):
        def take(self, columns: Any, events: Any) -> None:
            raise KeyboardInterrupt

    kept: list[oo.Checkpoint] = []
    monkeypatch.setattr(live, "open_live", lambda *_: Impatient())
    monkeypatch.setattr("onorbit_rs.simulation.live.UPDATE_EVERY_S", 0.0)
    with pytest.raises(oo.exceptions.RunInterrupted) as caught:
        watched(built_reach(duration=80.0), None, kept.append, checkpoint_every=1e3)  # type: ignore[arg-type]
    assert 0.0 < caught.value.time < 80.0 and len(caught.value.trace) > 1 and len(kept) == 1
    assert type(caught.value.__cause__) is KeyboardInterrupt


@pytest.mark.parametrize("accepts", [True, False])
def test_a_watched_run_writes_every_row_and_state(accepts: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    eye, given = Eye(), []

    def writer(checkpoint: oo.Checkpoint) -> bool:
        given.append(checkpoint)
        return accepts

    monkeypatch.setattr(live, "open_live", lambda *_: eye)
    monkeypatch.setattr("onorbit_rs.simulation.live.UPDATE_EVERY_S", 0.05)
    trace = watched(built_reach(duration=80.0), None, writer, checkpoint_every=0.0)  # type: ignore[arg-type]
    assert len(given) > 2, "the run ended before a third update"
    assert 0 < eye.seen < len(trace) and eye.ended == [trace]
    parts = given if accepts else given[-1:]
    columns = {name: np.concatenate([part.columns[name] for part in parts]) for name in parts[0].columns}
    stopped = oo.Checkpoint(parts[-1].state, columns, wall_s=parts[-1].wall_s)
    again = built_reach(duration=80.0).simulation.run(80.0, resume=stopped)
    np.testing.assert_array_equal(again.q, trace.q)


def test_without_a_screen_a_message_is_printed_and_the_run_is_unchanged(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    monkeypatch.setattr(screen.sys, "platform", "linux")
    data = load("humanoid_reach").resolved()
    data["simulation"] |= {"duration": 0.1}
    with pytest.warns(UserWarning, match="no display is available; the run continues without the viewer"):
        watched = oo.run(data, quiet=True, view=True)
    np.testing.assert_array_equal(watched.trace.q, oo.run(data, quiet=True).trace.q)
