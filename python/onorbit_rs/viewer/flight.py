"""How base and targets fly relative to the reference orbit: their paths in L, in a view of their own."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import rerun as rr
import rerun.blueprint as rrb

from onorbit_rs.thinning import evenly
from onorbit_rs.viewer.axes import log_axes
from onorbit_rs.viewer.frames import FOLLOW, LOCAL, put_in
from onorbit_rs.viewer.scene import UNTIL_NOW, send_trail
from onorbit_rs.viewer.targets import frame_of_target, position_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from onorbit_rs.viewer.rows import Rows
    from onorbit_rs.viewer.setting import Setting
    from onorbit_rs.viewer.stage import Stage

    Floats = NDArray[np.float64]

APART = 2.0
"""Nearer to the reference than so many sizes of the robot there is no such view."""

AXES = 0.25
"""Length of the axes of L, as a share of the farthest distance."""

_BASE, _TARGET = (255, 220, 120), (205, 170, 90)
_WHOLE = 0.5
"""Brightness of the whole path, over which the trail is drawn."""


def is_apart(rows: Rows, setting: Setting, stage: Stage) -> bool:
    """Whether somebody flies so far from the reference that it is worth a view."""
    paths = list(_paths(rows, setting))
    return bool(paths) and _reach(paths) > APART * stage.size


def log_flight(recording: rr.RecordingStream, rows: Rows, setting: Setting) -> None:
    """L at its origin, and the names of who flies."""
    paths = list(_paths(rows, setting))
    log_axes(recording, "world/flight/axes", LOCAL, AXES * _reach(paths), ("x L", "y L", "z L"))
    frames = [FOLLOW, *(frame_of_target(index) for index in range(len(setting.targets)))]
    for (name, color, _), frame in zip(paths, frames, strict=True):
        path = _path(name)
        put_in(recording, path, frame)
        label = setting.robot if name == "base" else "target"
        point = rr.Points3D([np.zeros(3)], colors=[color], radii=rr.Radius.ui_points(6.0), labels=[label],
                            show_labels=True)  # fmt: skip
        recording.log(path, point, static=True, strict=True)


def log_whole_flight(recording: rr.RecordingStream, rows: Rows, setting: Setting, most: int = 5000) -> None:
    """The paths to their end, dim."""
    for name, color, points in _paths(rows, setting):
        path, dim = f"{_path(name)}/whole", (np.array(color) * _WHOLE).astype(np.uint8)
        put_in(recording, path, LOCAL)
        line = rr.LineStrips3D(
            [points[evenly(len(points), most)]], colors=[dim], radii=rr.Radius.ui_points(1.0)
        )
        recording.log(path, line, static=True, strict=True)


def send_flight(recording: rr.RecordingStream, rows: Rows, setting: Setting, most: int) -> None:
    """The paths up to now."""
    for name, color, points in _paths(rows, setting):
        send_trail(recording, f"{_path(name)}/trail", LOCAL, rows, points, most, color)


def flight_view(rows: Rows, setting: Setting) -> rrb.View:
    """Radially outward is up, along the track to the right; looked at from beside the plane of the orbit."""
    paths = list(_paths(rows, setting))
    points = np.concatenate([np.eye(3) * AXES * _reach(paths), *(points for *_, points in paths)])
    low, high = points.min(axis=0), points.max(axis=0)
    center, length = (low + high) / 2.0, float(np.linalg.norm(high - low))
    eye = np.array([0.45, -0.4, -0.8])
    return rrb.Spatial3DView(
        origin="world/flight",
        name="Flight relative to the reference, axes of L",
        spatial_information=rrb.SpatialInformation(LOCAL, show_axes=False),
        eye_controls=rrb.EyeControls3D(
            position=center + 1.1 * length * eye / np.linalg.norm(eye), look_target=center,
            eye_up=(1.0, 0.0, 0.0),
        ),
        background=(28, 31, 38),
        line_grid=False,
        overrides={f"{_path(name)}/trail": UNTIL_NOW for name in _names(setting)},
    )  # fmt: skip


def _path(name: str) -> str:
    return f"world/flight/{name}"


def _names(setting: Setting) -> list[str]:
    return ["base", *(f"target_{index}" for index in range(len(setting.targets)))]


def _paths(rows: Rows, setting: Setting) -> Iterator[tuple[str, tuple[int, int, int], Floats]]:
    """Name, colour and positions (T, 3) in L, m, of base and targets; none where there is no L."""
    if rows.rot_wl is None:
        return
    places = [rows["q"][:, :3], *(position_of(target, rows["time"]) for target in setting.targets)]
    for name, place in zip(_names(setting), places, strict=True):
        yield name, _BASE if name == "base" else _TARGET, np.einsum("tji,tj->ti", rows.rot_wl, place)


def _reach(paths: list[tuple[str, tuple[int, int, int], Floats]]) -> float:
    """Farthest from the reference, m."""
    return max(float(np.linalg.norm(points, axis=1).max()) for *_, points in paths)
