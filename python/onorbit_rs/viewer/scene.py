"""The bodies, paths and axes that move in the 3-D views."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import rerun as rr

from onorbit_rs.geometry import Shape
from onorbit_rs.rotations import has_local_frame, local_orbital_axes, quaternion_from_matrix
from onorbit_rs.viewer.blueprint import TIMELINE
from onorbit_rs.viewer.solids import log_shape

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Model, Trace

    Floats = NDArray[np.float64]
    Rows = NDArray[np.int64]

MOST_TRAIL_PIECES = 1000
EARTH_RADIUS_KM = 6378.137
_DESIRED, _OBTAINED = (235, 235, 235), (235, 64, 52)


def send_robot(
    recording: rr.RecordingStream,
    time: rr.TimeColumn,
    trace: Trace,
    model: Model,
    robot: list[Shape],
    rows: Rows,
) -> None:
    """Static geometry under one moving transform per link."""
    recording.log("world", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True, strict=True)
    q = np.ascontiguousarray(np.asarray(trace.q)[rows])
    base = model.body_names[0]
    for link in dict.fromkeys([base, *(shape.link for shape in robot)]):
        _send_poses(recording, time, f"world/robot/{link}", np.asarray(model.frame_pose(q, link)))
    for index, shape in enumerate(robot):
        log_shape(recording, f"world/robot/{shape.link}/visual_{index}", shape)
    _log_axes(recording, f"world/robot/{base}/axes", 0.5, "B")


def send_tool(recording: rr.RecordingStream, time: rr.TimeColumn, trace: Trace, rows: Rows) -> None:
    """Paths of the tool, desired and obtained, and where it is on them."""
    columns = trace.columns()
    if "reference_pose" in columns:
        desired = np.asarray(trace.reference_pose)[rows]
        path = rr.LineStrips3D([desired[:, :3, 3]], colors=[_DESIRED], radii=[0.002])
        recording.log("world/tool/desired/path", path, static=True, strict=True)
        _send_poses(recording, time, "world/tool/desired/now", desired)
        _log_axes(recording, "world/tool/desired/now", 0.06)
    if "tool_pose" in columns:
        obtained = np.asarray(trace.tool_pose)[rows]
        _send_trail(recording, trace, rows, obtained[:, :3, 3])
        _send_poses(recording, time, "world/tool/obtained/now", obtained)
        _log_axes(recording, "world/tool/obtained/now", 0.1)


def _send_trail(recording: rr.RecordingStream, trace: Trace, rows: Rows, path: Floats) -> None:
    """What the tool has drawn so far: one short piece per moment, shown up to the present one."""
    ends = np.unique(np.linspace(0, len(path) - 1, min(len(path), MOST_TRAIL_PIECES + 1)).astype(np.int64))
    if len(ends) < 2:
        return
    pieces = np.stack([path[ends[:-1]], path[ends[1:]]], axis=1)
    count = len(pieces)
    time = rr.TimeColumn(TIMELINE, duration=np.asarray(trace.time)[rows][ends[1:]])
    columns = rr.LineStrips3D.columns(strips=list(pieces), colors=[_OBTAINED] * count, radii=[0.005] * count)
    recording.send_columns("world/tool/obtained/trail", [time], columns, strict=True)


def send_frames(recording: rr.RecordingStream, time: rr.TimeColumn, trace: Trace, rows: Rows) -> None:
    """Inertial axes, and where there is an orbit the local orbital frame."""
    _log_axes(recording, "world/frames/inertial", 0.7, "I")
    if not has_local_frame(trace):
        return
    _send_poses(recording, time, "world/frames/lvlh", _local_orbital_poses(trace, rows))
    _log_axes(recording, "world/frames/lvlh", 0.6, "L")


def send_orbit(
    recording: rr.RecordingStream,
    time: rr.TimeColumn,
    trace: Trace,
    rows: Rows,
    orbit_path: Floats | None,
    has_planet: bool,
) -> None:
    """The planet, the path flown, one revolution of the reference, and L at the spacecraft: km."""
    if "position_eci" not in trace.columns():
        return
    position_km = np.asarray(trace.position_eci)[rows] / 1e3
    planet = rr.Ellipsoids3D(
        radii=[EARTH_RADIUS_KM], colors=[(60, 110, 170)], fill_mode=rr.components.FillMode.DenseWireframe
    )
    if has_planet:
        recording.log("orbit/planet", planet, static=True, strict=True)
    path = rr.LineStrips3D([position_km], colors=[_OBTAINED], radii=rr.Radius.ui_points(1.5))
    recording.log("orbit/path", path, static=True, strict=True)
    if orbit_path is not None:
        ring = rr.LineStrips3D([orbit_path / 1e3], colors=[(130, 130, 130)], radii=rr.Radius.ui_points(0.8))
        recording.log("orbit/reference", ring, static=True, strict=True)
    poses = np.tile(np.eye(4), (len(rows), 1, 1))
    if has_local_frame(trace):
        poses = _local_orbital_poses(trace, rows)
    poses[:, :3, 3] = position_km
    _send_poses(recording, time, "orbit/spacecraft", poses)
    _log_axes(recording, "orbit/spacecraft", 1500.0)


def _local_orbital_poses(trace: Trace, rows: Rows) -> Floats:
    """(T, 4, 4) attitude of L at W's origin."""
    position, velocity = np.asarray(trace.position_eci)[rows], np.asarray(trace.velocity_eci)[rows]
    poses = np.tile(np.eye(4), (len(rows), 1, 1))
    poses[:, :3, :3] = local_orbital_axes(position, velocity)
    return poses


def _send_poses(recording: rr.RecordingStream, time: rr.TimeColumn, path: str, poses: Floats) -> None:
    """A transform per step, from (T, 4, 4) poses."""
    columns = rr.Transform3D.columns(
        translation=poses[:, :3, 3], quaternion=quaternion_from_matrix(poses[:, :3, :3])
    )
    recording.send_columns(path, [time], columns, strict=True)


def _log_axes(recording: rr.RecordingStream, path: str, length: float, name: str = "") -> None:
    """Red x, green y, blue z of the entity's own frame; the tips carry the name of the frame, if any."""
    colors = [(230, 70, 60), (70, 190, 90), (80, 130, 240)]
    tips = np.eye(3) * length
    arrows = rr.Arrows3D(vectors=tips, colors=colors, radii=[length / 120.0])
    recording.log(path, arrows, static=True, strict=True)
    if name:
        labels = rr.Points3D(
            1.06 * tips,
            colors=colors,
            radii=[length / 200.0],
            labels=[f"{axis} {name}" for axis in "xyz"],
            show_labels=True,
        )
        recording.log(f"{path}/names", labels, static=True, strict=True)
