"""Pinocchio: our layout, joints by name among siblings, unbounded joints as cosine and sine."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.exceptions import InputError
from onorbit_rs.layouts.state import (
    checked_pair,
    joined,
    names_in,
    no_floating_base,
    order_of,
    pair,
    unit,
    unshuffled,
)

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from onorbit_rs._core import Model
    from onorbit_rs.layouts.state import Floats


def to_pinocchio(
    model: Model, q: ArrayLike, v: ArrayLike, joints: Any = None, *, unbounded: Sequence[str] = ()
) -> tuple[Floats, Floats]:
    """Pinocchio's `q` and `v`: base linear and angular velocity in base axes, as ours.

    Parameters
    ----------
    q : (nq,) or (B, nq) array, v : (nv,) or (B, nv) array
    joints : names in Pinocchio's order, or its ``pin.Model`` with a ``JointModelFreeFlyer`` as root
    unbounded : names of the joints it writes as (cos, sin), a URDF's ``continuous``; a ``pin.Model`` says
    """
    ours_q, ours_v = pair(model, q, v)
    order, is_unbounded = _layout(model, joints, unbounded)
    parts = [ours_q[..., :7]]
    for j, wraps in zip(order, is_unbounded, strict=True):
        angle = ours_q[..., 7 + j, None]
        parts += [np.cos(angle), np.sin(angle)] if wraps else [angle]
    return joined(*parts), joined(ours_v[..., :6], ours_v[..., 6 + order])


def from_pinocchio(
    model: Model, q: ArrayLike, v: ArrayLike, joints: Any = None, *, unbounded: Sequence[str] = ()
) -> tuple[Floats, Floats]:
    """Our `q` and `v`; an unbounded joint comes back between -π and π, whatever turns it had made."""
    order, is_unbounded = _layout(model, joints, unbounded)
    theirs_q, theirs_v = checked_pair(q=(q, model.nq + sum(is_unbounded)), v=(v, model.nv))
    unit("q", theirs_q[..., 3:7])
    angles, at = [], 7
    for wraps in is_unbounded:
        if wraps:
            unit("q (cosine and sine of a joint)", theirs_q[..., at : at + 2])
            angles.append(np.arctan2(theirs_q[..., at + 1], theirs_q[..., at]))
        else:
            angles.append(theirs_q[..., at])
        at += 2 if wraps else 1
    values = np.stack(angles, axis=-1) if angles else theirs_q[..., 7:]
    return (
        joined(theirs_q[..., :7], unshuffled(values, order)),
        joined(theirs_v[..., :6], unshuffled(theirs_v[..., 6:], order)),
    )


def _layout(model: Model, joints: Any, unbounded: Sequence[str]) -> tuple[Any, list[bool]]:
    """Order of their joints, and which of them are written as two numbers."""
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
            f"unbounded names {unknown[0]!r}, which is no joint",
            name="unbounded",
            got=unknown,
            expected=names,
        )
    return order, [name in unbounded for name in names]
