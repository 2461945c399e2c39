"""Relative motion: paths of base and targets in L of the reference orbit, in a separate view."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import rerun as rr
import rerun.blueprint as rrb

from onorbit_rs.common.coordinates import POSITION
from onorbit_rs.common.decimate import evenly_spaced
from onorbit_rs.common.display_units import amount, round_up
from onorbit_rs.viewer.axes import log_axes
from onorbit_rs.viewer.colors import BACKGROUND, ROBOT, TARGET
from onorbit_rs.viewer.frames import FOLLOW, LOCAL, ORIGIN, put_in
from onorbit_rs.viewer.scene import UNTIL_NOW, send_trail
from onorbit_rs.viewer.targets import frame_of_target

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs.viewer.colors import Color
    from onorbit_rs.viewer.setting import Setting
    from onorbit_rs.viewer.trace_rows import TraceRows

    Floats = NDArray[np.float64]

APART = 2.0
"""Smallest distance from the reference, in sizes of the robot, for which the view is shown."""

AXES = 0.15
"""Smallest length of the axes of L, as a fraction of the largest distance from the reference."""

_WHOLE = 0.5
"""Brightness of the path of the whole run, on which the path up to the current time is drawn."""


class Body(NamedTuple):
    """A base or a target: entity path, frame, label, colour, positions (T, 3) in L, m, and trace rows."""

    path: str
    frame: str
    label: str
    color: Color
    points: Floats
    rows: TraceRows


def flight_bodies(rows: TraceRows, setting: Setting, color: Color = ROBOT) -> list[Body]:
    """Return the base and the targets; empty if L is undefined."""
    if rows.rot_wl is None:
        return []
    found = [("base", setting.frame(FOLLOW), setting.label, color, rows["q"][:, POSITION])]
    for index, target in enumerate(setting.targets):
        place = target.position_at(rows["time"])
        found.append((f"target_{index}", frame_of_target(setting, index), "target", TARGET, place))
    return [
        Body(setting.entity(f"flight/{name}"), frame, label, color,
             np.einsum("tji,tj->ti", rows.rot_wl, place), rows)
        for name, frame, label, color, place in found
    ]  # fmt: skip


def is_apart(bodies: list[Body], size: float) -> bool:
    """Return True if a body is farther from the reference than :data:`APART` times ``size``, m."""
    return _farthest(bodies) > APART * size


def log_flight(recording: rr.RecordingStream, bodies: list[Body], axes: str = "world/flight/axes") -> None:
    """Log the axes of L, and the bodies with their names."""
    log_axes(recording, axes, LOCAL, _axes_length(bodies), ("x L", "y L", "z L"))
    for body in bodies:
        point = rr.Points3D(
            ORIGIN[None],
            colors=[body.color],
            radii=rr.Radius.ui_points(6.0),
            labels=[body.label],
            show_labels=True,
        )
        recording.log(body.path, point, static=True, strict=True)
        put_in(recording, body.path, body.frame)


def log_whole_flight(recording: rr.RecordingStream, bodies: list[Body], most: int = 5000) -> None:
    """Log the paths of the whole run in a dim colour, with at most ``most`` points each."""
    for body in bodies:
        points = body.points[evenly_spaced(len(body.points), most)]
        dim = (np.array(body.color) * _WHOLE).astype(np.uint8)
        line = rr.LineStrips3D([points], colors=[dim], radii=rr.Radius.ui_points(1.0))
        recording.log(f"{body.path}/whole", line, static=True, strict=True)
        put_in(recording, f"{body.path}/whole", LOCAL)


def send_flight(recording: rr.RecordingStream, bodies: list[Body], most: int) -> None:
    """Send the paths up to the current time, as at most ``most`` line segments each."""
    for body in bodies:
        send_trail(recording, f"{body.path}/trail", LOCAL, body.rows, body.points, most, body.color)


def flight_view(bodies: list[Body], contents: list[str] | None = None) -> rrb.View:
    """Return a view obliquely along the orbit normal: radial is up, along track is to the right.

    ``contents`` are the entities to show; by default all entities below ``world/flight``.
    """
    length = _axes_length(bodies)
    points = np.concatenate([np.eye(3) * length, *(body.points for body in bodies)])
    low, high = points.min(axis=0), points.max(axis=0)
    center, size = (low + high) / 2.0, float(np.linalg.norm(high - low))
    to_eye = np.array([0.45, -0.4, -0.8])
    return rrb.Spatial3DView(
        origin="world/flight" if contents is None else "world",
        contents=["$origin/**"] if contents is None else contents,
        name=f"Relative flight; axes of L are {amount(length, 'm')} long",
        spatial_information=rrb.SpatialInformation(LOCAL, show_axes=False),
        eye_controls=rrb.EyeControls3D(
            position=center + 1.1 * size * to_eye, look_target=center, eye_up=(1.0, 0.0, 0.0)
        ),
        background=BACKGROUND,
        line_grid=False,
        overrides={f"{body.path}/trail": UNTIL_NOW for body in bodies},
    )


def _farthest(bodies: list[Body]) -> float:
    """Return the greatest distance of the bodies from the reference, m; 0 without bodies."""
    return max((float(np.linalg.norm(body.points, axis=1).max()) for body in bodies), default=0.0)


def _axes_length(bodies: list[Body]) -> float:
    """Return the length of the axes of L, m: a round number that serves as a scale."""
    return round_up(AXES * _farthest(bodies))
