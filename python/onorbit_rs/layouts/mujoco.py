"""MuJoCo: scalar-first quaternion; the base's linear velocity in world axes, its angular in body axes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from onorbit_rs.layouts.state import (
    checked_pair,
    joined,
    names_in,
    no_floating_base,
    order_of,
    pair,
    to_body,
    to_world,
    unit,
    unshuffled,
)

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from onorbit_rs._core import Model
    from onorbit_rs.layouts.state import Floats

_FREE, _SLIDE, _HINGE = 0, 2, 3  # mjtJoint


def to_mujoco(model: Model, q: ArrayLike, v: ArrayLike, joints: Any = None) -> tuple[Floats, Floats]:
    """MuJoCo's ``qpos = [p, quat_wxyz, joints]`` and ``qvel = [v_W, w_B, rates]``.

    Parameters
    ----------
    q : (nq,) or (B, nq) array, v : (nv,) or (B, nv) array
    joints : names in MuJoCo's order, or its ``mujoco.MjModel`` whose first joint is free
    """
    ours_q, ours_v = pair(model, q, v)
    order = _order(model, joints)
    quat = ours_q[..., 3:7]
    qpos = joined(ours_q[..., :3], quat[..., [3, 0, 1, 2]], ours_q[..., 7 + order])
    return qpos, joined(to_world(quat, ours_v[..., :3]), ours_v[..., 3:6], ours_v[..., 6 + order])


def from_mujoco(model: Model, qpos: ArrayLike, qvel: ArrayLike, joints: Any = None) -> tuple[Floats, Floats]:
    """Our `q` and `v` from ``qpos`` and ``qvel``."""
    order = _order(model, joints)
    theirs_q, theirs_v = checked_pair(qpos=(qpos, model.nq), qvel=(qvel, model.nv))
    quat = theirs_q[..., [4, 5, 6, 3]]
    unit("qpos", quat)
    return (
        joined(theirs_q[..., :3], quat, unshuffled(theirs_q[..., 7:], order)),
        joined(to_body(quat, theirs_v[..., :3]), theirs_v[..., 3:6], unshuffled(theirs_v[..., 6:], order)),
    )


def _order(model: Model, joints: Any) -> NDArray[Any]:
    if not names_in(joints, "jnt_qposadr"):
        return order_of(model, joints)
    kinds = [int(kind) for kind in joints.jnt_type]
    if kinds[:1] != [_FREE] or any(kind not in (_SLIDE, _HINGE) for kind in kinds[1:]):
        raise no_floating_base("MuJoCo")
    return order_of(model, [joints.joint(j).name for j in range(1, joints.njnt)])
