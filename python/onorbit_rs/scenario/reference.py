"""The engine's reference from the scenario's."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs import _core
from onorbit_rs.exceptions import FrameError
from onorbit_rs.names import did_you_mean, nearest
from onorbit_rs.rotations import matrix_from_quaternion
from onorbit_rs.scenario import joint_reference_parts as joint_parts
from onorbit_rs.scenario import reference_parts as parts
from onorbit_rs.scenario.start import joint_values, quaternion_of
from onorbit_rs.scenario.table import read_table
from onorbit_rs.scenario.task_frame import TargetFrame

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs.scenario.initial import Attitude

    Floats = NDArray[np.float64]

LIMITS = {"duration", "speed", "acceleration", "angular_speed", "angular_acceleration"}
COLUMNS = {
    "time": ("time",),
    "position": ("x", "y", "z"),
    "attitude": ("qx", "qy", "qz", "qw"),
    "velocity": ("vx", "vy", "vz", "wx", "wy", "wz"),
}
"""Columns of a file of poses; SI."""


@dataclass(frozen=True)
class Start:
    """What a reference begins from."""

    model: _core.Model
    q: Floats
    """Configuration (nq,)."""
    tool_pose: Floats | None
    """(4, 4) in W."""
    orbit: _core.Orbit | None
    folder: Path
    """That files are beside."""
    joints: tuple[str, ...] | None = None
    """The group a joint reference is for; all joints where not given."""


def reference_of(part: parts.AnyReference | None, at: Start) -> _core.Reference | _core.JointReference:
    """What is tracked; a tool without a reference is held where it starts."""
    if isinstance(part, parts.TaskReference) or part is None:
        return _task(part or parts.HoldReference(), at)
    return _joints(part, at)


def _task(part: parts.TaskReference, at: Start) -> _core.Reference:
    frame: Any = part.frame
    if isinstance(part.frame, TargetFrame):
        motion = part.frame.target
        pose = _pose(motion.position, motion.attitude)
        frame = _core.Target(pose, velocity=np.array(motion.velocity), spin=np.array(motion.spin))
    start = _first_pose(part, at)
    limits: dict[str, Any] = part.model_dump(include=LIMITS, exclude_none=True)
    match part:
        case parts.LineParabolaReference():
            return _core.LineParabola(
                start, displacement=np.array(part.displacement), height=np.array(part.height),
                duration=part.duration, frame=frame,
            )  # fmt: skip
        case parts.LineReference():
            return _core.Line(start, _goal(part.goal, start), frame=frame, **limits)
        case parts.CircleReference():
            shape: dict[str, Any] = {
                "center": start[:3, 3] + part.center, "axis": np.array(part.axis), "angle": part.angle,
                "turns": part.turns, "ramp": part.ramp, "frame": frame,
            }  # fmt: skip
            if isinstance(part, parts.ScrewReference):
                return _core.Screw(start, advance=part.advance, **shape, **limits)
            return _core.Circle(start, **shape, **limits)
        case parts.WaypointsReference():
            poses = np.array([start, *(_goal(goal, start) for goal in part.points)])
            times = None if part.times is None else np.array([0.0, *part.times])
            return _core.Waypoints(poses, times=times, stops=part.stops, frame=frame, **limits)
        case parts.SampledReference():
            return _sampled(part, start, at.folder, frame)
    return _core.Hold(start, frame=frame)


def _first_pose(part: parts.TaskReference, at: Start) -> Floats:
    """Where the path begins, in its own frame."""
    if part.start is not None:
        return _pose(part.start.position, part.start.attitude)
    assert at.tool_pose is not None, "a task reference is built for a tool"
    frame = np.eye(4)
    if isinstance(part.frame, TargetFrame):
        frame = _pose(part.frame.target.position, part.frame.target.attitude)
    elif part.frame == "base":
        frame[:3, :3], frame[:3, 3] = matrix_from_quaternion(at.q[3:7]), at.q[:3]
    elif part.frame == "lvlh" and at.orbit is not None:
        frame[:3, :3] = at.orbit.lvlh(0.0)[0]
    rot, pos = frame[:3, :3], frame[:3, 3]
    start = np.eye(4)
    start[:3, :3], start[:3, 3] = rot.T @ at.tool_pose[:3, :3], rot.T @ (at.tool_pose[:3, 3] - pos)
    return start


def _pose(position: list[float], attitude: Attitude | None) -> Floats:
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = matrix_from_quaternion(quaternion_of(attitude)), position
    return pose


def _goal(goal: parts.Goal, start: Floats) -> Floats:
    pose = start.copy()
    if goal.turn is not None:
        pose[:3, :3] = matrix_from_quaternion(quaternion_of(goal.turn)) @ start[:3, :3]
    if goal.attitude is not None:
        pose[:3, :3] = matrix_from_quaternion(quaternion_of(goal.attitude))
    if goal.displacement is not None:
        pose[:3, 3] += goal.displacement
    if goal.position is not None:
        pose[:3, 3] = goal.position
    return pose


def _sampled(part: parts.SampledReference, start: Floats, folder: Path, frame: Any) -> _core.Sampled:
    table = read_table(folder / part.file, COLUMNS, ("time", "position", "attitude"))
    quats, velocities = table["attitude"], table.get("velocity")
    poses = np.tile(np.eye(4), (len(quats), 1, 1))
    poses[:, :3, :3] = matrix_from_quaternion(quats / np.linalg.norm(quats, axis=1, keepdims=True))
    poses[:, :3, 3] = table["position"]
    if part.relative:
        turn = start[:3, :3] @ poses[0, :3, :3].T
        poses[:, :3, 3] = start[:3, 3] + (poses[:, :3, 3] - poses[0, :3, 3]) @ turn.T
        poses[:, :3, :3] = turn @ poses[:, :3, :3]
        if velocities is not None:
            velocities = np.concatenate([velocities[:, :3] @ turn.T, velocities[:, 3:] @ turn.T], axis=1)
    return _core.Sampled(table["time"].ravel(), poses, velocities=velocities, frame=frame)


def _joints(part: Any, at: Start) -> _core.JointReference:
    every = list(at.model.joint_names)
    group = list(at.joints or every)
    indices = [every.index(name) for name in group]
    first = at.q[7:][indices]
    if isinstance(part, joint_parts.JointHoldReference):
        return _core.JointHold(joint_values("joints", part.joints, at.q[7:], at.model)[indices])
    if isinstance(part, joint_parts.JointSampledReference):
        columns = {name: (name,) for name in ("time", *group)}
        table = read_table(at.folder / part.file, columns, ("time",))
        time = table.pop("time").ravel()
        positions = np.tile(first, (len(time), 1))
        for name, column in table.items():
            positions[:, group.index(name)] = column.ravel()
        return _core.JointSampled(time, positions)
    times = None if part.times is None else np.array([0.0, *part.times])
    timing: dict[str, Any] = {"times": times, "speed": part.speed, "acceleration": part.acceleration}
    if isinstance(part, joint_parts.JointRampsReference):
        return _core.JointWaypoints.one_by_one(first, [_move(move, group) for move in part.moves], **timing)
    points, now = [first], at.q[7:]
    for point in part.points:
        now = joint_values("points", point, now, at.model)
        points.append(now[indices])
    return _core.JointWaypoints(np.array(points), stops=part.stops, **timing)


def _move(move: joint_parts.JointMove, group: list[str]) -> tuple[int, float]:
    if move.joint not in group:
        raise FrameError(
            f"moves: no joint is named {move.joint!r}{did_you_mean(move.joint, group)}",
            name=move.joint, kind="joint", known=group, suggestion=nearest(move.joint, group),
        )  # fmt: skip
    return group.index(move.joint), move.to
