"""MuJoCo: scalar-first quaternion; linear velocity of the base in world axes, angular in body axes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from onorbit_rs.common.coordinates import (
    ANGULAR,
    BASE_NQ,
    BASE_NV,
    JOINTS_Q,
    JOINTS_V,
    LINEAR,
    POSITION,
    QUATERNION,
)
from onorbit_rs.layouts.state import (
    check_unit,
    checked_state,
    checked_vectors,
    concatenated,
    in_model_order,
    names_in,
    no_floating_base,
    order_of,
    to_body,
    to_world,
)

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from onorbit_rs._core import Model
    from onorbit_rs.layouts.state import Floats

_FREE, _SLIDE, _HINGE = 0, 2, 3  # mjtJoint


def to_mujoco(model: Model, q: ArrayLike, v: ArrayLike, joints: Any = None) -> tuple[Floats, Floats]:
    """Return MuJoCo's ``qpos = [p, quat_wxyz, joints]`` and ``qvel = [v_W, w_B, rates]``.

    Parameters
    ----------
    model : Model
    q : (nq,) or (B, nq) array
        Configuration of onorbit_rs, rad and m.
    v : (nv,) or (B, nv) array
        Velocity of onorbit_rs, rad/s and m/s.
    joints : sequence of str or mujoco.MjModel, optional
        Names in MuJoCo's order, or a ``mujoco.MjModel`` whose first joint is free.

    Returns
    -------
    qpos : (nq,) or (B, nq) array
    qvel : (nv,) or (B, nv) array

    Raises
    ------
    FrameError
        If a joint does not exist.
    InputError, ShapeError, DtypeError
        If an argument is invalid.
    """
    q_model, v_model = checked_state(model, q, v)
    order = _order(model, joints)
    quat = q_model[..., QUATERNION]
    qpos = concatenated(q_model[..., POSITION], quat[..., [3, 0, 1, 2]], q_model[..., BASE_NQ + order])
    return qpos, concatenated(
        to_world(quat, v_model[..., LINEAR]), v_model[..., ANGULAR], v_model[..., BASE_NV + order]
    )


def from_mujoco(model: Model, qpos: ArrayLike, qvel: ArrayLike, joints: Any = None) -> tuple[Floats, Floats]:
    """Return `q` and `v` of onorbit_rs from MuJoCo's ``qpos`` and ``qvel``.

    Parameters
    ----------
    model : Model
    qpos : (nq,) or (B, nq) array
    qvel : (nv,) or (B, nv) array
    joints : sequence of str or mujoco.MjModel, optional
        As in :func:`to_mujoco`.

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
    order = _order(model, joints)
    q_other, v_other = checked_vectors(qpos=(qpos, model.nq), qvel=(qvel, model.nv))
    quat = q_other[..., [4, 5, 6, 3]]
    check_unit("qpos", quat)
    return (
        concatenated(q_other[..., :3], quat, in_model_order(q_other[..., JOINTS_Q], order)),
        concatenated(
            to_body(quat, v_other[..., :3]), v_other[..., 3:6], in_model_order(v_other[..., JOINTS_V], order)
        ),
    )


def _order(model: Model, joints: Any) -> NDArray[Any]:
    if not names_in(joints, "jnt_qposadr"):
        return order_of(model, joints)
    kinds = [int(kind) for kind in joints.jnt_type]
    if kinds[:1] != [_FREE] or any(kind not in (_SLIDE, _HINGE) for kind in kinds[1:]):
        raise no_floating_base("MuJoCo")
    return order_of(model, [joints.joint(j).name for j in range(1, joints.njnt)])
