"""Reaction of the free-floating base to a motion of the arm."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs.common.coordinates import BASE_V, JOINTS_V

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Model
    from onorbit_rs.tools.new_scenario.arm import Arm

    Floats = NDArray[np.float64]

GENTLE = 0.35
"""Largest rotation of the base in a drafted scenario, rad: 20°."""


def rotation_per_metre(model: Model, arm: Arm, q: Floats) -> Floats:
    """Return the base rotation, in base axes, per tool displacement along the axes of W, (3, 3), rad/m.

    With the tool velocity `ẋ`, the generalized Jacobian `Jg`, the joint rates `q̇ = Jg⁺ ẋ` and zero momentum,
    the twist of the base is `-Mbb⁻¹ Mbm q̇`; `Mbb` and `Mbm` are the base and coupling blocks of the mass
    matrix.
    """
    columns = [list(model.joint_names).index(name) for name in arm.joints]
    jacobian = np.asarray(model.free_floating(q, np.zeros(model.nv), arm.tool).jacobian)[:, columns]
    mass = np.asarray(model.mass_matrix(q))
    # q̇ = Jg⁺ ẋ for the three directions, without rotation of the tool
    rates = np.linalg.pinv(jacobian, rcond=1e-6)[:, :3]
    # vb = -Mbb⁻¹ Mbm q̇
    base = -np.linalg.solve(mass[BASE_V, BASE_V], mass[BASE_V, JOINTS_V][:, columns] @ rates)
    return np.asarray(base[3:], dtype=np.float64)


def smallest_rotation(rotations: Floats) -> Floats:
    """Return the unit vector (3,) in W of the tool motion that rotates the base least.

    This is the last right singular vector of ``rotations``, see :func:`rotation_per_metre`.
    """
    direction: Floats = np.linalg.svd(rotations)[2][-1]
    return direction
