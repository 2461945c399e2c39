"""SPART: the base by its rotation matrix and the place of its centre of mass."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs.exceptions import InputError
from onorbit_rs.layouts.state import (
    NORM_TOLERANCE,
    checked,
    joined,
    order_of,
    pair,
    same_batch,
    to_body,
    to_world,
    unshuffled,
)
from onorbit_rs.rotations import matrix_from_quaternion, quaternion_from_matrix

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
    """SPART's ``(R0, r0, qm)`` and ``(u0, um)``.

    ``R0`` takes base components to inertial ones; ``r0 = p + R c`` is the centre of mass of the base link;
    ``u0 = [w_B, v_W + R (w_B × c)]``: its angular velocity in base axes, that of ``r0`` in inertial ones.
    Its twist in inertial axes is ``t0 = P0 u0``.

    Parameters
    ----------
    q : (nq,) or (B, nq) array, v : (nv,) or (B, nv) array
    joints : names in SPART's order
    base_com : (3,) array, m
        ``c`` in the base link's axes. That of our base body where not given; SPART folds no fixed joints, so
        give the base link's own where others are fixed to it.

    Returns
    -------
    (R0, r0, qm) : (3, 3), (3,), (n,) arrays, or batches
    (u0, um) : (6,), (n,) arrays, or batches
    """
    ours_q, ours_v = pair(model, q, v)
    order, com = order_of(model, joints), _com(model, base_com)
    quat = ours_q[..., 3:7]
    linear, angular = ours_v[..., :3], ours_v[..., 3:6]
    r0 = ours_q[..., :3] + to_world(quat, com)
    u0 = joined(angular, to_world(quat, linear + np.cross(angular, com)))
    return (matrix_from_quaternion(quat), r0, ours_q[..., 7 + order]), (u0, ours_v[..., 6 + order])


def from_spart(
    model: Model,
    position: tuple[ArrayLike, ArrayLike, ArrayLike],
    velocity: tuple[ArrayLike, ArrayLike],
    joints: Sequence[str] | None = None,
    *,
    base_com: ArrayLike | None = None,
) -> tuple[Floats, Floats]:
    """Our `q` and `v` from ``(R0, r0, qm)`` and ``(u0, um)``."""
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
        raise InputError("R0 is not a rotation matrix", name="R0", got=float(off), expected="orthonormal")
    quat = quaternion_from_matrix(rot)
    angular = u0[..., :3]
    linear = to_body(quat, u0[..., 3:]) - np.cross(angular, com)
    p = r0 - to_world(quat, com)
    return joined(p, quat, unshuffled(qm, order)), joined(linear, angular, unshuffled(um, order))


def _com(model: Model, base_com: ArrayLike | None) -> Floats:
    if base_com is None:
        return np.array(model.bodies[0].com)
    com = checked("base_com", base_com, 3)
    if com.ndim != 1:
        raise InputError("base_com is one vector, not a batch", name="base_com", got=com.shape, expected=(3,))
    return com
