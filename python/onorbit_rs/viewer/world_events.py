"""Events in a recording: a log, the state of every connection, marks in plots and in the 3-D view."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import rerun as rr

from onorbit_rs.common.display_units import amount, digits
from onorbit_rs.common.event_kinds import OF_BRAKE, OF_CONTACT
from onorbit_rs.viewer.axes import log_axes, log_name
from onorbit_rs.viewer.font import shown
from onorbit_rs.viewer.frames import FOLLOW, put_in
from onorbit_rs.viewer.trace_rows import TIMELINE

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from onorbit_rs._core import EventRecord
    from onorbit_rs.scenario.connections import Connection
    from onorbit_rs.viewer.colors import Color
    from onorbit_rs.viewer.series import Series
    from onorbit_rs.viewer.setting import Setting
    from onorbit_rs.viewer.trace_rows import TraceRows
    from onorbit_rs.viewer.viewpoint import Viewpoint
    from onorbit_rs.viewer.world_rows import WorldRows
    from onorbit_rs.viewer.world_setting import WorldSetting

    Floats = NDArray[np.float64]

LOG, STATES = "events", "connections"
"""Paths of the entities of the event log, and of the states of the connections."""

COLORS = {
    "capture": (110, 220, 130), "release": (255, 190, 80),
    "touch_down": (235, 110, 110), "lift_off": (110, 180, 255),
    "engage": (200, 140, 250), "disengage": (220, 200, 250),
}  # fmt: skip
_OTHER = (220, 220, 220)
_FREE, _CONNECTED = "free", "connected"
_APART, _TOUCHING = "apart", "touching"
_GREY = (95, 100, 110)

SHOWN_FOR = 0.05
"""Time for which an event is marked in the 3-D view, as a fraction of the run."""

_FIRST_LINE, _LINE_HEIGHT = 0.42, 0.06
"""Position and line height of the labels of events, in sizes of the scene."""

_AXES, _ARROW = 0.07, 0.2
"""Lengths of the axes of a captured or capturing frame, and of the largest impulse, in sizes of the scene."""


def log_grasps(recording: rr.RecordingStream, world: WorldRows, scene: Viewpoint) -> None:
    """Log the axes and the names of the frames that capture or are captured."""
    length = _AXES * scene.size
    for system in world.setting.systems.values():
        for frame in system.grasps:
            log_axes(recording, _of_frame(system, frame), system.frame_of(frame), length, thickness=2.0)
    for connection in world.setting.pairs:
        for (name, frame), side in zip((connection.by, connection.of), (1.0, -1.0), strict=True):
            system, rows = world.setting.systems[name], world[name]
            pose = np.asarray(system.model.frame_pose(rows["q"][0], frame)).reshape(4, 4)
            up = scene.sight()[1] if rows.rot_wl is None else rows.rot_wl[0] @ scene.sight()[1]
            at = side * 1.2 * length * up @ pose[:3, :3]
            path = f"{_of_frame(system, frame)}/name"
            log_name(recording, path, system.frame_of(frame), f"{name}/{frame}", at)


def _of_frame(system: Setting, frame: str) -> str:
    """Return the path of the entity of a frame that captures or is captured."""
    return rr.new_entity_path([*system.entity("grasp").split("/"), shown(frame)])


def log_states(recording: rr.RecordingStream, setting: WorldSetting) -> None:
    """Log the colours of the states of connections and contacts, which are initially free and apart."""
    lanes = [(f"{STATES}/{connection.name}", (_FREE, _CONNECTED), COLORS["capture"])
             for connection in setting.connections]  # fmt: skip
    lanes += [(_of_contact(name), (_APART, _TOUCHING), COLORS["touch_down"]) for name in setting.contacts]
    for path, states, color in lanes:
        style = rr.StateConfiguration(values=list(states), colors=[_GREY, color])
        recording.log(path, style, static=True, strict=True)
        _send_state(recording, path, 0.0, states[0])


def _of_contact(name: str) -> str:
    """Return the path of the entity with the state of a contact."""
    return rr.new_entity_path([STATES, shown(name)])


def send_events(
    recording: rr.RecordingStream,
    events: Sequence[EventRecord],
    world: WorldRows,
    scene: Viewpoint,
    duration_s: float,
    first: int = 0,
) -> None:
    """Send the log, the states of connections and contacts, and marks in 3-D, from event ``first`` on."""
    new = events[first:]
    if not new:
        return
    by_event = {name: connection for connection in world.setting.connections
                for name in (connection.name, *connection.releases)}  # fmt: skip
    colors = [COLORS.get(event.kind, _OTHER) for event in new]
    log = rr.TextLog.columns(
        text=[
            described(event, None if event.kind in OF_CONTACT else by_event.get(event.name)) for event in new
        ],
        level=[event.kind for event in new],
        color=colors,
    )
    recording.send_columns(
        LOG, [rr.TimeColumn(TIMELINE, duration=[event.time for event in new])], log, strict=True
    )
    largest = max(float(np.linalg.norm(event.impulse[:3])) for event in events)
    shown_s = SHOWN_FOR * duration_s
    for number, (event, color) in enumerate(zip(new, colors, strict=True), first):
        line = len(_shown_before(event, events[:number], shown_s))
        connection = None if event.kind in OF_CONTACT else by_event.get(event.name)
        if event.kind in OF_CONTACT:
            state = _TOUCHING if event.kind == "touch_down" else _APART
            _send_state(recording, _of_contact(event.name), event.time, state)
        if connection is not None:
            state = _CONNECTED if event.kind == "capture" else _FREE
            _send_state(recording, f"{STATES}/{connection.name}", event.time, state)
            scale = _ARROW * scene.size / largest if largest > 0.0 else 0.0
            _send_arrow(recording, event, connection, world, (scale, color), shown_s)
        _send_label(recording, event, scene.place(0.0, _FIRST_LINE - _LINE_HEIGHT * line), color, shown_s)


def send_marks(
    recording: rr.RecordingStream, events: Sequence[EventRecord], rows: TraceRows, series: Series
) -> None:
    """Send a mark for each event to a plot, on its last line."""
    if not events:
        return
    times = np.array([event.time for event in events])
    at = np.searchsorted(rows["time"], times, side="right") - 1
    path, column = f"{series.path}/events", [rr.TimeColumn(TIMELINE, duration=times)]
    style = rr.SeriesPoints(markers=["diamond"], marker_sizes=[5.0], names=["events"])
    recording.log(path, style, static=True, strict=True)
    colors = rr.SeriesPoints.columns(colors=[COLORS.get(event.kind, _OTHER) for event in events])
    values = rr.Scalars.columns(scalars=series.values[at, -1])
    recording.send_columns(path, column, [*values, *colors], strict=True)


def described(event: EventRecord, connection: Connection | None = None) -> str:
    """Return one line that describes an event and its balances of momentum and energy."""
    by, of = event.systems if connection is None else connection.frames
    if event.kind in OF_CONTACT:
        peak, lost = event.peak_force, amount(event.energy_lost, "J")
        about = "" if peak is None else (
            f", largest normal force {amount(peak, 'N')}, impulse {impulse_of(event)}, {lost} dissipated"
        )  # fmt: skip
        return f"{event.name}: {event.kind}{about}; {by} and {of}"
    linear, angular = np.asarray(event.momentum_error).tolist()
    systems = of if event.kind in OF_BRAKE else f"{of} by {by}"
    return (
        f"{event.name}: {event.kind}, {energy_of(event.energy_lost)}, "
        f"momentum errors {linear:.1e} and {angular:.1e}, impulse {impulse_of(event)}; {systems}"
    )


def impulse_of(event: EventRecord) -> str:
    """Return the magnitudes of the linear and the angular impulse of an event as text."""
    impulse = np.asarray(event.impulse)
    sizes = (float(np.linalg.norm(part)) for part in (impulse[:3], impulse[3:]))
    return " and ".join(f"{digits(size)} {unit}" for size, unit in zip(sizes, ("N s", "N m s"), strict=True))


def energy_of(lost_j: float) -> str:
    """Return the energy that an event removed or, if ``lost_j`` is negative, added, as text."""
    return f"{amount(abs(lost_j), 'J')} {'added' if lost_j < 0.0 else 'lost'}"


def _send_state(recording: rr.RecordingStream, path: str, t: float, state: str) -> None:
    columns = rr.StateChange.columns(state=[state])
    recording.send_columns(path, [rr.TimeColumn(TIMELINE, duration=[t])], columns, strict=True)


def _send_arrow(
    recording: rr.RecordingStream,
    event: EventRecord,
    connection: Connection,
    world: WorldRows,
    style: tuple[float, Color],
    shown_s: float,
) -> None:
    """Show the impulse on the second system for ``shown_s``, s, as an arrow to the point of application."""
    (scale, color), (name, frame) = style, connection.by
    system, rows = world.setting.systems[name], world[name]
    row = int(np.searchsorted(rows["time"], event.time, side="right")) - 1
    pose = np.asarray(system.model.frame_pose(rows["q"][row], frame)).reshape(4, 4)
    place = (np.asarray(event.point) - pose[:3, 3]) @ pose[:3, :3]
    impulse = np.asarray(event.impulse)[:3] @ pose[:3, :3]
    path = system.entity(f"events/{event.name}")
    put_in(recording, path, system.frame_of(frame))
    arrow = rr.Arrows3D(
        vectors=[scale * impulse],
        origins=[place - scale * impulse],
        colors=[color],
        radii=rr.Radius.ui_points(2.5),
    )
    _show(recording, path, arrow, event.time, shown_s)


def _shown_before(event: EventRecord, earlier: Sequence[EventRecord], shown_s: float) -> set[str]:
    """Return the names of the other events whose labels are shown at the time of an event.

    A contact, whose events have one name, has one label.
    """
    found = set()
    for other in reversed(earlier):
        if event.time - other.time >= shown_s:
            break
        found.add(other.name)
    return found - {event.name}


def _send_label(
    recording: rr.RecordingStream, event: EventRecord, place: Floats, color: Color, shown_s: float
) -> None:
    """Show a label with the name and the kind of an event above the scene for ``shown_s``, s.

    Unless the event is a touch-down, the label also contains its linear impulse and the energy lost.
    """
    path = f"world/lvlh/events/{event.name}"
    put_in(recording, path, FOLLOW)
    size = float(np.linalg.norm(event.impulse[:3]))
    text = f"{event.name}: {event.kind}"
    if event.kind != "touch_down":
        text += f", {amount(size, 'N s')}, {energy_of(event.energy_lost)}"
    label = rr.Points3D([place], colors=[color], radii=[0.0], labels=[text], show_labels=True)
    _show(recording, path, label, event.time, shown_s)


def _show(
    recording: rr.RecordingStream, path: str, content: rr.AsComponents, t: float, shown_s: float
) -> None:
    """Show an entity from the time ``t``, s, for a duration of ``shown_s``, s."""
    recording.set_time(TIMELINE, duration=t)
    recording.log(path, content, strict=True)
    recording.set_time(TIMELINE, duration=t + shown_s)
    recording.log(path, rr.Clear(recursive=False), strict=True)
    recording.reset_time()
