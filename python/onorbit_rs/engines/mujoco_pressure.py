"""Normal and friction forces of the contacts of a MuJoCo model."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.engines.mujoco_share import cross

if TYPE_CHECKING:
    from collections.abc import Sequence
    from types import ModuleType

    from numpy.typing import NDArray

    from onorbit_rs.engines.mujoco_contact import Touch

    Floats = NDArray[np.float64]
    Indices = NDArray[np.intp]

WIDTH = 7
"""Number of values per contact: force on the second side, N, moment about the origin of W, N m, power, W."""

_PASSES = 6
"""Largest number of solver passes; each reduces the error of the normal forces by a factor of about 10⁴."""


_ON_CONE = 1e-9
"""Relative distance from the friction cone within which a contact slips."""


@dataclass(frozen=True)
class _Rows:
    """Points at which bodies touch; ``point`` is the index of each point among MuJoCo's contacts."""

    number: Indices
    """Index of the declared contact."""
    sign: Floats
    """1 if MuJoCo's second geom belongs to the second side, otherwise −1."""
    point: Indices
    row: Indices
    """Index of the normal row among MuJoCo's constraints."""
    force: Floats
    """Normal force that the law of the contact prescribes, N."""


class Contacts:
    """Contacts of a compiled model, with MuJoCo's collisions and friction, and the declared normal force.

    MuJoCo's contacts are springs with damping whose force is ``(a_ref − a)/R``, with the acceleration ``a``
    along the constraint and the regularization ``R``. With a large ``R``, the reference acceleration ``a_ref
    = R F`` gives a chosen normal force ``F`` for every exponent, and friction obeys MuJoCo's cone for this
    force. The points of one pair of geoms share the stiffness.
    """

    def __init__(self, mujoco: ModuleType, model: Any, touches: Sequence[Touch]) -> None:
        """Find the geoms of the contacts in the compiled model."""
        self._mujoco, self._model, self._touches = mujoco, model, touches
        self._of_pair: dict[tuple[int, int], tuple[int, float]] = {}
        self._held: list[set[int]] = []
        for number, touch in enumerate(touches):
            for pair in touch.pairs:
                a, b = (int(model.geom(name).id) for name in pair)
                self._of_pair[a, b], self._of_pair[b, a] = (number, 1.0), (number, -1.0)

    @property
    def names(self) -> list[str]:
        """Names of the contacts."""
        return [touch.name for touch in self._touches]

    def release_held(self, data: Any, connections: int) -> None:
        """Remove the forces between bodies that one of the ``connections`` holds together."""
        active = np.flatnonzero(data.eq_active[:connections])
        ends = self._model.eq_obj1id[active], self._model.eq_obj2id[active]
        self._held = [{int(a), int(b)} for a, b in zip(*ends, strict=True)]

    def forward(self, data: Any) -> None:
        """Compute the accelerations with the declared normal forces. Call this instead of ``mj_forward``."""
        mujoco, model = self._mujoco, self._model
        mujoco.mj_fwdPosition(model, data)
        mujoco.mj_fwdVelocity(model, data)
        mujoco.mj_fwdActuation(model, data)
        mujoco.mj_fwdAcceleration(model, data)
        rows = self._rows(data)
        if rows is None:
            mujoco.mj_fwdConstraint(model, data)
            return
        gain = self._gain(data, rows.row)
        data.efc_aref[rows.row] = gain @ rows.force
        self._solve(data, rows, gain)
        if self._slow_down(data, rows):
            self._solve(data, rows, gain)
        # the solver's accelerations satisfy Newton's law only to its tolerance, which would cost momentum
        pushed = np.empty((1, model.nv))
        mujoco.mj_solveM(model, data, pushed, data.qfrc_constraint[None])
        data.qacc[:] = data.qacc_smooth + pushed[0]

    def _gain(self, data: Any, rows: Indices) -> Floats:
        """Return the derivative of the reference accelerations with respect to the normal forces, 1/kg.

        This is `J M⁻¹ Jᵀ + R`, where `J` is the Jacobian of the normal rows, `M` the mass matrix and `R` the
        regularization.
        """
        jacobian = data.efc_J.reshape(-1, self._model.nv)[rows]
        response = np.empty_like(jacobian)
        self._mujoco.mj_solveM(self._model, data, response, jacobian)
        gain: Floats = jacobian @ response.T + np.diag(data.efc_R[rows])
        return gain

    def _solve(self, data: Any, rows: _Rows, gain: Floats) -> None:
        """Solve for the accelerations at which the normal forces equal those of the law, to rounding."""
        allowed = 1e-13 * rows.force.max()
        for _ in range(_PASSES):
            self._mujoco.mj_fwdConstraint(self._model, data)
            missing = rows.force - data.efc_force[rows.row]
            if np.abs(missing).max() <= allowed:
                return
            data.efc_aref[rows.row] += gain @ missing

    def _slow_down(self, data: Any, rows: _Rows) -> bool:
        """Apply the kinetic coefficient to contacts on the static friction cone; return True if any exist."""
        found = False
        for number, point, row in zip(rows.number, rows.point, rows.row, strict=True):
            friction = self._touches[number].friction
            if friction is None or friction.kinetic == friction.static:
                continue
            along, *across = data.efc_force[row : row + 3]
            if math.hypot(*across) >= (1.0 - _ON_CONE) * friction.static * along > 0.0:
                contact = data.contact[int(point)]
                contact.mu *= friction.kinetic / friction.static
                contact.friction[:] = friction.kinetic
                found = True
        return found

    def _rows(self, data: Any) -> _Rows | None:
        """Return the points at which bodies touch, with the forces of the laws; None if none touch."""
        contacts = data.contact
        point = np.flatnonzero(np.asarray(contacts.efc_address) >= 0)
        if not point.size:
            return None
        pairs = [(int(a), int(b)) for a, b in np.asarray(contacts.geom)[point]]
        row = np.asarray(contacts.efc_address)[point]
        depth, rate = -np.asarray(contacts.dist)[point], -data.efc_vel[row]
        number, sign = (
            np.array(values) for values in zip(*(self._of_pair[pair] for pair in pairs), strict=True)
        )
        share = np.array([0.0 if self._is_held(pair) else 1.0 / pairs.count(pair) for pair in pairs])
        force = np.zeros(len(point))
        for k in {int(k) for k in number}:
            own, touch = number == k, self._touches[k]
            force[own] = share[own] * touch.force(depth[own], rate[own])
        return _Rows(number, sign, point, row, force)

    def _is_held(self, pair: tuple[int, int]) -> bool:
        return bool(self._held) and {int(self._model.geom_bodyid[geom]) for geom in pair} in self._held

    def output(self, data: Any) -> Floats:
        """Return the force, moment about the origin of W, and power removed from the motion, by contact.

        Returns
        -------
        (contacts, 7) array
            Values on the second side, in axes of W; N, N m and W.
        """
        found = np.zeros((len(self._touches), WIDTH))
        rows = self._rows(data)
        if rows is None:
            return found
        frames = np.asarray(data.contact.frame)[rows.point].reshape(-1, 3, 3)
        dims = np.asarray(data.contact.dim)[rows.point]
        places = np.asarray(data.contact.pos)[rows.point]
        for k, (number, row, dim) in enumerate(zip(rows.number, rows.row, dims, strict=True)):
            own = slice(row, row + dim)
            force = rows.sign[k] * data.efc_force[own] @ frames[k, :dim]
            power = -data.efc_force[own] @ data.efc_vel[own]
            found[number] += np.array([*force, *cross(places[k], force), power])
        return found
