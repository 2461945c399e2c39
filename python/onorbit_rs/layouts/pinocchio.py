"""Layout of Pinocchio: that of onorbit_rs, but siblings are sorted, and unbounded joints are cosine and sine.

Siblings are joints with the same parent; Pinocchio sorts them by name.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.common.coordinates import BASE_NQ, BASE_NV, BASE_Q, BASE_V, JOINTS_Q, JOINTS_V, QUATERNION
from onorbit_rs.common.suggestions import did_you_mean
from onorbit_rs.exceptions import InputError
from onorbit_rs.layouts.state import (
    check_unit,
    checked_state,
    checked_vectors,
    concatenated,
    in_model_order,
    names_in,
    no_floating_base,
    order_of,
)

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from onorbit_rs._core import Model
    from onorbit_rs.layouts.state import Floats


def to_pinocchio(
    model: Model, q: ArrayLike, v: ArrayLike, joints: Any = None, *, unbounded: Sequence[str] = ()
) -> tuple[Floats, Floats]:
    """Return Pinocchio's `q` and `v` from those of onorbit_rs.

    Parameters
    ----------
    model : Model
        Robot.
    q : (nq,) or (B, nq) array
        Configuration of onorbit_rs, rad and m.
    v : (nv,) or (B, nv) array
        Velocity of onorbit_rs, rad/s and m/s.
    joints : sequence of str or pin.Model, optional
        Names in Pinocchio's order, or a ``pin.Model`` with a ``JointModelFreeFlyer`` as root.
    unbounded : sequence of str
        Names of the joints that Pinocchio represents by cosine and sine: those that are ``continuous`` in the
        URDF. Not needed with a ``pin.Model``.

    Returns
    -------
    q : array
        Configuration with one additional entry per unbounded joint.
    v : (nv,) or (B, nv) array

    Raises
    ------
    FrameError
        If a joint does not exist.
    InputError, ShapeError, DtypeError
        If an argument is invalid.
    """
    q_model, v_model = checked_state(model, q, v)
    order, is_unbounded = _layout(model, joints, unbounded)
    parts = [q_model[..., BASE_Q]]
    for j, wraps in zip(order, is_unbounded, strict=True):
        angle = q_model[..., BASE_NQ + j, None]
        parts += [np.cos(angle), np.sin(angle)] if wraps else [angle]
    return concatenated(*parts), concatenated(v_model[..., BASE_V], v_model[..., BASE_NV + order])


def from_pinocchio(
    model: Model, q: ArrayLike, v: ArrayLike, joints: Any = None, *, unbounded: Sequence[str] = ()
) -> tuple[Floats, Floats]:
    """Return `q` and `v` of onorbit_rs from those of Pinocchio; unbounded joints get angles from -π to π.

    Parameters
    ----------
    model : Model
        Robot.
    q, v : array
        Configuration and velocity of Pinocchio, one state or a batch; rad, m, rad/s and m/s.
    joints : sequence of str or pin.Model, optional
        As in :func:`to_pinocchio`.
    unbounded : sequence of str
        As in :func:`to_pinocchio`.

    Returns
    -------
    q : (nq,) or (B, nq) array
        Configuration of onorbit_rs, rad and m.
    v : (nv,) or (B, nv) array
        Velocity of onorbit_rs, rad/s and m/s.

    Raises
    ------
    OnOrbitError
        As for :func:`to_pinocchio`.
    """
    order, is_unbounded = _layout(model, joints, unbounded)
    q_other, v_other = checked_vectors(q=(q, model.nq + sum(is_unbounded)), v=(v, model.nv))
    check_unit("q", q_other[..., QUATERNION])
    angles, at = [], 7
    for wraps in is_unbounded:
        if wraps:
            check_unit("q", q_other[..., at : at + 2], "the cosine and sine of a joint")
            angles.append(np.arctan2(q_other[..., at + 1], q_other[..., at]))
        else:
            angles.append(q_other[..., at])
        at += 2 if wraps else 1
    values = np.stack(angles, axis=-1) if angles else q_other[..., JOINTS_Q]
    return (
        concatenated(q_other[..., BASE_Q], in_model_order(values, order)),
        concatenated(v_other[..., BASE_V], in_model_order(v_other[..., JOINTS_V], order)),
    )


def _layout(model: Model, joints: Any, unbounded: Sequence[str]) -> tuple[Any, list[bool]]:
    """Return the order of the joints in Pinocchio, and whether each is represented by cosine and sine."""
    if names_in(joints, "idx_qs"):
        sizes = [int(size) for size in joints.nqs]  # the first is the universe, the second the free flyer
        if sizes[:2] != [0, 7] or any(size not in (1, 2) for size in sizes[2:]):
            raise no_floating_base("Pinocchio")
        return order_of(model, list(joints.names)[2:]), [size == 2 for size in sizes[2:]]
    order = order_of(model, joints)
    names = [model.joint_names[j] for j in order]
    unknown = [name for name in unbounded if name not in names]
    if unknown:
        raise InputError(
            f"unbounded contains {unknown[0]!r}, which is not a moving joint of the robot"
            f"{did_you_mean(unknown[0], names) or '; Model.joint_names lists them'}",
            name="unbounded",
            got=unknown,
            expected=names,
        )
    return order, [name in unbounded for name in names]
