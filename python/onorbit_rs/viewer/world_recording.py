"""``run.rrd`` of several systems: entities are grouped by system in one scene, and events are marked."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs.common.event_kinds import OF_CONTACT
from onorbit_rs.common.file_parts import file_part
from onorbit_rs.viewer.arrows import Arrows
from onorbit_rs.viewer.axes import log_compass
from onorbit_rs.viewer.blueprint import playback_speed
from onorbit_rs.viewer.colors import of_systems
from onorbit_rs.viewer.contact_marks import HELD_FOR, ContactMarks
from onorbit_rs.viewer.flight import Body, flight_bodies, is_apart, log_flight, log_whole_flight, send_flight
from onorbit_rs.viewer.frames import COMPASS, FOLLOW, WORLD, put_in, send_follow, send_local_frame
from onorbit_rs.viewer.notes import about_meshes, about_rows
from onorbit_rs.viewer.planet import log_planet, send_planet, send_spacecraft
from onorbit_rs.viewer.recording import (
    MOST_STEPS,
    log_craft,
    log_notes,
    log_paths,
    recorded_in,
    send_craft,
)
from onorbit_rs.viewer.scene import MOST_TRAIL_PIECES
from onorbit_rs.viewer.series import SUM, Series, log_style, send_series, series_of
from onorbit_rs.viewer.streams import releases_streams, send_blueprint
from onorbit_rs.viewer.viewpoint import Viewpoint
from onorbit_rs.viewer.world_blueprint import world_layout
from onorbit_rs.viewer.world_events import log_grasps, log_states, send_events, send_marks
from onorbit_rs.viewer.world_rows import WorldRows
from onorbit_rs.viewer.world_series import PLOTS_OF_CONTACTS, SHARED, world_series
from onorbit_rs.viewer.world_viewpoint import common_viewpoint

if TYPE_CHECKING:
    from collections.abc import Sequence

    import rerun as rr

    from onorbit_rs._core import EventRecord, WorldTrace
    from onorbit_rs.viewer.trace_rows import TraceRows
    from onorbit_rs.viewer.world_setting import WorldSetting

Plots = list[tuple["TraceRows", Series]]
"""Plots, each with the rows that contain its times."""

LIVE_MARGIN = 1.3
"""Ratio of the size of a live view's scene to its initial size, as space for the later motion."""

NEAR_ON_ORBIT = 0.02
"""Largest distance between spacecraft that share a label in the view of the orbit, in orbit radii."""


@dataclass(frozen=True)
class Stage:
    """Viewpoints on all systems together and on each system."""

    common: Viewpoint
    alone: dict[str, Viewpoint]

    @classmethod
    def of(cls, world: WorldRows, *, is_live: bool = False) -> Stage:
        """Return the viewpoints for these rows, which in a live view are the first rows only."""
        alone = {name: Viewpoint.of(world[name], setting) for name, setting in world.setting.systems.items()}
        common = common_viewpoint(world)
        return cls(replace(common, size=LIVE_MARGIN * common.size) if is_live else common, alone)

    @property
    def size(self) -> float:
        """Size of the largest system, m."""
        return max(viewpoint.size for viewpoint in self.alone.values())


@releases_streams
def write_world_recording(path: Path, trace: WorldTrace, setting: WorldSetting, *, notes: str = "") -> Path:
    """Write a recording of a run with several systems, which ``rerun PATH`` opens, and return its path.

    Parameters
    ----------
    path : Path
        Path of the ``.rrd`` file.
    trace : WorldTrace
        Rows and events to record.
    setting : WorldSetting
        The systems and the connections between them.
    notes : str
        Markdown shown beside the 3-D view.

    Raises
    ------
    OSError
        If the file cannot be written.
    ViewerError
        If rerun did not encode the recording completely.
    """
    most = MOST_STEPS // len(setting.systems)
    world = WorldRows.of_trace(trace, setting, most)
    rows = max(len(trace[name].time) for name in setting.names)
    notes += about_rows(min(rows, most), rows)
    notes += "".join(about_meshes(system.model) for system in setting.systems.values())
    with recorded_in(path, setting.name) as recording:
        _send_run(recording, world, trace.events, notes)
    return path


