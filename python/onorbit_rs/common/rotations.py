"""Rotations as arrays: quaternions (x, y, z, w), matrices and angles; used for input and output only."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from onorbit_rs._core import Trace

    Floats = NDArray[np.float64]


def matrix_from_quaternion(quat_xyzw: ArrayLike) -> Floats:
    """Return the rotation matrices (..., 3, 3) of unit quaternions (..., 4)."""
    quat = np.asarray(quat_xyzw, dtype=np.float64)
    vector, w = quat[..., :3], quat[..., 3, None, None]
    cross = np.zeros((*quat.shape[:-1], 3, 3))
    cross[..., 0, 1], cross[..., 0, 2], cross[..., 1, 2] = -vector[..., 2], vector[..., 1], -vector[..., 0]
    cross -= np.swapaxes(cross, -1, -2)
    # R = 1 + 2 w [u] + 2 [u][u]
    rotation: Floats = np.eye(3) + 2.0 * w * cross + 2.0 * cross @ cross
    return rotation


def quaternion_from_matrix(rotation: ArrayLike) -> Floats:
    """Return the unit quaternions (..., 4), xyzw with w ≥ 0, of rotation matrices (..., 3, 3)."""
    r = np.asarray(rotation, dtype=np.float64)
    xx, yy, zz = r[..., 0, 0], r[..., 1, 1], r[..., 2, 2]
    # with c the component of largest magnitude, 4 c times each component is a sum of entries of R
    best = np.argmax(np.stack([xx, yy, zz, xx + yy + zz]), axis=0)
    quat = np.empty((*best.shape, 4))
    for largest in np.unique(best):
        rows = best == largest
        quat[rows] = _times_four_components(r[rows], largest)
    quat /= np.linalg.norm(quat, axis=-1, keepdims=True)
    return np.where(quat[..., 3:] < 0.0, -quat, quat)


def _times_four_components(r: Floats, largest: int) -> Floats:
    """Return the quaternions (k, 4) of matrices (k, 3, 3) times `4 c`, with `c` the component ``largest``."""
    xx, yy, zz = r[:, 0, 0], r[:, 1, 1], r[:, 2, 2]
    yz, zx, xy = r[:, 2, 1], r[:, 0, 2], r[:, 1, 0]
    zy, xz, yx = r[:, 1, 2], r[:, 2, 0], r[:, 0, 1]
    rows = {
        0: (1 + xx - yy - zz, xy + yx, zx + xz, yz - zy),
        1: (xy + yx, 1 - xx + yy - zz, yz + zy, zx - xz),
        2: (zx + xz, yz + zy, 1 - xx - yy + zz, xy - yx),
        3: (yz - zy, zx - xz, xy - yx, 1 + xx + yy + zz),
    }
    return np.stack(rows[largest], axis=-1)


def product(p: ArrayLike, q: ArrayLike) -> Floats:
    """Return the quaternions (..., 4), xyzw, of rotations by `q` and then by `p`: `rot_p rot_q`."""
    px, py, pz, pw = np.moveaxis(np.asarray(p, dtype=np.float64), -1, 0)
    qx, qy, qz, qw = np.moveaxis(np.asarray(q, dtype=np.float64), -1, 0)
    return np.stack(
        [
            pw * qx + px * qw + py * qz - pz * qy,
            pw * qy - px * qz + py * qw + pz * qx,
            pw * qz + px * qy - py * qx + pz * qw,
            pw * qw - px * qx - py * qy - pz * qz,
        ],
        axis=-1,
    )


def conjugate(quat_xyzw: ArrayLike) -> Floats:
    """Return the quaternions (..., 4) of the inverse rotations."""
    inverse: Floats = np.asarray(quat_xyzw, dtype=np.float64) * [-1.0, -1.0, -1.0, 1.0]
    return inverse


def quaternion_from_roll_pitch_yaw(angles: ArrayLike) -> Floats:
    """Return the unit quaternion (4,), xyzw, of rotations (rad) about the fixed x, then y, then z axis."""
    (sr, sp, sy), (cr, cp, cy) = np.sin(np.asarray(angles) / 2.0), np.cos(np.asarray(angles) / 2.0)
    return np.array(
        [
            sr * cp * cy - cr * sp * sy,
            cr * sp * cy + sr * cp * sy,
            cr * cp * sy - sr * sp * cy,
            cr * cp * cy + sr * sp * sy,
        ]
    )


def roll_pitch_yaw(quat_xyzw: ArrayLike) -> Floats:
    """Return the angles (..., 3), rad, about the fixed x, then y, then z axis, of unit quaternions (..., 4).

    The angles are singular at a pitch of ±90°.
    """
    x, y, z, w = np.moveaxis(np.asarray(quat_xyzw, dtype=np.float64), -1, 0)
    # the entries of R in its first column and last row
    r00, r10, r20 = 1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)
    r21, r22 = 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)
    return np.stack(
        [np.arctan2(r21, r22), np.arctan2(-r20, np.hypot(r00, r10)), np.arctan2(r10, r00)], axis=-1
    )


def angle_between(quat_xyzw: ArrayLike, other_xyzw: ArrayLike) -> Floats:
    """Return the angle (...), rad, from 0 to π, between attitudes given as unit quaternions (..., 4)."""
    a, b = np.asarray(quat_xyzw), np.asarray(other_xyzw)
    b = np.where(np.sum(a * b, axis=-1, keepdims=True) < 0.0, -b, b)
    # accurate for small angles, unlike the arc cosine of the dot product
    half: Floats = np.arctan2(np.linalg.norm(a - b, axis=-1), np.linalg.norm(a + b, axis=-1))
    return 4.0 * half


def local_orbital_axes(position: ArrayLike, velocity: ArrayLike) -> Floats:
    """Return the rotation (..., 3, 3) from L (x radial, z along angular momentum) to inertial axes."""
    r, v = np.asarray(position, dtype=np.float64), np.asarray(velocity, dtype=np.float64)
    x = r / np.linalg.norm(r, axis=-1, keepdims=True)
    momentum = np.cross(r, v)
    z = momentum / np.linalg.norm(momentum, axis=-1, keepdims=True)
    return np.stack([x, np.cross(z, x), z], axis=-1)


def has_local_frame(trace: Trace) -> bool:
    """Return whether the run has a reference orbit on which L is defined at all times."""
    return "reference_position_eci" in trace.columns() and is_local_frame_defined(
        trace.reference_position_eci, trace.reference_velocity_eci
    )


def is_local_frame_defined(position: ArrayLike, velocity: ArrayLike) -> bool:
    """Return whether L is defined in all rows (T, 3): no velocity may be zero or parallel to the position."""
    r, v = np.asarray(position), np.asarray(velocity)
    momentum = np.linalg.norm(np.cross(r, v), axis=-1)
    return bool(np.all(momentum > 1e-10 * np.linalg.norm(r, axis=-1) * np.linalg.norm(v, axis=-1)))


def attitude_in_orbit(quat_xyzw: ArrayLike, position: ArrayLike, velocity: ArrayLike) -> Floats:
    """Return roll, pitch and yaw (T, 3), rad, unwrapped, of attitudes (T, 4) relative to L of an orbit."""
    quat_il = quaternion_from_matrix(local_orbital_axes(position, velocity))
    return np.unwrap(roll_pitch_yaw(product(conjugate(quat_il), quat_xyzw)), axis=0)
