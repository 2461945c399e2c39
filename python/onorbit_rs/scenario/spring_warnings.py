"""Warnings about springs at joints that are too stiff for the time step.

An oscillation with the angular frequency `ω` is integrated in steps `h`. RK4 removes the fraction
`2π (ω h)⁵ / 72` of the energy of the oscillation in each period, and diverges above `ω h = 2 √2`. The
semi-implicit Euler method changes the frequency by the fraction `(ω h)² / 24`, and diverges above `ω h = 2`.

Source: Hairer, Lubich and Wanner, Geometric Numerical Integration, 2nd ed., 2006 (stability functions).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs.common.coordinates import BASE_NQ, BASE_NV, BASE_V

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Model
    from onorbit_rs.scenario.schema import Scenario

_COARSE = 0.2
"""Product `ω h` above which the steps are too long: 31 steps per period."""
_FINE = 0.1
"""Product `ω h` of the suggested time step."""
_STABLE = {"rk4": 2.0 * math.sqrt(2.0), "semi_implicit_euler": 2.0}


def spring_warnings(scenario: Scenario, model: Model, q: NDArray[np.float64]) -> Iterator[str]:
    """Yield a warning if the fastest oscillation of the springs is not resolved by fixed time steps."""
    settings = scenario.simulation
    stable = _STABLE.get(settings.integrator)
    if stable is None or not any(joint.stiffness or joint.cubic_stiffness for joint in model.joints):
        return
    rate, joint = _fastest(model, q)
    product = rate * settings.time_step
    if not product > _COARSE:
        return
    if product > stable:
        consequence = f"{settings.integrator} diverges above a product of {stable:.3g}"
    elif settings.integrator == "rk4":
        loss = 2.0 * math.pi * product**5 / 72.0
        consequence = f"rk4 removes the fraction {loss:.1g} of the energy of the oscillation in each period"
    else:
        consequence = f"the frequency of the oscillation has a relative error of {product**2 / 24.0:.1g}"
    yield (
        f"robot: the spring of joint {joint!r} oscillates at {rate:.3g} rad/s with the inertia at the start; "
        f"with a time_step of {settings.time_step:g} s, the product of both is {product:.3g}, and "
        f"{consequence}; use a time_step of at most {_FINE / rate:.1g} s, integrator: dormand_prince, or "
        "softer springs"
    )


def _fastest(model: Model, q: NDArray[np.float64]) -> tuple[float, str]:
    """Return the largest angular frequency, rad/s, and the joint whose spring has the largest part in it.

    The frequencies are the square roots of the eigenvalues of `M*⁻¹ K` with the reduced inertia
    `M* = Mmm - Mmb Mbb⁻¹ Mbm` of the joints on the free base and the stiffnesses `K` of the springs: the
    tangent stiffness at the initial position, or, if a spring softens, the stiffness at its rest position.
    Closed loops are not taken into account.
    """
    mass = np.asarray(model.mass_matrix(q))
    coupling = mass[BASE_V][:, BASE_NV:]
    inertia = mass[BASE_NV:, BASE_NV:] - coupling.T @ np.linalg.solve(mass[BASE_V, BASE_V], coupling)
    position = np.asarray(q)[BASE_NQ:]
    stiffness = np.array(
        [
            joint.stiffness + max(3.0 * joint.cubic_stiffness * (position[j] - joint.rest_position) ** 2, 0.0)
            for j, joint in enumerate(model.joints)
        ]
    )
    root = np.sqrt(stiffness)
    values, vectors = np.linalg.eigh(root[:, None] * np.linalg.inv(inertia) * root)
    return math.sqrt(max(float(values[-1]), 0.0)), model.joints[int(np.argmax(np.abs(vectors[:, -1])))].name
