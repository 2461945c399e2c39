"""Layout of RBDL: the base has three translations and a spherical joint; the quaternion's scalar is last."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from onorbit_rs.layouts.quaternion_layout import QuaternionLayout
from onorbit_rs.layouts.state import checked_state, checked_vectors, order_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from onorbit_rs._core import Model
    from onorbit_rs.layouts.state import Floats

_LAYOUT = QuaternionLayout(position=slice(3), quaternion=[3, 4, 5, -1], joints=slice(6, -1))


def to_rbdl(
    model: Model, q: ArrayLike, v: ArrayLike, joints: Sequence[str] | None = None
) -> tuple[Floats, Floats]:
    """Return RBDL's ``Q = [p, quat_xyz, joints, quat_w]`` and ``QDot = [v_W, w_B, rates]``.

    The base must be a ``JointTypeFloatingBase`` in RBDL, and all other joints have one degree of freedom.

    Parameters
    ----------
    model : Model
        Robot.
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
    return _LAYOUT.from_model(checked_state(model, q, v), order_of(model, joints))


def from_rbdl(
    model: Model, q: ArrayLike, v: ArrayLike, joints: Sequence[str] | None = None
) -> tuple[Floats, Floats]:
    """Return `q` and `v` of onorbit_rs from RBDL's ``Q`` and ``QDot`` (see :func:`to_rbdl`).

    Parameters
    ----------
    model : Model
        Robot.
    q : (nq,) or (B, nq) array
        Configuration ``[p, quat_xyz, joints, quat_w]`` of RBDL.
    v : (nv,) or (B, nv) array
        Velocity ``QDot = [v_W, w_B, rates]`` of RBDL.
    joints : sequence of str, optional
        Names in RBDL's order.

    Returns
    -------
    q : (nq,) or (B, nq) array
        Configuration of onorbit_rs, rad and m.
    v : (nv,) or (B, nv) array
        Velocity of onorbit_rs, rad/s and m/s.

    Raises
    ------
    OnOrbitError
        As for :func:`to_rbdl`.
    """
    order = order_of(model, joints)
    return _LAYOUT.to_model("q", checked_vectors(q=(q, model.nq), v=(v, model.nv)), order)
