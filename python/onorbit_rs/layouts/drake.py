"""Layout of Drake: scalar-first quaternion, then position; angular, then linear velocity, in world axes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from onorbit_rs.layouts.quaternion_layout import QuaternionLayout
from onorbit_rs.layouts.state import checked_state, checked_vectors, names_in, no_floating_base, order_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from onorbit_rs._core import Model
    from onorbit_rs.layouts.state import Floats

_LAYOUT = QuaternionLayout(
    position=slice(4, 7), quaternion=[1, 2, 3, 0], joints=slice(7, None),
    linear=slice(3, 6), angular=slice(0, 3), is_angular_in_world=True,
)  # fmt: skip


def to_drake(model: Model, q: ArrayLike, v: ArrayLike, joints: Any = None) -> tuple[Floats, Floats]:
    """Return Drake's positions ``[quat_wxyz, p, joints]`` and velocities ``[w_W, v_W, rates]``.

    Parameters
    ----------
    model : Model
        Robot.
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
    return _LAYOUT.from_model(checked_state(model, q, v), _order(model, joints))


def from_drake(model: Model, q: ArrayLike, v: ArrayLike, joints: Any = None) -> tuple[Floats, Floats]:
    """Return `q` and `v` of onorbit_rs from Drake's positions and velocities.

    Parameters
    ----------
    model : Model
        Robot.
    q : (nq,) or (B, nq) array
        Positions ``[quat_wxyz, p, joints]``.
    v : (nv,) or (B, nv) array
        Velocities ``[w_W, v_W, rates]``.
    joints : sequence of str or MultibodyPlant, optional
        As in :func:`to_drake`.

    Returns
    -------
    q : (nq,) or (B, nq) array
        Configuration of onorbit_rs, rad and m.
    v : (nv,) or (B, nv) array
        Velocity of onorbit_rs, rad/s and m/s.

    Raises
    ------
    OnOrbitError
        As for :func:`to_drake`.
    """
    order = _order(model, joints)
    return _LAYOUT.to_model("q", checked_vectors(q=(q, model.nq), v=(v, model.nv)), order)


def _order(model: Model, joints: Any) -> NDArray[Any]:
    if not names_in(joints, "GetJointIndices"):
        return order_of(model, joints)
    moving = [joints.get_joint(index) for index in joints.GetJointIndices()]
    moving = sorted((j for j in moving if j.num_positions()), key=lambda joint: int(joint.position_start()))
    sizes = [joint.num_positions() for joint in moving]
    if sizes[:1] != [7] or any(size != 1 for size in sizes[1:]):
        raise no_floating_base("Drake")
    return order_of(model, [joint.name() for joint in moving[1:]])
