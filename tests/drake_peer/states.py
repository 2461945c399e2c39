"""States of a sphere that touches another sphere or a plane, for Drake and for this package."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

RADIUS = 0.1
"""Radius of the robot ``ball``, m."""
MASS = 4.0
STIFFNESS = 1e5
DISSIPATION = 2.0


@dataclass(frozen=True)
class State:
    """Sphere ``b`` on ``a``, a sphere at the origin or a plane through it; velocities in m/s and rad/s."""

    on: str
    place: list[float]
    linear: list[float]
    angular: list[float]


def states(count: int = 40) -> list[State]:
    """Returns states with depths from 1 µm to 1 mm that approach or separate, and spin."""
    rng = np.random.default_rng(20)
    found = []
    for k in range(count):
        depth = 10.0 ** rng.uniform(-6.0, -3.0)
        normal = rng.normal(size=3)
        normal /= np.linalg.norm(normal)
        on = ("sphere", "plane")[k % 2]
        place = [*rng.uniform(-0.2, 0.2, 2), RADIUS - depth]
        if on == "sphere":
            place = list((2.0 * RADIUS - depth) * normal)
        found.append(State(on, place, list(rng.uniform(-1.0, 1.0, 3)), list(rng.normal(size=3))))
    return found
