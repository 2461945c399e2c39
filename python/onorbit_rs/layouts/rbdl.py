"""RBDL: three translations and a spherical joint for the base; the quaternion's scalar is at the end."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from onorbit_rs.common.coordinates import ANGULAR, BASE_NQ, BASE_NV, JOINTS_V, LINEAR, POSITION, QUATERNION
from onorbit_rs.layouts.state import (
    check_unit,
    checked_state,
    checked_vectors,
    concatenated,
    in_model_order,
    order_of,
    to_body,
    to_world,
)

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from onorbit_rs._core import Model
    from onorbit_rs.layouts.state import Floats


def to_rbdl(
    model: Model, q: ArrayLike, v: ArrayLike, joints: Sequence[str] | None = None
) -> tuple[Floats, Floats]:
    """Return RBDL's ``Q = [p, quat_xyz, joints, quat_w]`` and ``QDot = [v_W, w_B, rates]``.

    The base must be a ``JointTypeFloatingBase`` in RBDL, and all other joints have one degree of freedom.

    Parameters
    ----------
    model : Model
    q : (nq,) or (B, nq) array
        Configuration of onorbit_rs, rad and m.
    v : (nv,) or (B, nv) array
        Velocity of onorbit_rs, rad/s and m/s.
    joints : sequence of str, optional
        Names in RBDL's order.

    Returns
    -------
    Q : (nq,) or (B, nq) array
    QDot : (nv,) or (B, nv) array

    Raises
    ------
    FrameError
        If a joint does not exist.
    InputError, ShapeError, DtypeError
        If an argument is invalid.
    """
    q_model, v_model = checked_state(model, q, v)
    order = order_of(model, joints)
    quat = q_model[..., QUATERNION]
    positions = concatenated(
        q_model[..., POSITION], quat[..., :3], q_model[..., BASE_NQ + order], quat[..., 3:]
    )
    return positions, concatenated(
        to_world(quat, v_model[..., LINEAR]), v_model[..., ANGULAR], v_model[..., BASE_NV + order]
    )


def from_rbdl(
    model: Model, q: ArrayLike, v: ArrayLike, joints: Sequence[str] | None = None
) -> tuple[Floats, Floats]:
    """Return `q` and `v` of onorbit_rs from RBDL's ``Q`` and ``QDot``.

    Parameters
    ----------
    model : Model
    q : (nq,) or (B, nq) array
        ``Q``.
    v : (nv,) or (B, nv) array
        ``QDot``.
    joints : sequence of str, optional
        Names in RBDL's order.

    Returns
    -------
    q : (nq,) or (B, nq) array
        Configuration of onorbit_rs.
    v : (nv,) or (B, nv) array
        Velocity of onorbit_rs.

    Raises
    ------
    FrameError
        If a joint does not exist.
    InputError, ShapeError, DtypeError
        If an argument is invalid.
    """
    order = order_of(model, joints)
    q_other, v_other = checked_vectors(q=(q, model.nq), v=(v, model.nv))
    quat = concatenated(q_other[..., 3:6], q_other[..., -1:])
    check_unit("q", quat)
    return (
        concatenated(q_other[..., :3], quat, in_model_order(q_other[..., 6:-1], order)),
        concatenated(
            to_body(quat, v_other[..., :3]), v_other[..., 3:6], in_model_order(v_other[..., JOINTS_V], order)
        ),
    )
