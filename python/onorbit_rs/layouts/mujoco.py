"""Layout of MuJoCo: scalar-first quaternion; base velocity linear in world axes, angular in body axes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from onorbit_rs.layouts.quaternion_layout import QuaternionLayout
from onorbit_rs.layouts.state import checked_state, checked_vectors, names_in, no_floating_base, order_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from onorbit_rs._core import Model
    from onorbit_rs.layouts.state import Floats

_LAYOUT = QuaternionLayout(position=slice(3), quaternion=[4, 5, 6, 3], joints=slice(7, None))

_FREE, _SLIDE, _HINGE = 0, 2, 3  # mjtJoint


def to_mujoco(model: Model, q: ArrayLike, v: ArrayLike, joints: Any = None) -> tuple[Floats, Floats]:
    """Return MuJoCo's ``qpos = [p, quat_wxyz, joints]`` and ``qvel = [v_W, w_B, rates]``.

    Parameters
    ----------
    model : Model
        Robot.
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
    return _LAYOUT.from_model(checked_state(model, q, v), _order(model, joints))


def from_mujoco(model: Model, qpos: ArrayLike, qvel: ArrayLike, joints: Any = None) -> tuple[Floats, Floats]:
    """Return `q` and `v` of onorbit_rs from MuJoCo's ``qpos`` and ``qvel``.

    Parameters
    ----------
    model : Model
        Robot.
    qpos : (nq,) or (B, nq) array
        MuJoCo's configuration.
    qvel : (nv,) or (B, nv) array
        MuJoCo's velocity.
    joints : sequence of str or mujoco.MjModel, optional
        As in :func:`to_mujoco`.

    Returns
    -------
    q : (nq,) or (B, nq) array
        Configuration of onorbit_rs, rad and m.
    v : (nv,) or (B, nv) array
        Velocity of onorbit_rs, rad/s and m/s.

    Raises
    ------
    OnOrbitError
        As for :func:`to_mujoco`.
    """
    order = _order(model, joints)
    return _LAYOUT.to_model("qpos", checked_vectors(qpos=(qpos, model.nq), qvel=(qvel, model.nv)), order)


def _order(model: Model, joints: Any) -> NDArray[Any]:
    if not names_in(joints, "jnt_qposadr"):
        return order_of(model, joints)
    kinds = [int(kind) for kind in joints.jnt_type]
    if kinds[:1] != [_FREE] or any(kind not in (_SLIDE, _HINGE) for kind in kinds[1:]):
        raise no_floating_base("MuJoCo")
    return order_of(model, [joints.joint(j).name for j in range(1, joints.njnt)])
