"""Live view of a run with several systems."""

from __future__ import annotations

from typing import TYPE_CHECKING

from onorbit_rs.viewer.arrows import Arrows
from onorbit_rs.viewer.contact_marks import ContactMarks
from onorbit_rs.viewer.flight import is_apart, send_flight
from onorbit_rs.viewer.live import MOST_ROWS, View, connected_recording, send_paths_so_far
from onorbit_rs.viewer.series import send_series
from onorbit_rs.viewer.trace_rows import TraceRows
from onorbit_rs.viewer.world_events import send_events
from onorbit_rs.viewer.world_recording import Stage, bodies_of, log_world, plots_of, send_world
from onorbit_rs.viewer.world_rows import WorldRows

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    import numpy as np
    import rerun as rr
    from numpy.typing import NDArray

    from onorbit_rs._core import EventRecord, WorldTrace
    from onorbit_rs.viewer.world_setting import WorldSetting

    Floats = NDArray[np.float64]


class WorldLiveView(View):
    """Live view of a run with several systems and of its events."""

    def __init__(self, recording: rr.RecordingStream, setting: WorldSetting, duration_s: float) -> None:
        """Store the recording, the setting and the duration; static entities are sent with the first rows."""
        super().__init__(recording, duration_s)
        self._setting = setting
        self._stage: Stage | None = None
        self._arrows: dict[str, Arrows] = {}
        self._marks: ContactMarks | None = None
        self._before: dict[str, TraceRows] = {}
        self._counts = dict.fromkeys(setting.names, 0)
        self._has_flight = False
        self._events = 0

    @property
    def shown(self) -> int:
        """Smallest number of rows that the view has received of any system."""
        return min(self._counts.values())

    def _show_columns(self, columns: Mapping[str, Floats], events: Sequence[EventRecord]) -> None:
        first = self.shown
        new = {}
        for path, values in columns.items():
            seen = self._counts[path.partition("/")[0]] - first
            new[path] = values[seen:]
        self._show(WorldRows.of_columns(new, self._setting), events)

    def _show_rest(self, trace: WorldTrace) -> None:
        rest = {}
        for name, count in self._counts.items():  # includes at least the last row
            first = min(count, len(trace[name].time) - 1)
            rest[name] = TraceRows.of_trace(trace[name], slice(first, None))
        self._show(WorldRows(self._setting, rest), trace.events)

    def _release(self) -> None:
        self._arrows, self._marks = {}, None

    def _show(self, world: WorldRows, events: Sequence[EventRecord]) -> None:
        """Show new rows and events; if a system has no new rows, all systems wait for the next update."""
        if any(len(rows) == 0 for rows in world.systems.values()):
            return
        for name, rows in world.systems.items():
            self._counts[name] += len(rows)
        if self._is_lost:
            return
        self._send(WorldRows(self._setting, {name: rows.decimated(MOST_ROWS)
                                             for name, rows in world.systems.items()}))  # fmt: skip
        end = min(float(rows["time"][-1]) for rows in world.systems.values())
        known = [event for event in events if event.time <= end]
        if self._stage is not None and len(known) > self._events:
            scene, first = self._stage.common, self._events
            send_events(self._recording, known, world, scene, self._duration_s, first=first)
            self._events = len(known)

    def _send(self, world: WorldRows) -> None:
        recording, systems = self._recording, self._setting.systems
        plots = plots_of(world, is_live=True)
        if self._stage is None:
            self._stage = log_world(
                recording, world, plots, self._duration_s,
                has_events=bool(self._setting.connections or self._setting.contacts), is_live=True,
            )  # fmt: skip
            self._arrows = {name: Arrows(recording, system, self._stage.alone[name])
                            for name, system in systems.items()}  # fmt: skip
            self._marks = ContactMarks(recording, self._stage.common, self._stage.alone)
            self._has_flight = is_apart(bodies_of(world), self._stage.size)
        send_world(recording, world, self._stage)
        for rows, series in plots:
            send_series(recording, rows, self._continued(series))
        if self._marks is not None:
            self._marks.send(world)
        joined = {}
        for name, system in systems.items():
            if name in self._arrows:
                self._arrows[name].send(world[name])
            before = self._before.get(name)
            joined[name] = world[name] if before is None else world[name].after(before)
            send_paths_so_far(recording, joined[name], system)
            self._before[name] = world[name].last()
        if self._has_flight:
            send_flight(recording, bodies_of(WorldRows(self._setting, joined)), MOST_ROWS)


def open_world_live(setting: WorldSetting, duration_s: float) -> WorldLiveView | None:
    """Open a viewer window for several systems; if that fails, warn and return None."""
    recording = connected_recording(setting.name)
    return None if recording is None else WorldLiveView(recording, setting, duration_s)
