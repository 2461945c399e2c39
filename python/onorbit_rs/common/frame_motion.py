"""Motion of one frame as observed from another one."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from onorbit_rs.common.rotations import quaternion_from_matrix

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from onorbit_rs._core import Model

    Floats = NDArray[np.float64]


class FrameMotion(NamedTuple):
    """Motion of a frame relative to a second frame, in axes of the second frame; arrays (T, 3)."""

    position: Floats
    """Position of the origin, m."""
    rotation: Floats
    """Attitude as a rotation vector of at most π, rad."""
    velocity: Floats
    """Velocity of the origin as observed in the second frame, m/s."""
    rate: Floats
    """Relative angular velocity, rad/s."""


class MovingFrame(NamedTuple):
    """A frame of a robot with the configurations (T, nq) and velocities (T, nv) of the robot."""

    model: Model
    frame: str
    q: ArrayLike
    v: ArrayLike


def frame_motion(a: MovingFrame, b: MovingFrame) -> FrameMotion:
    """Return the motion of frame b relative to frame a, as a latch between them measures it.

    `r = R_aᵀ (p_b − p_a)`, `ω = R_aᵀ (ω_b − ω_a)`, `v = R_aᵀ (v_b − v_a − ω_a × (p_b − p_a))`, with the
    attitude `R`, origin `p`, velocity `v` and angular velocity `ω` of each frame in W.
    """
    (pose_a, twist_a), (pose_b, twist_b) = map(_pose_and_twist, (a, b))
    rot_aw = np.swapaxes(pose_a[:, :3, :3], 1, 2)
    apart = pose_b[:, :3, 3] - pose_a[:, :3, 3]
    slip = twist_b - twist_a
    slip[:, :3] -= np.cross(twist_a[:, 3:], apart)

    def in_a(vectors: Floats) -> Floats:
        found: Floats = np.einsum("tij,tj->ti", rot_aw, vectors)
        return found

    rotation = rotation_vector(quaternion_from_matrix(rot_aw @ pose_b[:, :3, :3]))
    return FrameMotion(in_a(apart), rotation, in_a(slip[:, :3]), in_a(slip[:, 3:]))


def rotation_vector(quat_xyzw: ArrayLike) -> Floats:
    """Return the rotation vectors (..., 3) of unit quaternions (..., 4), rad, of at most π."""
    quat = np.asarray(quat_xyzw, dtype=np.float64)
    quat = np.where(quat[..., 3:] < 0.0, -quat, quat)
    sine = np.linalg.norm(quat[..., :3], axis=-1, keepdims=True)
    # θ / sin(θ/2), which is 2 at θ = 0
    scale = np.where(sine > 1e-12, 2.0 * np.arctan2(sine, quat[..., 3:]) / np.maximum(sine, 1e-12), 2.0)
    vector: Floats = scale * quat[..., :3]
    return vector


def _pose_and_twist(moving: MovingFrame) -> tuple[Floats, Floats]:
    """Return the poses (T, 4, 4) and twists (T, 6) of a frame in W."""
    q, v = (np.ascontiguousarray(np.atleast_2d(values), dtype=np.float64) for values in (moving.q, moving.v))
    pose = np.asarray(moving.model.frame_pose(q, moving.frame))
    return pose, np.array(moving.model.frame_velocity(q, v, moving.frame))
