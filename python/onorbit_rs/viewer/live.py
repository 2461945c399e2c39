"""Live view of a run: new rows are decimated and sent to a viewer."""

from __future__ import annotations

import warnings
from abc import ABC, abstractmethod
from contextlib import contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import rerun as rr

from onorbit_rs.exceptions import ViewerError
from onorbit_rs.viewer.arrows import Arrows
from onorbit_rs.viewer.flight import flight_bodies, is_apart, send_flight
from onorbit_rs.viewer.planet import send_orbit_trail
from onorbit_rs.viewer.recording import new_recording, send_rows, send_static
from onorbit_rs.viewer.scene import send_trails
from onorbit_rs.viewer.screen import has_screen, open_viewer
from onorbit_rs.viewer.series import ANGLES, Series, send_series, series_of
from onorbit_rs.viewer.streams import release_streams
from onorbit_rs.viewer.trace_rows import TraceRows

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from numpy.typing import NDArray

    from onorbit_rs._core import EventRecord, Trace, WorldTrace
    from onorbit_rs.viewer.setting import Setting
    from onorbit_rs.viewer.viewpoint import Viewpoint

    Floats = NDArray[np.float64]

MOST_ROWS = 500
"""Largest number of rows per update."""

LAST_ROWS_S = 5.0
"""Longest wall-clock time to wait until the viewer has received the last rows, s."""


class View(ABC):
    """A live view of a run of ``duration_s`` seconds; errors of the view never stop the run."""

    def __init__(self, recording: rr.RecordingStream, duration_s: float) -> None:
        """Store the recording and the duration of the run; nothing is sent."""
        self._recording, self._duration_s = recording, duration_s
        self._angles: dict[str, Floats] = {}
        self._is_lost = False

    @property
    @abstractmethod
    def shown(self) -> int:
        """Number of rows that the view has received."""

    @abstractmethod
    def _show_columns(self, columns: Mapping[str, Floats], events: Sequence[EventRecord]) -> None:
        """Show the columns of a stepper from row :attr:`shown` on, and the events so far."""

    @abstractmethod
    def _show_rest(self, trace: Any) -> None:
        """Show the rows of a trace from row :attr:`shown` on."""

    @abstractmethod
    def _release(self) -> None:
        """Delete the references to the recording in attributes of the subclass."""

    def take(self, columns: Mapping[str, Floats], events: Sequence[EventRecord] = ()) -> None:
        """Show the columns of a stepper from row :attr:`shown` on, and the events so far."""
        with self._loses_view():
            self._show_columns(columns, events)

    def finish(self, trace: Trace | WorldTrace | None) -> None:
        """Show the remaining rows of the trace, unless it is None, and disconnect from the viewer."""
        with self._loses_view():
            if trace is not None:
                self._show_rest(trace)
        with self._loses_view():
            if not self._is_lost:
                self._wait_for_viewer()
        with self._loses_view():
            self._recording.disconnect()
        self._is_lost = True  # no data are sent from here on
        self._release()
        del self._recording
        with self._loses_view():
            release_streams()

    def _wait_for_viewer(self) -> None:
        """Wait until the viewer has received the last rows; rerun reports a closed viewer only here."""
        try:
            self._recording.flush(timeout_sec=LAST_ROWS_S)
        except Exception:
            self._is_lost = True
            warnings.warn(
                "the viewer was closed or stopped responding before it had received the whole run; to "
                "also save a recording, run with --out DIR",
                stacklevel=2,
            )

    @contextmanager
    def _loses_view(self) -> Iterator[None]:
        """Convert errors in the block to a warning, after which the run continues without the view."""
        try:
            yield
        except Exception as error:
            self._lose(error)

    def _continued(self, series: Series) -> Series:
        """Return the series with angles unwrapped, continuing the angles of the previous rows."""
        if series.names != ANGLES:
            return series
        values = series.values
        before = self._angles.get(series.path, values[0])
        values = values + 360.0 * np.round((before - values[0]) / 360.0)
        self._angles[series.path] = values[-1]
        return replace(series, values=values)

    def _lose(self, error: Exception) -> None:
        if self._is_lost:
            return
        self._is_lost = True
        warnings.warn(
            f"the viewer was closed or failed ({error}); the run continues without the viewer; if it was "
            "started with --out DIR, open its recording afterwards with: onorbit show DIR",
            stacklevel=2,
        )


