"""The robot and the path of its tool."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import rerun as rr
import rerun.blueprint as rrb

from onorbit_rs.rotations import matrix_from_quaternion, quaternion_from_matrix
from onorbit_rs.thinning import evenly
from onorbit_rs.viewer.axes import log_axes
from onorbit_rs.viewer.frames import (
    DESIRED,
    GOAL,
    LOCAL,
    WORLD,
    fix_frame,
    of_link,
    put_in,
    send_frame,
)
from onorbit_rs.viewer.letters import shown
from onorbit_rs.viewer.rows import TIMELINE
from onorbit_rs.viewer.solids import log_shape

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs.viewer.rows import Rows
    from onorbit_rs.viewer.setting import Setting

    Floats = NDArray[np.float64]

MOST_TRAIL_PIECES = 1000
MOVES = 1e-3
"""A tool that should go less far, in sizes of the robot, holds its pose."""

NEAR = 0.25
"""Length of axes seen from near, in lengths of the path."""

COLORS = {"desired": (240, 240, 240), "obtained": (255, 96, 64)}
TRAILS = {name: f"world/tool/{name}/trail" for name in COLORS}
UNTIL_NOW = rrb.VisibleTimeRanges(
    rrb.VisibleTimeRange(
        TIMELINE, start=rrb.TimeRangeBoundary.infinite(), end=rrb.TimeRangeBoundary.cursor_relative()
    )
)
"""What a view shows of a trail."""

_POSES = {"desired": "reference_pose", "obtained": "tool_pose"}


def log_robot(recording: rr.RecordingStream, setting: Setting) -> None:
    """Log the shapes of the robot, each in the frame of its link."""
    for index, shape in enumerate(setting.shapes):
        path = rr.new_entity_path(["world", "robot", shown(shape.link), f"visual_{index}"])
        for entity in log_shape(recording, path, shape):
            put_in(recording, entity, of_link(shape.link))


def send_desired(recording: rr.RecordingStream, rows: Rows) -> None:
    """Where the tool should be."""
    pose = rows["reference_pose"]
    send_frame(recording, rows.times, WORLD, DESIRED, pose[:, :3, 3], quaternion_from_matrix(pose[:, :3, :3]))


def path_length(rows: Rows, setting: Setting) -> float:
    """Diagonal of the box around the path that the tool should take, m; 0 where it has none."""
    if "reference_pose" not in rows:
        return 0.0
    points, _ = on_path(rows, rows["reference_pose"][:, :3, 3], setting)
    return float(np.linalg.norm(np.ptp(points, axis=0)))


def log_path(recording: rr.RecordingStream, rows: Rows, setting: Setting, size: float) -> None:
    """The whole path that the tool should take, static, and as dim axes where it ends."""
    points, frame = on_path(rows, rows["reference_pose"][:, :3, 3], setting)
    path, color = "world/tool/desired/path", COLORS["desired"]
    put_in(recording, path, frame)
    line = rr.LineStrips3D([_thinned(points)], colors=[color], radii=rr.Radius.ui_points(1.2))
    recording.log(path, line, static=True, strict=True)
    if (length := path_length(rows, setting)) > MOVES * size:
        pose_wp = _pose_of_path_frame(rows, setting)
        fix_frame(recording, frame, GOAL, np.linalg.inv(pose_wp) @ rows["reference_pose"][-1])
        log_axes(recording, "world/tool/desired/goal", GOAL, NEAR * length, brightness=0.6)


def send_trails(recording: rr.RecordingStream, rows: Rows, setting: Setting, most: int, *names: str) -> None:
    """What the tool has drawn so far, ``obtained`` or ``desired``."""
    for name in names:
        points, frame = on_path(rows, rows[_POSES[name]][:, :3, 3], setting)
        send_trail(recording, TRAILS[name], frame, rows, points, most, COLORS[name])


def send_trail(
    recording: rr.RecordingStream,
    path: str,
    frame: str,
    rows: Rows,
    points: Floats,
    most: int,
    color: tuple[int, int, int],
) -> None:
    """Points (T, 3) as at most so many short pieces, one per moment: those up to now are shown."""
    ends = evenly(len(points), most + 1)
    if len(ends) < 2:
        return
    put_in(recording, path, frame)
    pieces = np.stack([points[ends[:-1]], points[ends[1:]]], axis=1)
    count = len(pieces)
    columns = rr.LineStrips3D.columns(
        strips=list(pieces),
        colors=[color] * count,
        radii=[-2.5] * count,  # points of the screen
    )
    time = rr.TimeColumn(TIMELINE, duration=rows["time"][ends[1:]])
    recording.send_columns(path, [time], columns, strict=True)


def on_path(rows: Rows, position_w: Floats, setting: Setting) -> tuple[Floats, str]:
    """Positions (T, 3) in the frame in which the path is drawn, m, and its name."""
    if setting.path_frame == "lvlh" and rows.rot_wl is not None:
        return np.einsum("tji,tj->ti", rows.rot_wl, position_w), LOCAL
    if setting.path_frame == "base":
        rot_wb = matrix_from_quaternion(rows["q"][:, 3:7])
        return np.einsum("tji,tj->ti", rot_wb, position_w - rows["q"][:, :3]), of_link(setting.base)
    return position_w, WORLD


def _pose_of_path_frame(rows: Rows, setting: Setting) -> Floats:
    """(4, 4), W, at the end."""
    pose = np.eye(4)
    if setting.path_frame == "lvlh" and rows.rot_wl is not None:
        pose[:3, :3] = rows.rot_wl[-1]
    elif setting.path_frame == "base":
        q = rows["q"][-1]
        pose[:3, :3], pose[:3, 3] = matrix_from_quaternion(q[3:7]), q[:3]
    return pose


def _thinned(points: Floats, most: int = 5000) -> Floats:
    """At most so many of the points, first and last among them."""
    return points[evenly(len(points), most)]
