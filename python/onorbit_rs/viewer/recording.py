"""``run.rrd``: the robot moving in named frames, its tool's path, arrows, a view of the orbit, and plots.

W has the axes of the inertial frame and its origin on the reference orbit, so that 32-bit graphics are
precise at the scale of the robot. The orbit has a separate view, in km; plots show its state in 64 bits.
"""

from __future__ import annotations

import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import rerun as rr

from onorbit_rs.viewer.arrows import Arrows
from onorbit_rs.viewer.axes import log_all_axes
from onorbit_rs.viewer.blueprint import layout
from onorbit_rs.viewer.encoded import Encoded
from onorbit_rs.viewer.flight import flight_bodies, is_apart, log_flight, log_whole_flight, send_flight
from onorbit_rs.viewer.font import shown, shown_lines
from onorbit_rs.viewer.frames import (
    WORLD,
    put_in,
    send_fixed_frames,
    send_local_frame,
    send_moving_frames,
)
from onorbit_rs.viewer.notes import about_meshes, about_rows
from onorbit_rs.viewer.planet import log_path_flown, log_planet, send_planet, send_spacecraft
from onorbit_rs.viewer.scene import (
    MOST_TRAIL_PIECES,
    NEAR,
    log_collisions,
    log_path,
    log_robot,
    path_length,
    send_desired,
    send_trails,
)
from onorbit_rs.viewer.series import Series, log_style, send_series, series_of
from onorbit_rs.viewer.streams import APPLICATION, releases_streams, send_blueprint
from onorbit_rs.viewer.targets import log_targets, send_targets
from onorbit_rs.viewer.trace_rows import TraceRows
from onorbit_rs.viewer.viewpoint import Viewpoint

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Trace
    from onorbit_rs.viewer.setting import Setting

    Floats = NDArray[np.float64]

MOST_STEPS = 500_000
"""Largest number of rows (0.5 GB); longer traces are decimated evenly, and the last row is kept."""


@releases_streams
def write_recording(path: Path, trace: Trace, setting: Setting, *, notes: str = "") -> Path:
    """Write a recording of a run, which ``rerun PATH`` opens, and return its path.

    Parameters
    ----------
    path : Path
        Path of the ``.rrd`` file.
    trace : Trace
        Rows to record.
    setting : Setting
        The robot, its orbit and its targets.
    notes : str
        Markdown shown beside the 3-D view.

    Raises
    ------
    OSError
        If the file cannot be written.
    ViewerError
        If rerun did not encode the recording completely.
    """
    chosen = recorded_rows(len(trace.time))
    rows = TraceRows.of_trace(trace, slice(None) if len(chosen) == len(trace.time) else chosen)
    notes += about_rows(len(chosen), len(trace.time)) + about_meshes(setting.model)
    with recorded_in(path, setting.name) as recording:
        plots = list(series_of(rows, setting))
        viewpoint = send_static(recording, rows, setting, plots, float(rows["time"][-1]), notes=notes)
        for series in plots:
            send_series(recording, rows, series)
        send_rows(recording, rows, setting, viewpoint)
        log_paths(recording, rows, setting, viewpoint)
        if is_apart(bodies := flight_bodies(rows, setting), viewpoint.size):
            log_whole_flight(recording, bodies)
            send_flight(recording, bodies, MOST_TRAIL_PIECES)
        Arrows(recording, setting, viewpoint).send(rows)
    return path


@contextmanager
def recorded_in(path: Path, name: str) -> Iterator[rr.RecordingStream]:
    """Yield a new recording; write it to a file when the block ends without an exception."""
    recording = new_recording(name)
    encoded = Encoded(recording)
    yield recording
    encoded.write_to(path)


