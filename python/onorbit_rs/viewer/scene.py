"""The robot and the path of its tool in the 3-D view."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import rerun as rr
import rerun.blueprint as rrb

from onorbit_rs.common.coordinates import POSITION, QUATERNION
from onorbit_rs.common.decimate import evenly_spaced
from onorbit_rs.common.rotations import matrix_from_quaternion, quaternion_from_matrix
from onorbit_rs.viewer.axes import log_axes
from onorbit_rs.viewer.font import shown
from onorbit_rs.viewer.frames import (
    DESIRED,
    GOAL,
    LOCAL,
    WORLD,
    fix_frame,
    put_in,
    send_frame,
)
from onorbit_rs.viewer.solids import log_shape, log_wireframe
from onorbit_rs.viewer.trace_rows import TIMELINE

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs.viewer.setting import Setting
    from onorbit_rs.viewer.trace_rows import TraceRows

    Floats = NDArray[np.float64]

MOST_TRAIL_PIECES = 1000
MOVES = 1e-3
"""Length of the tool's path, in sizes of the robot, below which the tool is considered at rest."""

NEAR = 0.25
"""Length of the axes in the close-up view, as a fraction of the length of the path."""

COLORS = {"desired": (240, 240, 240), "obtained": (255, 96, 64)}
UNTIL_NOW = rrb.VisibleTimeRanges(
    rrb.VisibleTimeRange(
        TIMELINE, start=rrb.TimeRangeBoundary.infinite(), end=rrb.TimeRangeBoundary.cursor_relative()
    )
)
"""Time range of the part of a trail that a view shows: from its start to the current time."""

_POSES = {"desired": "reference_pose", "obtained": "tool_pose"}


def log_robot(recording: rr.RecordingStream, setting: Setting) -> None:
    """Log the shapes of the robot, each in the frame of its link."""
    for index, shape in enumerate(setting.shapes):
        path = rr.new_entity_path([*setting.entity("robot").split("/"), shown(shape.link), f"visual_{index}"])
        for entity in log_shape(recording, path, shape):
            put_in(recording, entity, setting.frame_of(shape.link))


def log_collisions(recording: rr.RecordingStream, setting: Setting) -> None:
    """Log the collision shapes of the robot as wireframes, which the layout hides."""
    for index, shape in enumerate(setting.collisions):
        root = collisions_of(setting).split("/")
        path = rr.new_entity_path([*root, shown(shape.link), f"collision_{index}"])
        log_wireframe(recording, path, shape)
        put_in(recording, path, setting.frame_of(shape.link))


def collisions_of(setting: Setting) -> str:
    """Return the path of the entity with the collision shapes of a robot."""
    return setting.entity("collision")


def send_desired(recording: rr.RecordingStream, rows: TraceRows, setting: Setting) -> None:
    """Send the desired pose of the tool."""
    pose, desired = rows["reference_pose"], setting.frame(DESIRED)
    send_frame(recording, rows.times, WORLD, desired, pose[:, :3, 3], quaternion_from_matrix(pose[:, :3, :3]))


def path_length(rows: TraceRows, setting: Setting) -> float:
    """Return the diagonal of the box around the desired path, m; 0 if there is no desired path."""
    if "reference_pose" not in rows:
        return 0.0
    points, _ = on_path(rows, rows["reference_pose"][:, :3, 3], setting)
    return float(np.linalg.norm(np.ptp(points, axis=0)))


def log_path(recording: rr.RecordingStream, rows: TraceRows, setting: Setting, size: float) -> None:
    """Log the whole desired path, and dim axes at its end."""
    points, frame = on_path(rows, rows["reference_pose"][:, :3, 3], setting)
    path, color = setting.entity("tool/desired/path"), COLORS["desired"]
    put_in(recording, path, frame)
    line = rr.LineStrips3D([_decimated(points)], colors=[color], radii=rr.Radius.ui_points(1.2))
    recording.log(path, line, static=True, strict=True)
    if (length := path_length(rows, setting)) > MOVES * size:
        pose_wp = _pose_of_path_frame(rows, setting)
        goal = setting.frame(GOAL)
        fix_frame(recording, frame, goal, np.linalg.inv(pose_wp) @ rows["reference_pose"][-1])
        log_axes(recording, setting.entity("tool/desired/goal"), goal, NEAR * length, brightness=0.6)


def send_trails(
    recording: rr.RecordingStream, rows: TraceRows, setting: Setting, most: int, *names: str
) -> None:
    """Send the named trails of the tool to the viewer.

    A name is ``desired`` or ``obtained`` (the actual path).
    """
    for name in names:
        points, frame = on_path(rows, rows[_POSES[name]][:, :3, 3], setting)
        send_trail(recording, trail_of(setting, name), frame, rows, points, most, COLORS[name])


def trail_of(setting: Setting, name: str) -> str:
    """Return the path of the entity of a named trail."""
    return setting.entity(f"tool/{name}/trail")


def send_trail(
    recording: rr.RecordingStream,
    path: str,
    frame: str,
    rows: TraceRows,
    points: Floats,
    most: int,
    color: tuple[int, int, int],
) -> None:
    """Send points (T, 3) as at most ``most`` line segments with times; a view shows the past segments."""
    ends = evenly_spaced(len(points), most + 1)
    if len(ends) < 2:
        return
    put_in(recording, path, frame)
    pieces = np.stack([points[ends[:-1]], points[ends[1:]]], axis=1)
    count = len(pieces)
    columns = rr.LineStrips3D.columns(
        strips=list(pieces),
        colors=[color] * count,
        radii=[-2.5] * count,  # screen points
    )
    time = rr.TimeColumn(TIMELINE, duration=rows["time"][ends[1:]])
    recording.send_columns(path, [time], columns, strict=True)


def on_path(rows: TraceRows, position_w: Floats, setting: Setting) -> tuple[Floats, str]:
    """Return positions (T, 3), m, in the frame in which the path is drawn, and the name of that frame."""
    if setting.path_frame == "lvlh" and rows.rot_wl is not None:
        return np.einsum("tji,tj->ti", rows.rot_wl, position_w), LOCAL
    if setting.path_frame == "base":
        rot_wb = matrix_from_quaternion(rows["q"][:, QUATERNION])
        return np.einsum("tji,tj->ti", rot_wb, position_w - rows["q"][:, POSITION]), setting.frame_of(
            setting.base
        )
    return position_w, WORLD


def _pose_of_path_frame(rows: TraceRows, setting: Setting) -> Floats:
    """Return the pose (4, 4) in W of the frame in which the path is drawn, at the end of the run."""
    pose = np.eye(4)
    if setting.path_frame == "lvlh" and rows.rot_wl is not None:
        pose[:3, :3] = rows.rot_wl[-1]
    elif setting.path_frame == "base":
        q = rows["q"][-1]
        pose[:3, :3], pose[:3, 3] = matrix_from_quaternion(q[QUATERNION]), q[POSITION]
    return pose


def _decimated(points: Floats, most: int = 5000) -> Floats:
    """Return at most ``most`` of the points (k, 3), including the first and the last."""
    return points[evenly_spaced(len(points), most)]
