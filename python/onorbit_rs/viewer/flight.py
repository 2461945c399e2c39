"""How base and targets fly relative to the reference orbit: their paths in L, in a view of their own."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import rerun as rr
import rerun.blueprint as rrb

from onorbit_rs.thinning import evenly
from onorbit_rs.units import amount, round_up
from onorbit_rs.viewer.axes import log_axes
from onorbit_rs.viewer.colors import BACKGROUND, ROBOT, TARGET
from onorbit_rs.viewer.frames import FOLLOW, LOCAL, ORIGIN, put_in
from onorbit_rs.viewer.scene import UNTIL_NOW, send_trail
from onorbit_rs.viewer.targets import frame_of_target

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs.viewer.colors import Color
    from onorbit_rs.viewer.rows import Rows
    from onorbit_rs.viewer.setting import Setting
    from onorbit_rs.viewer.stage import Stage

    Floats = NDArray[np.float64]

APART = 2.0
"""Nearer to the reference than so many sizes of the robot there is no such view."""

AXES = 0.15
"""Least length of the axes of L, as a share of the farthest distance."""

_WHOLE = 0.5
"""Brightness of the whole path, over which the trail is drawn."""


class _Flier(NamedTuple):
    """The base or a target: entity, own frame, label, colour, and positions (T, 3) in L, m."""

    path: str
    frame: str
    label: str
    color: Color
    points: Floats


def is_apart(rows: Rows, setting: Setting, stage: Stage) -> bool:
    """Whether somebody flies so far from the reference that it is worth a view."""
    return _reach(_fliers(rows, setting)) > APART * stage.size


def log_flight(recording: rr.RecordingStream, rows: Rows, setting: Setting) -> None:
    """L at its origin, and who flies under its name."""
    fliers = _fliers(rows, setting)
    log_axes(recording, "world/flight/axes", LOCAL, _axes_length(fliers), ("x L", "y L", "z L"))
    for flier in fliers:
        point = rr.Points3D(
            ORIGIN[None],
            colors=[flier.color],
            radii=rr.Radius.ui_points(6.0),
            labels=[flier.label],
            show_labels=True,
        )
        recording.log(flier.path, point, static=True, strict=True)
        put_in(recording, flier.path, flier.frame)


def log_whole_flight(recording: rr.RecordingStream, rows: Rows, setting: Setting, most: int = 5000) -> None:
    """The paths to their end, dim."""
    for flier in _fliers(rows, setting):
        points = flier.points[evenly(len(flier.points), most)]
        dim = (np.array(flier.color) * _WHOLE).astype(np.uint8)
        line = rr.LineStrips3D([points], colors=[dim], radii=rr.Radius.ui_points(1.0))
        recording.log(f"{flier.path}/whole", line, static=True, strict=True)
        put_in(recording, f"{flier.path}/whole", LOCAL)


def send_flight(recording: rr.RecordingStream, rows: Rows, setting: Setting, most: int) -> None:
    """The paths up to now."""
    for flier in _fliers(rows, setting):
        send_trail(recording, f"{flier.path}/trail", LOCAL, rows, flier.points, most, flier.color)


def flight_view(rows: Rows, setting: Setting) -> rrb.View:
    """Radially outward is up, along the track to the right; looked at from beside the plane of the orbit."""
    fliers = _fliers(rows, setting)
    length = _axes_length(fliers)
    points = np.concatenate([np.eye(3) * length, *(flier.points for flier in fliers)])
    low, high = points.min(axis=0), points.max(axis=0)
    center, size = (low + high) / 2.0, float(np.linalg.norm(high - low))
    to_eye = np.array([0.45, -0.4, -0.8])
    return rrb.Spatial3DView(
        origin="world/flight",
        name=f"Relative flight; axes of L are {amount(length, 'm')} long",
        spatial_information=rrb.SpatialInformation(LOCAL, show_axes=False),
        eye_controls=rrb.EyeControls3D(
            position=center + 1.1 * size * to_eye, look_target=center, eye_up=(1.0, 0.0, 0.0)
        ),
        background=BACKGROUND,
        line_grid=False,
        overrides={f"{flier.path}/trail": UNTIL_NOW for flier in fliers},
    )


def _fliers(rows: Rows, setting: Setting) -> list[_Flier]:
    """None where there is no L."""
    if rows.rot_wl is None:
        return []
    found = [("base", FOLLOW, setting.robot, ROBOT, rows["q"][:, :3])]
    for index, target in enumerate(setting.targets):
        place = target.position_at(rows["time"])
        found.append((f"target_{index}", frame_of_target(index), "target", TARGET, place))
    return [
        _Flier(f"world/flight/{name}", frame, label, color, np.einsum("tji,tj->ti", rows.rot_wl, place))
        for name, frame, label, color, place in found
    ]


def _reach(fliers: list[_Flier]) -> float:
    """Farthest from the reference, m."""
    return max((float(np.linalg.norm(flier.points, axis=1).max()) for flier in fliers), default=0.0)


def _axes_length(fliers: list[_Flier]) -> float:
    """A round one, which tells the scale, m."""
    return round_up(AXES * _reach(fliers))
