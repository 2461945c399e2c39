"""Live view of several systems: rows in adjacent parts, events when they happen, no effect on the run."""

from __future__ import annotations

import itertools
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rerun as rr
from recordings import FrameTree, column, rows_by_entity
from world_runs import built, data, pair, ran, trio

import onorbit_rs as oo
from onorbit_rs import viewer
from onorbit_rs.scenario.build_world import BuiltWorld
from onorbit_rs.simulation.live import watched
from onorbit_rs.viewer import screen, world_live
from onorbit_rs.viewer.world_live import WorldLiveView


def view_into(path: Path, world: BuiltWorld) -> WorldLiveView:
    recording = rr.RecordingStream("onorbit", send_properties=False)
    recording.save(path)
    return WorldLiveView(recording, viewer.WorldSetting.of(world), world.scenario.simulation.duration)


def shown_in_parts(path: Path, world: BuiltWorld, every_s: float) -> Any:
    """Returns the trace of a run that is shown at regular times."""
    view, duration = view_into(path, world), world.scenario.simulation.duration
    stepper = world.simulation.start(duration=duration)
    for t in np.arange(every_s, duration, every_s):
        stepper.advance_to(t)
        view.take(stepper.columns(view.shown), stepper.events)
    stepper.advance_to(duration)
    trace = stepper.finish()
    view.finish(trace)
    return trace


@pytest.mark.parametrize("make", [pair, trio])
def test_every_row_is_shown_in_adjacent_parts(make: Any, tmp_path: Path) -> None:
    """The third satellite has fewer rows than the others, which are connected by events."""
    world, expected = make()
    trace = shown_in_parts(tmp_path / "live.rrd", world, 0.0625)
    path = tmp_path / "live.rrd"
    moving, static = rows_by_entity(path)
    for name in trace.names:
        np.testing.assert_array_equal(trace[name].q, expected[name].q)
        rates = np.array(column(path, f"/plots/{name}/base_rate", "Scalars:scalars"))
        known = {tuple(row) for row in rates}
        assert known == {tuple(row) for row in np.asarray(trace[name].v)[:, 3:6]}
        assert len(trace[name]) <= len(rates) <= len(trace[name]) + 1  # the last row may be sent again
    assert "/world/lvlh/lvlh" in static and moving["/events"] == 2
    strips = [strip[0] for strip in column(path, "/orbit/trail/target", "LineStrips3D:strips")]
    for before, after in itertools.pairwise(strips):
        assert before[1] == after[0]  # no gap between two updates
    assert [state[0] for state in column(path, "/connections/grasp", "StateChange:state")][-1] == "free"


def test_events_are_shown_when_they_happen(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    shown: list[tuple[str, float, float]] = []
    send = world_live.send_events

    def spied(recording: Any, events: Any, world: Any, *scene: Any, first: int) -> None:
        end = min(float(rows["time"][-1]) for rows in world.systems.values())
        shown.extend((event.name, event.time, end) for event in events[first:])
        send(recording, events, world, *scene, first=first)

    monkeypatch.setattr(world_live, "send_events", spied)
    trace = shown_in_parts(tmp_path / "live.rrd", pair()[0], 0.0625)
    assert [name for name, *_ in shown] == [event.name for event in trace.events]  # each once
    assert all(0.0 <= end - time < 0.0626 for _, time, end in shown), shown
    assert shown[0][2] < 0.5  # not only at the end of the run
    assert rows_by_entity(tmp_path / "live.rrd")[0]["/events"] == len(trace.events)


def test_a_run_that_ends_before_the_first_update_is_shown(tmp_path: Path) -> None:
    world, _ = pair()
    view = view_into(tmp_path / "live.rrd", world)
    trace = ran(world)
    view.finish(trace)
    truth = world.systems["target"].model.frame_pose(trace["target"].q, "handle")
    np.testing.assert_allclose(FrameTree(tmp_path / "live.rrd").pose("target/robot/handle"), truth, atol=1e-6)


def test_an_error_of_the_viewer_is_a_warning(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise RuntimeError("gone")

    monkeypatch.setattr(world_live, "send_world", refuse)
    with pytest.warns(
        UserWarning, match="the viewer was closed or failed .gone.; the run continues"
    ) as caught:
        trace = shown_in_parts(tmp_path / "live.rrd", pair()[0], 0.125)
    assert len(caught) == 1 and trace.is_complete


def test_a_watched_run_passes_its_rows_to_the_view(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    values = data()
    values["simulation"] |= {"duration": 20.0, "time_step": 5e-3}
    world = built(values)
    opened = view_into(tmp_path / "live.rrd", world)
    monkeypatch.setattr(world_live, "open_world_live", lambda *_: opened)
    monkeypatch.setattr("onorbit_rs.simulation.live.UPDATE_EVERY_S", 0.01)
    trace: Any = watched(world, None)
    np.testing.assert_array_equal(trace["chaser"].q, ran(world)["chaser"].q)
    assert rows_by_entity(tmp_path / "live.rrd")[0]["/plots/chaser/base_rate"] > 1


def test_without_a_screen_the_run_is_unchanged(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    monkeypatch.setattr(screen.sys, "platform", "linux")
    with pytest.warns(UserWarning, match="no display is available; the run continues without the viewer"):
        run: Any = oo.run(data(), quiet=True, view=True)
    np.testing.assert_array_equal(run.trace["target"].q, pair()[1]["target"].q)
