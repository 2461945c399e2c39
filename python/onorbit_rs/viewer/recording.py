"""``run.rrd``: the robot moving in W, its tool's path, the frames, the orbit apart, and the plots.

W has the axes of the inertial frame and its origin on the reference orbit, so 32-bit graphics stay sharp at
robot size. The orbit is drawn apart, in km; its exact state is there as 64-bit scalars.
"""

from __future__ import annotations

import uuid
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import rerun as rr

from onorbit_rs.exceptions import OnOrbitError
from onorbit_rs.geometry import shapes
from onorbit_rs.viewer.blueprint import TIMELINE, layout
from onorbit_rs.viewer.scene import send_frames, send_orbit, send_robot, send_tool
from onorbit_rs.viewer.series import send_series, series_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Model, Trace

    Floats = NDArray[np.float64]
    Rows = NDArray[np.int64]

MOST_STEPS = 50_000
"""Steps in a recording; a longer trace is thinned evenly, its last row kept."""

FLUSH_TIMEOUT_S = 300.0
"""Wall-clock time given to rerun's encoder, which needs seconds."""


def write_recording(
    path: Path,
    trace: Trace,
    model: Model,
    *,
    title: str = "",
    notes: str = "",
    orbit_path: Floats | None = None,
    has_planet: bool = True,
) -> Path:
    """Write a recording of a run that ``rerun PATH`` opens.

    Parameters
    ----------
    path : Path
        The ``.rrd`` file.
    trace : Trace
    model : Model
    title : str
        Name of the run.
    notes : str
        Markdown shown beside the picture.
    orbit_path : (k, 3) array, optional
        One revolution of the reference orbit, inertial axes, m.
    has_planet : bool
        Whether the orbit, if any, is around a planet.

    Raises
    ------
    OSError
        The file cannot be written.
    """
    robot = shapes(model)
    plots = list(series_of(trace, model))
    recording = rr.RecordingStream("onorbit", recording_id=uuid.uuid4(), send_properties=False)
    stream = rr.binary_stream(recording)  # rerun's own file sink waits for ever where the disk is full
    recording.set_log_time_enabled(False)  # simulation time alone: nothing here reads the wall clock
    recording.set_log_tick_enabled(False)
    recording.send_blueprint(layout(trace, model, plots, has_notes=bool(notes)))
    if title:
        recording.send_recording_name(title)
    rows = recorded_rows(len(trace.time))
    time = rr.TimeColumn(TIMELINE, duration=np.asarray(trace.time)[rows])
    send_robot(recording, time, trace, model, robot, rows)
    send_tool(recording, time, trace, rows)
    send_frames(recording, time, trace, rows)
    send_orbit(recording, time, trace, rows, orbit_path, has_planet)
    for series in plots:
        send_series(recording, time, series, rows)
    if notes:
        recording.log(
            "notes", rr.TextDocument(notes, media_type=rr.MediaType.MARKDOWN), static=True, strict=True
        )
    path.write_bytes(_encoded(stream))
    recording.disconnect()
    return path


def _encoded(stream: rr.BinaryStream) -> bytes:
    """Everything sent so far, as the content of a ``.rrd``."""
    try:
        return stream.read(flush_timeout_sec=FLUSH_TIMEOUT_S) or b""
    except RuntimeError as error:
        raise OnOrbitError(f"rerun did not encode the recording: {error}") from error


def recorded_rows(count: int) -> Rows:
    """Rows of the trace that go into the recording."""
    stride = -(-count // MOST_STEPS)
    rows = np.arange(0, count, stride)
    return rows if rows[-1] == count - 1 else np.append(rows, count - 1)
