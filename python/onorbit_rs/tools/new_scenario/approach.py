"""Places a target in front of the tool that will capture it, and determines the target's approach."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs.common.coordinates import POSITION
from onorbit_rs.common.rotations import angle_between, quaternion_from_matrix

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Model

    Floats = NDArray[np.float64]

_HANDLES = (r"grapple", r"handle", r"grasp", r"dock", r"berth")
"""Patterns of the names of frames by which a spacecraft is captured, the most reliable first."""
_FACING = 0.3
"""Smallest cosine of the angle between tool axis and target for which the target is not rotated.

The direction of the target is that of the line from its handle to its centre of mass.
"""
_SEPARATION, _RECOIL = 0.02, 0.1
"""Relative speed of the craft after the release, m/s, unless the arm would recoil faster than ``_RECOIL``,
m/s.
"""
GAP_M = 0.1
"""Distance of the captured frame from the tool at the start, m."""
_IDENTITY = np.eye(3)


@dataclass(frozen=True)
class Approach:
    """Pose of the target relative to the tool, and the direction in which it approaches."""

    axis: list[float]
    """Unit vector from the tool to the captured frame, in axes of the tool."""
    position: list[float]
    """Position of the target's base in the tool frame, m."""
    quaternion: list[float]
    """Attitude of the target's base relative to the tool, xyzw."""
    direction: list[float]
    """Unit vector of the approach in axes of the target's base."""
    angle: float
    """Angle between the tool and the captured frame, rad."""
    impulse: float
    """Impulse of the spring at the release, N s, if the approach is the fastest of those tried."""


def find_handle(model: Model) -> str:
    """Return the frame by which a spacecraft is captured: a frame named like a handle, or the base link."""
    names = list(dict.fromkeys([*model.frame_names, *model.body_names]))
    for words in _HANDLES:
        for name in names:
            if re.search(words, name.lower()):
                return name
    return model.body_names[0]


def pointing(model: Model, frame: str) -> Floats:
    """Return the axis of a frame that points away from the robot, (3,), in axes of the frame.

    In the neutral configuration, the result is the coordinate axis nearest to the line from the last joint,
    or from the centre of mass if no joint moves the frame, to the frame; it is z if the line has length zero.
    """
    q = model.neutral()
    pose = np.asarray(model.frame_pose(q, frame))
    body = next((one.body for one in model.frames if one.name == frame), frame)
    is_moved = body in {joint.child for joint in model.joints}
    start = np.asarray(model.frame_pose(q, body))[:3, 3] if is_moved else np.asarray(model.center_of_mass(q))
    line = pose[:3, :3].T @ _unit(pose[:3, 3] - start)
    nearest = int(np.argmax(np.abs(line))) if line.any() else 2
    axis: Floats = _IDENTITY[nearest] * (-1.0 if line[nearest] < 0.0 else 1.0)
    return axis


def outwardness(model: Model, frame: str, q: Floats) -> Floats:
    """Return a measure (batch,), m, that is large if a tool is far from the robot and points away from it.

    The measure is the tool's distance from the centre of mass, times the cosine of the angle between the tool
    axis and the line from the centre of mass to the tool; 0 if negative. ``q`` has the shape (batch, nq).
    """
    axis, found = pointing(model, frame), []
    for row in q:
        pose = np.asarray(model.frame_pose(row, frame))
        found.append(pose[:3, :3] @ axis @ (pose[:3, 3] - np.asarray(model.center_of_mass(row))))
    return np.clip(np.array(found), 0.0, None)


def approach(chaser: Model, tool: str, q: Floats, target: Model, handle: str, q_target: Floats) -> Approach:
    """Return a placement in which the target lies on the far side of its handle, as seen from the tool.

    If possible, the axes of both frames are parallel; otherwise the target is rotated by multiples of 90°
    about the axes of the tool.
    """
    axis = pointing(chaser, tool)
    pose_wt = np.asarray(chaser.frame_pose(q, tool))
    pose_bh = np.asarray(target.frame_pose(q_target, handle))
    beyond = pose_bh[:3, :3].T @ _unit(np.asarray(target.center_of_mass(q_target)) - pose_bh[:3, 3])
    rotation = _IDENTITY
    if beyond.any() and axis @ beyond < _FACING:
        rotation = max(_rotations(), key=lambda rotation: float(axis @ rotation @ beyond))
    pose_th = np.eye(4)
    pose_th[:3, :3], pose_th[:3, 3] = rotation, GAP_M * axis
    pose_tb = pose_th @ np.linalg.inv(pose_bh)
    turn = angle_between(quaternion_from_matrix(rotation), np.array([0.0, 0.0, 0.0, 1.0]))
    masses = chaser.mass, target.mass
    reduced = masses[0] * masses[1] / (masses[0] + masses[1])
    recoiling = _effective_mass(chaser, tool, q, pose_wt[:3, :3] @ axis)
    return Approach(
        axis=axis.tolist(), position=_rounded(pose_tb[:3, 3], 5),
        quaternion=_rounded(quaternion_from_matrix(pose_tb[:3, :3]), 9),
        direction=_rounded(-pose_tb[:3, :3].T @ axis, 9), angle=float(turn),
        impulse=min(reduced * _SEPARATION, recoiling * _RECOIL),
    )  # fmt: skip


def _effective_mass(model: Model, frame: str, q: Floats, axis: Floats) -> float:
    """Return the effective mass `1 / (aᵀ J M⁻¹ Jᵀ a)`, kg, of a frame's motion along the axis `a` in W.

    `J` is the linear part of the frame's Jacobian, `M` the mass matrix.
    """
    row = axis @ np.asarray(model.frame_jacobian(q, frame))[POSITION]
    return 1.0 / float(row @ np.linalg.solve(np.asarray(model.mass_matrix(q)), row))


def _rotations() -> Iterator[Floats]:
    """Yield the rotations (3, 3), except the identity, that map coordinate axes to coordinate axes."""
    for order in itertools.permutations(range(3)):
        for signs in itertools.product((1.0, -1.0), repeat=3):
            rotation = _IDENTITY[list(order)] * np.array(signs)[:, None]
            if np.linalg.det(rotation) > 0.0 and not np.array_equal(rotation, _IDENTITY):
                yield rotation


def _unit(vector: Floats) -> Floats:
    """Return the unit vector along a vector, or zero for a vector shorter than 1 mm."""
    length = float(np.linalg.norm(vector))
    direction: Floats = vector / length if length > 1e-3 else np.zeros(3)
    return direction


def _rounded(values: Floats, decimals: int) -> list[float]:
    found: list[float] = (np.round(values, decimals) + 0.0).tolist()
    return found
