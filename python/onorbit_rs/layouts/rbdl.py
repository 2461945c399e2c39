"""RBDL: the base is three translations and a spherical joint, whose quaternion's scalar goes to the end."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from onorbit_rs.layouts.state import (
    checked_pair,
    joined,
    order_of,
    pair,
    to_body,
    to_world,
    unit,
    unshuffled,
)

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from onorbit_rs._core import Model
    from onorbit_rs.layouts.state import Floats


def to_rbdl(
    model: Model, q: ArrayLike, v: ArrayLike, joints: Sequence[str] | None = None
) -> tuple[Floats, Floats]:
    """RBDL's ``Q = [p, quat_xyz, joints, quat_w]`` and ``QDot = [v_W, w_B, rates]``.

    Parameters
    ----------
    q : (nq,) or (B, nq) array, v : (nv,) or (B, nv) array
    joints : names in RBDL's order; all must be of one degree of freedom, the base a ``JointTypeFloatingBase``
    """
    ours_q, ours_v = pair(model, q, v)
    order = order_of(model, joints)
    quat = ours_q[..., 3:7]
    positions = joined(ours_q[..., :6], ours_q[..., 7 + order], quat[..., 3:])
    return positions, joined(to_world(quat, ours_v[..., :3]), ours_v[..., 3:6], ours_v[..., 6 + order])


def from_rbdl(
    model: Model, q: ArrayLike, v: ArrayLike, joints: Sequence[str] | None = None
) -> tuple[Floats, Floats]:
    """Our `q` and `v` from ``Q`` and ``QDot``."""
    order = order_of(model, joints)
    theirs_q, theirs_v = checked_pair(q=(q, model.nq), v=(v, model.nv))
    quat = joined(theirs_q[..., 3:6], theirs_q[..., -1:])
    unit("q", quat)
    return (
        joined(theirs_q[..., :3], quat, unshuffled(theirs_q[..., 6:-1], order)),
        joined(to_body(quat, theirs_v[..., :3]), theirs_v[..., 3:6], unshuffled(theirs_v[..., 6:], order)),
    )
