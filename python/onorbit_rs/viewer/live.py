"""Watching a run while it goes on: rows go to a viewer as they come, thinned to what an eye can follow."""

from __future__ import annotations

import warnings
from contextlib import contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import rerun as rr

from onorbit_rs.exceptions import ViewerError
from onorbit_rs.viewer.arrows import Arrows
from onorbit_rs.viewer.flight import is_apart, send_flight
from onorbit_rs.viewer.planet import send_orbit_trail
from onorbit_rs.viewer.recording import new_recording, open_stage, send_rows
from onorbit_rs.viewer.rows import Rows
from onorbit_rs.viewer.scene import send_trails
from onorbit_rs.viewer.screen import has_screen, open_viewer
from onorbit_rs.viewer.series import ANGLES, Series, send_series, series_of
from onorbit_rs.viewer.streams import release_streams

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from numpy.typing import NDArray

    from onorbit_rs._core import Trace
    from onorbit_rs.viewer.setting import Setting
    from onorbit_rs.viewer.stage import Stage

    Floats = NDArray[np.float64]

LOOK_EVERY_S = 0.5
"""Wall-clock time between two looks at a run."""

MOST_ROWS = 500
"""Rows sent at a look."""

GOODBYE_S = 5.0
"""Wall-clock time given to the viewer to take the last rows."""


class LiveView:
    """Sends rows of a run that lasts ``duration_s`` into a recording; trouble there never stops the run."""

    def __init__(self, recording: rr.RecordingStream, setting: Setting, duration_s: float) -> None:
        """For a run that has not begun."""
        self._recording, self._setting, self._duration_s = recording, setting, duration_s
        self._stage: Stage | None = None
        self._arrows: Arrows | None = None
        self._before: Rows | None = None
        self._angles: dict[str, Floats] = {}
        self._count, self._is_lost, self._has_flight = 0, False, False

    def take(self, columns: Mapping[str, Floats]) -> None:
        """New rows, as a checkpoint holds them."""
        with self._trouble():
            self._show(Rows.of_checkpoint(columns))

    def finish(self, trace: Trace | None) -> None:
        """The rows that no look has seen, and goodbye."""
        with self._trouble():
            if trace is not None:
                self._show(Rows.of_trace(trace, slice(self._count, None)))
        with self._trouble():
            if not self._is_lost:
                self._say_goodbye()
        with self._trouble():
            self._recording.disconnect()
        self._is_lost, self._arrows = True, None  # nothing is sent from here on
        del self._recording
        with self._trouble():
            release_streams()

    def _say_goodbye(self) -> None:
        """Wait for the last rows to arrive; only here does rerun say that the viewer was closed."""
        try:
            self._recording.flush(timeout_sec=GOODBYE_S)
        except Exception:
            self._is_lost = True
            warnings.warn(
                "the viewer was closed, or did not answer, before it had seen the whole run", stacklevel=2
            )

    @contextmanager
    def _trouble(self) -> Iterator[None]:
        """Whatever goes wrong within costs the view, not the run."""
        try:
            yield
        except Exception as error:
            self._lose(error)

    def _show(self, rows: Rows) -> None:
        self._count += len(rows)
        if self._is_lost or len(rows) == 0:
            return
        self._send(rows.thinned(MOST_ROWS))

    def _send(self, rows: Rows) -> None:
        recording, setting = self._recording, self._setting
        plots = list(series_of(rows, setting, is_live=True))
        if self._stage is None:
            self._stage = open_stage(recording, rows, setting, plots, self._duration_s, is_live=True)
            self._arrows = Arrows(recording, setting, self._stage)
            self._has_flight = is_apart(rows, setting, self._stage)
        send_rows(recording, rows, setting, self._stage)
        for series in plots:
            send_series(recording, rows, self._continued(series))
        if self._arrows is not None:
            self._arrows.send(rows)
        joined = rows if self._before is None else rows.after(self._before)
        if "reference_pose" in rows:
            send_trails(recording, joined, setting, MOST_ROWS, "desired")
        if "tool_pose" in rows:
            send_trails(recording, joined, setting, MOST_ROWS, "obtained")
        if "position_eci" in rows:
            send_orbit_trail(recording, joined, MOST_ROWS)
        if self._has_flight:
            send_flight(recording, joined, setting, MOST_ROWS)
        self._before = rows.last()

    def _continued(self, series: Series) -> Series:
        """Angles without a jump of whole turns from those before."""
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
        warnings.warn(f"the viewer is gone, the run goes on without it: {error}", stacklevel=2)


def open_live(setting: Setting, duration_s: float) -> LiveView | None:
    """A viewer of its own on this machine's screen, or None, with a warning, where there is none."""
    if not has_screen():
        warnings.warn("there is no screen here: the run goes on without the viewer", stacklevel=2)
        return None
    try:
        url = open_viewer()
    except ViewerError as error:
        warnings.warn(f"{error}: the run goes on without it", stacklevel=2)
        return None
    try:
        recording = new_recording(setting)
        recording.connect_grpc(url)
    except Exception as error:
        warnings.warn(f"the viewer cannot be reached: the run goes on without it: {error}", stacklevel=2)
        return None
    return LiveView(recording, setting, duration_s)
