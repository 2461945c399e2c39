"""Drake: scalar-first quaternion before the position, angular before linear velocity, both in world axes."""

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


def to_drake(model: Model, q: ArrayLike, v: ArrayLike, joints: Any = None) -> tuple[Floats, Floats]:
    """Drake's positions ``[quat_wxyz, p, joints]`` and velocities ``[w_W, v_W, rates]``.

    Parameters
    ----------
    q : (nq,) or (B, nq) array, v : (nv,) or (B, nv) array
    joints : names in Drake's order, or its finalised ``MultibodyPlant`` with this robot alone
    """
    ours_q, ours_v = pair(model, q, v)
    order = _order(model, joints)
    quat = ours_q[..., 3:7]
    positions = joined(quat[..., [3, 0, 1, 2]], ours_q[..., :3], ours_q[..., 7 + order])
    linear, angular = to_world(quat, ours_v[..., :3]), to_world(quat, ours_v[..., 3:6])
    return positions, joined(angular, linear, ours_v[..., 6 + order])


def from_drake(model: Model, q: ArrayLike, v: ArrayLike, joints: Any = None) -> tuple[Floats, Floats]:
    """Our `q` and `v` from positions and velocities."""
    order = _order(model, joints)
    theirs_q, theirs_v = checked_pair(q=(q, model.nq), v=(v, model.nv))
    quat = theirs_q[..., [1, 2, 3, 0]]
    unit("q", quat)
    linear, angular = to_body(quat, theirs_v[..., 3:6]), to_body(quat, theirs_v[..., :3])
    return (
        joined(theirs_q[..., 4:7], quat, unshuffled(theirs_q[..., 7:], order)),
        joined(linear, angular, unshuffled(theirs_v[..., 6:], order)),
    )


def _order(model: Model, joints: Any) -> NDArray[Any]:
    if not names_in(joints, "GetJointIndices"):
        return order_of(model, joints)
    moving = [joints.get_joint(index) for index in joints.GetJointIndices()]
    moving = sorted((j for j in moving if j.num_positions()), key=lambda joint: int(joint.position_start()))
    sizes = [joint.num_positions() for joint in moving]
    if sizes[:1] != [7] or any(size != 1 for size in sizes[1:]):
        raise no_floating_base("Drake")
    return order_of(model, [joint.name() for joint in moving[1:]])
