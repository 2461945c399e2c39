"""Drake: scalar-first quaternion before the position, angular before linear velocity, both in world axes."""

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


def to_drake(model: Model, q: ArrayLike, v: ArrayLike, joints: Any = None) -> tuple[Floats, Floats]:
    """Return Drake's positions ``[quat_wxyz, p, joints]`` and velocities ``[w_W, v_W, rates]``.

    Parameters
    ----------
    model : Model
    q : (nq,) or (B, nq) array
        Configuration of onorbit_rs, rad and m.
    v : (nv,) or (B, nv) array
        Velocity of onorbit_rs, rad/s and m/s.
    joints : sequence of str or MultibodyPlant, optional
        Names in Drake's order, or a finalised ``MultibodyPlant`` that contains only this robot.

    Returns
    -------
    positions : (nq,) or (B, nq) array
    velocities : (nv,) or (B, nv) array

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
    positions = concatenated(quat[..., [3, 0, 1, 2]], q_model[..., POSITION], q_model[..., BASE_NQ + order])
    linear, angular = to_world(quat, v_model[..., LINEAR]), to_world(quat, v_model[..., ANGULAR])
    return positions, concatenated(angular, linear, v_model[..., BASE_NV + order])


def from_drake(model: Model, q: ArrayLike, v: ArrayLike, joints: Any = None) -> tuple[Floats, Floats]:
    """Return `q` and `v` of onorbit_rs from Drake's positions and velocities.

    Parameters
    ----------
    model : Model
    q : (nq,) or (B, nq) array
        Positions ``[quat_wxyz, p, joints]``.
    v : (nv,) or (B, nv) array
        Velocities ``[w_W, v_W, rates]``.
    joints : sequence of str or MultibodyPlant, optional
        As in :func:`to_drake`.

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
    q_other, v_other = checked_vectors(q=(q, model.nq), v=(v, model.nv))
    quat = q_other[..., [1, 2, 3, 0]]
    check_unit("q", quat)
    linear, angular = to_body(quat, v_other[..., 3:6]), to_body(quat, v_other[..., :3])
    return (
        concatenated(q_other[..., 4:7], quat, in_model_order(q_other[..., JOINTS_Q], order)),
        concatenated(linear, angular, in_model_order(v_other[..., JOINTS_V], order)),
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