class LiveView(View):
    """Live view of a run with one robot."""

    def __init__(self, recording: rr.RecordingStream, setting: Setting, duration_s: float) -> None:
        """Store the recording, the setting and the duration; static entities are sent with the first rows."""
        super().__init__(recording, duration_s)
        self._setting = setting
        self._stage: Viewpoint | None = None
        self._arrows: Arrows | None = None
        self._before: TraceRows | None = None
        self._count, self._has_flight = 0, False

    @property
    def shown(self) -> int:
        """Number of rows that the view has received."""
        return self._count

    def _show_columns(self, columns: Mapping[str, Floats], events: Sequence[EventRecord]) -> None:
        self._show(TraceRows.of_checkpoint(columns))

    def _show_rest(self, trace: Trace) -> None:
        self._show(TraceRows.of_trace(trace, slice(self._count, None)))

    def _release(self) -> None:
        self._arrows = None

    def _show(self, rows: TraceRows) -> None:
        self._count += len(rows)
        if self._is_lost or len(rows) == 0:
            return
        self._send(rows.decimated(MOST_ROWS))

    def _send(self, rows: TraceRows) -> None:
        recording, setting = self._recording, self._setting
        plots = list(series_of(rows, setting, is_live=True))
        if self._stage is None:
            self._stage = send_static(recording, rows, setting, plots, self._duration_s, is_live=True)
            self._arrows = Arrows(recording, setting, self._stage)
            self._has_flight = is_apart(flight_bodies(rows, setting), self._stage.size)
        send_rows(recording, rows, setting, self._stage)
        for series in plots:
            send_series(recording, rows, self._continued(series))
        if self._arrows is not None:
            self._arrows.send(rows)
        joined = rows if self._before is None else rows.after(self._before)
        send_paths_so_far(recording, joined, setting)
        if self._has_flight:
            send_flight(recording, flight_bodies(joined, setting), MOST_ROWS)
        self._before = rows.last()


def send_paths_so_far(recording: rr.RecordingStream, rows: TraceRows, setting: Setting) -> None:
    """Send the paths of tool and robot since the last row of the previous update."""
    if "reference_pose" in rows:
        send_trails(recording, rows, setting, MOST_ROWS, "desired")
    if "tool_pose" in rows:
        send_trails(recording, rows, setting, MOST_ROWS, "obtained")
    if "position_eci" in rows:
        send_orbit_trail(recording, rows, setting, MOST_ROWS)


def open_live(setting: Setting, duration_s: float) -> LiveView | None:
    """Open a viewer window for one robot; if that fails, warn and return None."""
    recording = connected_recording(setting.name)
    return None if recording is None else LiveView(recording, setting, duration_s)


def connected_recording(name: str) -> rr.RecordingStream | None:
    """Open a viewer window and return a recording that is sent to it; if that fails, warn and return None."""
    if not has_screen():
        warnings.warn(
            "no display is available; the run continues without the viewer; to view the run later, open its "
            "recording on a computer with a display: onorbit show DIR",
            stacklevel=2,
        )
        return None
    try:
        url = open_viewer()
    except ViewerError as error:
        warnings.warn(f"{error}; the run continues without the viewer", stacklevel=2)
        return None
    try:
        recording = new_recording(name)
        recording.connect_grpc(url)
    except Exception as error:
        warnings.warn(
            f"the viewer cannot be reached ({error}); the run continues without the viewer; to view the run "
            "later, open its recording with: onorbit show DIR",
            stacklevel=2,
        )
        return None
    return recording
