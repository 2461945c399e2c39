"""Rotations as arrays: quaternions (x, y, z, w), matrices, angles. For reporting; the engine has its own."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from onorbit_rs._core import Trace

    Floats = NDArray[np.float64]


def matrix_from_quaternion(quat_xyzw: ArrayLike) -> Floats:
    """Rotation matrices (..., 3, 3) of unit quaternions (..., 4)."""
    quat = np.asarray(quat_xyzw, dtype=np.float64)
    vector, w = quat[..., :3], quat[..., 3, None, None]
    cross = np.zeros((*quat.shape[:-1], 3, 3))
    cross[..., 0, 1], cross[..., 0, 2], cross[..., 1, 2] = -vector[..., 2], vector[..., 1], -vector[..., 0]
    cross -= np.swapaxes(cross, -1, -2)
    # R = 1 + 2 w [u] + 2 [u][u]
    rotation: Floats = np.eye(3) + 2.0 * w * cross + 2.0 * cross @ cross
    return rotation


def quaternion_from_matrix(rotation: ArrayLike) -> Floats:
    """Unit quaternions (..., 4), xyzw with w ≥ 0, of rotation matrices (..., 3, 3)."""
    r = np.asarray(rotation, dtype=np.float64)
    xx, yy, zz = r[..., 0, 0], r[..., 1, 1], r[..., 2, 2]
    # With c the largest component in amount, 4 c times the quaternion is a row of sums of entries of R.
    best = np.argmax(np.stack([xx, yy, zz, xx + yy + zz]), axis=0)
    quat = np.empty((*best.shape, 4))
    for largest in np.unique(best):
        rows = best == largest
        quat[rows] = _times_four_components(r[rows], largest)
    quat /= np.linalg.norm(quat, axis=-1, keepdims=True)
    return np.where(quat[..., 3:] < 0.0, -quat, quat)


def _times_four_components(r: Floats, largest: int) -> Floats:
    """`4 c` times the quaternions (k, 4) of matrices (k, 3, 3), with `c` one of the components."""
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
    """Quaternions (..., 4), xyzw, of `rot_p rot_q`: first `q`, then `p` in the same fixed axes."""
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
    """Quaternions (..., 4) of the inverse rotations."""
    inverse: Floats = np.asarray(quat_xyzw, dtype=np.float64) * [-1.0, -1.0, -1.0, 1.0]
    return inverse


def quaternion_from_roll_pitch_yaw(angles: ArrayLike) -> Floats:
    """Unit quaternion (4,), xyzw, of rotations (rad) about the fixed x, then y, then z."""
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
    """Angles (..., 3), rad, about the fixed x, then y, then z; ambiguous at pitch ±90 degrees."""
    x, y, z, w = np.moveaxis(np.asarray(quat_xyzw, dtype=np.float64), -1, 0)
    # Five entries of R; of its first column and last row.
    r00, r10, r20 = 1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)
    r21, r22 = 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)
    return np.stack(
        [np.arctan2(r21, r22), np.arctan2(-r20, np.hypot(r00, r10)), np.arctan2(r10, r00)], axis=-1
    )


def angle_between(quat_xyzw: ArrayLike, other_xyzw: ArrayLike) -> Floats:
    """Angle (...), rad, from 0 to π, of the rotation that takes one attitude to the other."""
    a, b = np.asarray(quat_xyzw), np.asarray(other_xyzw)
    b = np.where(np.sum(a * b, axis=-1, keepdims=True) < 0.0, -b, b)
    # Exact for small angles, where the arc cosine of the dot product is not.
    half: Floats = np.arctan2(np.linalg.norm(a - b, axis=-1), np.linalg.norm(a + b, axis=-1))
    return 4.0 * half


def local_orbital_axes(position: ArrayLike, velocity: ArrayLike) -> Floats:
    """Rotation (..., 3, 3) from L to the inertial frame: x radial outward, z along the angular momentum."""
    r, v = np.asarray(position, dtype=np.float64), np.asarray(velocity, dtype=np.float64)
    x = r / np.linalg.norm(r, axis=-1, keepdims=True)
    momentum = np.cross(r, v)
    z = momentum / np.linalg.norm(momentum, axis=-1, keepdims=True)
    return np.stack([x, np.cross(z, x), z], axis=-1)


def reference_motion(
    q: ArrayLike, v: ArrayLike, position_eci: ArrayLike, velocity_eci: ArrayLike
) -> tuple[Floats, Floats]:
    """Positions and velocities (T, 3) of W's origin, inertial axes, from columns of a trace.

    `r_w = r - p`, `v_w = ṙ - R v_b`: the trace's `q` stays relative to the reference orbit of the run,
    whatever orbit it was integrated about. What is left of rounding where the reference stands is zero.
    """
    configuration, rates = np.asarray(q), np.asarray(v)
    rot_wb = matrix_from_quaternion(configuration[:, 3:7])
    r, rate = np.asarray(position_eci), np.asarray(velocity_eci)
    r_w = r - configuration[:, :3]
    v_w = rate - np.einsum("tij,tj->ti", rot_wb, rates[:, :3])
    return _without_rounding(r_w, r), _without_rounding(v_w, rate)


def _without_rounding(difference: Floats, of: Floats) -> Floats:
    """Rows (T, 3) that are no more than rounding of what they were taken from become zero."""
    small = np.linalg.norm(difference, axis=-1) <= 1e-12 * np.linalg.norm(of, axis=-1)
    return np.where(small[:, None], 0.0, difference)


def reference_motion_of(trace: Trace) -> tuple[Floats, Floats]:
    """As :func:`reference_motion`, of a run in orbit."""
    return reference_motion(trace.q, trace.v, trace.position_eci, trace.velocity_eci)


def has_local_frame(trace: Trace) -> bool:
    """Whether the run has a reference orbit on which L is defined all along."""
    return "position_eci" in trace.columns() and is_local_frame_defined(*reference_motion_of(trace))


def is_local_frame_defined(position: ArrayLike, velocity: ArrayLike) -> bool:
    """Whether an orbit (T, 3) neither stands nor moves radially at any time."""
    r, v = np.asarray(position), np.asarray(velocity)
    momentum = np.linalg.norm(np.cross(r, v), axis=-1)
    return bool(np.all(momentum > 1e-10 * np.linalg.norm(r, axis=-1) * np.linalg.norm(v, axis=-1)))


def attitude_in_orbit(quat_xyzw: ArrayLike, position: ArrayLike, velocity: ArrayLike) -> Floats:
    """Roll, pitch and yaw (T, 3), rad, unwrapped, of attitudes (T, 4) relative to L of an orbit (T, 3)."""
    quat_il = quaternion_from_matrix(local_orbital_axes(position, velocity))
    return np.unwrap(roll_pitch_yaw(product(conjugate(quat_il), quat_xyzw)), axis=0)