def log_paths(recording: rr.RecordingStream, rows: TraceRows, setting: Setting, viewpoint: Viewpoint) -> None:
    """Log the paths of the tool and of the robot on its orbit, which are known after the run."""
    if "reference_pose" in rows:
        log_path(recording, rows, setting, viewpoint.size)
    if "tool_pose" in rows:
        send_trails(recording, rows, setting, MOST_TRAIL_PIECES, "obtained")
    if "position_eci" in rows:
        log_path_flown(recording, rows, setting)


def new_recording(name: str) -> rr.RecordingStream:
    """Return an empty recording on simulation time, without wall-clock timelines."""
    recording = rr.RecordingStream(APPLICATION, recording_id=uuid.uuid4(), send_properties=False)
    recording.set_log_time_enabled(False)
    recording.set_log_tick_enabled(False)
    if name:
        recording.send_recording_name(shown(name))
    return recording


def send_static(
    recording: rr.RecordingStream,
    rows: TraceRows,
    setting: Setting,
    plots: list[Series],
    duration_s: float,
    *,
    notes: str = "",
    is_live: bool = False,
) -> Viewpoint:
    """Send the layout, log the static entities and return the viewpoint.

    In a live view, ``rows`` are the first rows only.
    """
    viewpoint = Viewpoint.of(rows, setting)
    views = layout(rows, setting, viewpoint, plots, duration_s, has_notes=bool(notes), is_live=is_live)
    send_blueprint(recording, views)
    put_in(recording, "world", WORLD)
    log_craft(recording, rows, setting, viewpoint)
    if "position_eci" in rows:
        log_planet(recording, rows, setting)
    if is_apart(bodies := flight_bodies(rows, setting), viewpoint.size):
        log_flight(recording, bodies)
    for series in plots:
        log_style(recording, series)
    log_notes(recording, notes)
    return viewpoint


def log_craft(recording: rr.RecordingStream, rows: TraceRows, setting: Setting, viewpoint: Viewpoint) -> None:
    """Log the shapes and the axes of one robot; the axes are placed according to the first rows."""
    send_fixed_frames(recording, setting)
    log_robot(recording, setting)
    log_collisions(recording, setting)
    log_all_axes(
        recording, setting, viewpoint.size, (viewpoint.inertial_at, viewpoint.local_at),
        near=NEAR * path_length(rows, setting), in_orbit=rows.quat_wl is not None,
        tool_name_at=None if setting.tool is None else viewpoint.beside_tool(rows, setting),
        has_reference="reference_pose" in rows,
    )  # fmt: skip
    log_targets(recording, setting, viewpoint.size)


def log_notes(recording: rr.RecordingStream, notes: str) -> None:
    """Log the notes in Markdown, unless they are empty."""
    if notes:
        text = rr.TextDocument(shown_lines(notes), media_type=rr.MediaType.MARKDOWN)
        recording.log("notes", text, static=True, strict=True)


def send_rows(recording: rr.RecordingStream, rows: TraceRows, setting: Setting, viewpoint: Viewpoint) -> None:
    """Send all moving entities, for every row."""
    send_local_frame(recording, rows)
    send_craft(recording, rows, setting, viewpoint)
    if "position_eci" in rows:
        send_planet(recording, rows, setting)
        send_spacecraft(recording, rows, setting)


def send_craft(
    recording: rr.RecordingStream, rows: TraceRows, setting: Setting, viewpoint: Viewpoint
) -> None:
    """Send the links of one robot, its targets and the desired pose of its tool, for every row."""
    send_moving_frames(recording, rows, setting, viewpoint.inertial_at, viewpoint.base_at)
    send_targets(recording, rows, setting)
    if "reference_pose" in rows:
        send_desired(recording, rows, setting)


def recorded_rows(count: int) -> NDArray[np.int64]:
    """Return the indices of the rows of a trace with ``count`` rows that a recording contains."""
    stride = -(-count // MOST_STEPS)
    chosen = np.arange(0, count, stride)
    return chosen if chosen[-1] == count - 1 else np.append(chosen, count - 1)
