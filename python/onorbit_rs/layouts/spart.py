"""Layout of SPART: rotation matrix of the base, and position of the base's centre of mass."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs.common.coordinates import ANGULAR, BASE_NQ, BASE_NV, LINEAR, POSITION, QUATERNION
from onorbit_rs.common.numbers import shortest
from onorbit_rs.common.rotations import matrix_from_quaternion, quaternion_from_matrix
from onorbit_rs.exceptions import InputError
from onorbit_rs.layouts.state import (
    NORM_TOLERANCE,
    checked,
    checked_state,
    concatenated,
    in_model_order,
    order_of,
    same_batch,
    to_body,
    to_world,
)

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from onorbit_rs._core import Model
    from onorbit_rs.layouts.state import Floats


def to_spart(
    model: Model,
    q: ArrayLike,
    v: ArrayLike,
    joints: Sequence[str] | None = None,
    *,
    base_com: ArrayLike | None = None,
) -> tuple[tuple[Floats, Floats, Floats], tuple[Floats, Floats]]:
    """Return SPART's ``(R0, r0, qm)`` and ``(u0, um)``.

    ``R0 = R`` rotates base axes to inertial axes, and ``r0 = p + R c`` is the centre of mass of the base
    link, whose origin is at ``p``. ``u0 = [w_B, v_W + R (w_B × c)]`` is the angular velocity of the base link
    in base axes and the velocity of ``r0`` in inertial axes; with SPART's matrix ``P0``, the twist of the
    base link in inertial axes is ``t0 = P0 u0``.

    Parameters
    ----------
    model : Model
        Robot.
    q : (nq,) or (B, nq) array
        Configuration of onorbit_rs, rad and m.
    v : (nv,) or (B, nv) array
        Velocity of onorbit_rs, rad/s and m/s.
    joints : sequence of str, optional
        Names in SPART's order.
    base_com : (3,) array, optional
        Centre of mass ``c`` of the base link in its axes, m. Default: that of the base body, which includes
        links fixed to the base. SPART does not merge such links: with them, give ``c`` of the base link
        alone.

    Returns
    -------
    (R0, r0, qm) : (3, 3), (3,) and (n,) arrays, or batches
    (u0, um) : (6,) and (n,) arrays, or batches

    Raises
    ------
    FrameError
        If a joint does not exist.
    InputError, ShapeError, DtypeError
        If an argument is invalid.
    """
    q_model, v_model = checked_state(model, q, v)
    order, com = order_of(model, joints), _com(model, base_com)
    quat = q_model[..., QUATERNION]
    linear, angular = v_model[..., LINEAR], v_model[..., ANGULAR]
    r0 = q_model[..., POSITION] + to_world(quat, com)
    u0 = concatenated(angular, to_world(quat, linear + np.cross(angular, com)))
    return (matrix_from_quaternion(quat), r0, q_model[..., BASE_NQ + order]), (
        u0,
        v_model[..., BASE_NV + order],
    )


def from_spart(
    model: Model,
    position: tuple[ArrayLike, ArrayLike, ArrayLike],
    velocity: tuple[ArrayLike, ArrayLike],
    joints: Sequence[str] | None = None,
    *,
    base_com: ArrayLike | None = None,
) -> tuple[Floats, Floats]:
    """Return `q` and `v` of onorbit_rs from SPART's ``(R0, r0, qm)`` and ``(u0, um)``.

    Parameters
    ----------
    model : Model
        Robot.
    position : (R0, r0, qm)
        Rotation matrix of the base, its centre of mass and joint positions, as returned by :func:`to_spart`.
    velocity : (u0, um)
        Twist of the base and joint rates, as returned by :func:`to_spart`.
    joints : sequence of str, optional
        As in :func:`to_spart`.
    base_com : (3,) array, optional
        As in :func:`to_spart`.

    Returns
    -------
    q : (nq,) or (B, nq) array
        Configuration of onorbit_rs, rad and m.
    v : (nv,) or (B, nv) array
        Velocity of onorbit_rs, rad/s and m/s.

    Raises
    ------
    OnOrbitError
        As for :func:`to_spart`.
    """
    order, com = order_of(model, joints), _com(model, base_com)
    n = len(order)
    rot, r0, qm = (
        checked("R0", position[0], 3, 3),
        checked("r0", position[1], 3),
        checked("qm", position[2], n),
    )
    u0, um = checked("u0", velocity[0], 6), checked("um", velocity[1], n)
    same_batch(
        R0=rot[..., 0, 0], r0=r0[..., 0], qm=qm.sum(-1), u0=u0[..., 0], um=um.sum(-1),
    )  # fmt: skip
    off = np.abs(np.swapaxes(rot, -1, -2) @ rot - np.eye(3)).max(initial=0.0)
    if off > NORM_TOLERANCE or (np.linalg.det(rot) < 0.0).any():
        why = (
            f"R0ᵀ R0 differs from the identity by {shortest(off)}, more than {NORM_TOLERANCE:g}"
            if off > NORM_TOLERANCE
            else "its determinant is -1, so it contains a reflection"
        )
        raise InputError(
            f"R0 is not a rotation matrix: {why}; give an orthonormal matrix with determinant 1",
            name="R0",
            got=float(off),
            expected="orthonormal",
        )
    quat = quaternion_from_matrix(rot)
    angular = u0[..., :3]
    linear = to_body(quat, u0[..., 3:]) - np.cross(angular, com)
    p = r0 - to_world(quat, com)
    return concatenated(p, quat, in_model_order(qm, order)), concatenated(
        linear, angular, in_model_order(um, order)
    )


def _com(model: Model, base_com: ArrayLike | None) -> Floats:
    if base_com is None:
        return np.array(model.bodies[0].com)
    com = checked("base_com", base_com, 3)
    if com.ndim != 1:
        raise InputError(
            f"base_com has shape {com.shape}; the required shape is (3,)",
            name="base_com",
            got=com.shape,
            expected=(3,),
        )
    return com