def _send_run(
    recording: rr.RecordingStream, world: WorldRows, events: Sequence[EventRecord], notes: str
) -> None:
    """Send the rows and the events of a complete run."""
    setting, plots = world.setting, plots_of(world)
    duration = float(world.all_times["time"][-1])
    stage = log_world(recording, world, plots, duration, notes=notes, has_events=bool(events))
    for times, series in plots:
        send_series(recording, times, series)
        if series.path.startswith(SHARED):
            send_marks(recording, _events_of(series, setting, events), times, series)
    send_world(recording, world, stage)
    for name, system in setting.systems.items():
        log_paths(recording, world[name], system, stage.alone[name])
        Arrows(recording, system, stage.alone[name]).send(world[name])
    held_s = HELD_FOR * playback_speed(duration)
    ContactMarks(recording, stage.common, stage.alone, held_s).send(world)
    if is_apart(bodies := bodies_of(world), stage.size):
        log_whole_flight(recording, bodies)
        send_flight(recording, bodies, MOST_TRAIL_PIECES)
    send_events(recording, events, world, stage.common, duration)


def plots_of(world: WorldRows, *, is_live: bool = False) -> Plots:
    """Return the plots of the world and of each system."""
    found = list(world_series(world, is_live=is_live))
    for name, system in world.setting.systems.items():
        found += [(world[name], series) for series in series_of(world[name], system, is_live=is_live)]
    return found


def log_world(
    recording: rr.RecordingStream,
    world: WorldRows,
    plots: Plots,
    duration_s: float,
    *,
    notes: str = "",
    has_events: bool = False,
    is_live: bool = False,
) -> Stage:
    """Send the layout, log the static entities and return the viewpoints.

    In a live view, ``world`` contains the first rows only.
    """
    setting, bodies = world.setting, bodies_of(world)
    stage = Stage.of(world, is_live=is_live)
    send_blueprint(
        recording,
        world_layout(
            world, (stage.common, stage.alone), bodies if is_apart(bodies, stage.size) else [],
            [series for _, series in plots], duration_s,
            has_notes=bool(notes), has_events=has_events, is_live=is_live,
        ),
    )  # fmt: skip
    put_in(recording, "world", WORLD)
    for name, system in setting.systems.items():
        log_craft(recording, world[name], system, stage.alone[name])
    places = (stage.common.inertial_at, stage.common.local_at)
    in_orbit = world.first.quat_wl is not None
    log_compass(recording, "world/lvlh", (FOLLOW, COMPASS), stage.common.size, places, in_orbit=in_orbit)
    log_grasps(recording, world, stage.common)
    log_states(recording, setting)
    if "position_eci" in world.first:
        log_planet(recording, world.first, setting.first)
    if is_apart(bodies, stage.size):
        log_flight(recording, bodies, "world/lvlh/flight")
    for _, series in plots:
        log_style(recording, series)
    log_notes(recording, notes)
    return stage


def send_world(recording: rr.RecordingStream, world: WorldRows, stage: Stage) -> None:
    """Send all moving entities, for every row."""
    shared = world.all_times
    send_local_frame(recording, shared)
    send_follow(recording, shared, FOLLOW, COMPASS, world.center, stage.common.inertial_at)
    for name, system in world.setting.systems.items():
        send_craft(recording, world[name], system, stage.alone[name])
    if "position_eci" in world.first:
        send_planet(recording, world.first, world.setting.first)
        for name, label in _orbit_labels(world).items():
            send_spacecraft(recording, world[name], world.setting.systems[name], label)


def bodies_of(world: WorldRows) -> list[Body]:
    """Return the bodies in the view of the relative flight; empty if L is undefined."""
    systems = world.setting.systems
    colors = of_systems(systems)
    return [
        body for name, system in systems.items() for body in flight_bodies(world[name], system, colors[name])
    ]


def _events_of(series: Series, setting: WorldSetting, events: Sequence[EventRecord]) -> list[EventRecord]:
    """Return the events between the systems of a plot; plots of a contact omit touches of other contacts."""
    systems = set(setting.names)
    for connection in setting.connections:
        if series.path.startswith(f"{SHARED}connections/{connection.name}/"):
            systems = set(connection.systems)
    if SUM in series.names:
        systems = set(series.names)
    found = [event for event in events if set(event.systems) <= systems]
    if not series.path.startswith(PLOTS_OF_CONTACTS):
        return found
    owner = series.path.removeprefix(PLOTS_OF_CONTACTS).partition("/")[0]
    return [event for event in found if event.kind not in OF_CONTACT or file_part(event.name) == owner]


def _orbit_labels(world: WorldRows) -> dict[str, str]:
    """Return the label of each spacecraft; if all are near each other, the first one has a common label."""
    names = world.setting.names
    first = world.first["position_eci"][0]
    apart = max(float(np.linalg.norm(world[name]["position_eci"][0] - first)) for name in names)
    if apart > NEAR_ON_ORBIT * float(np.linalg.norm(first)):
        return {name: name for name in names}
    return {name: ", ".join(names) if name == names[0] else "" for name in names}
