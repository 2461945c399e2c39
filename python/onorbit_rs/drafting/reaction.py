"""What a motion of the arm does to the base that nothing holds."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Model
    from onorbit_rs.drafting.arm import Arm

    Floats = NDArray[np.float64]

GENTLE = 0.35
"""By how much the base of a first scenario may turn, rad: 20°."""


def turn_per_metre(model: Model, arm: Arm, q: Floats) -> Floats:
    """How the base turns as its tool is moved by a metre along x, y or z of W: a column each, (3, 3), rad/m.

    Of the joint rates that move the tool alone, `q̇ = Jg⁺ ẋ`, the base takes `-Mbb⁻¹ Mbm q̇` at zero momentum.
    """
    columns = [list(model.joint_names).index(name) for name in arm.joints]
    jacobian = np.asarray(model.free_floating(q, np.zeros(model.nv), arm.tool).jacobian)[:, columns]
    mass = np.asarray(model.mass_matrix(q))
    # q̇ = Jg⁺ ẋ, for the three directions at once and without a turn of the tool
    rates = np.linalg.pinv(jacobian, rcond=1e-6)[:, :3]
    # vb = -Mbb⁻¹ Mbm q̇
    base = -np.linalg.solve(mass[:6, :6], mass[:6, 6:][:, columns] @ rates)
    return np.asarray(base[3:], dtype=np.float64)


def calmest(turns: Floats) -> Floats:
    """The direction of the tool that turns the base least, (3,): the last right singular vector."""
    direction: Floats = np.linalg.svd(turns)[2][-1]
    return direction
