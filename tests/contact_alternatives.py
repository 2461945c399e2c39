"""Wrong methods for contact, as controls of validation: laws of friction that creep, and equal steps."""

from __future__ import annotations

import math
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import onorbit_rs as oo
from onorbit_rs.tools.validation import contact, contact_grasp, grasp, grasp_worlds

Derivative = Callable[[float, tuple[float, ...]], tuple[float, ...]]

BRISTLES = 2.0 * contact_grasp.STIFFNESS  # of both pads, N/m
DAMPING = 0.2 * math.sqrt(BRISTLES * contact_grasp.MASS)  # N s/m
SLOW = 1e-2  # speed at which smooth friction is almost Coulomb's, m/s


def rk4(rate: Derivative, time: float, state: tuple[float, ...], step: float) -> tuple[float, ...]:
    """Returns the state after a step of the classical Runge-Kutta method."""

    def ahead(change: tuple[float, ...], part: float) -> tuple[float, ...]:
        return tuple(x + part * d for x, d in zip(state, change, strict=True))

    k1 = rate(time, state)
    k2 = rate(time + step / 2, ahead(k1, step / 2))
    k3 = rate(time + step / 2, ahead(k2, step / 2))
    k4 = rate(time + step, ahead(k3, step))
    mean = tuple((a + 2 * b + 2 * c + d) / 6 for a, b, c, d in zip(k1, k2, k3, k4, strict=True))
    return ahead(mean, step)


def drift(
    friction: Callable[[float, float, float], tuple[float, float]], step: float
) -> Callable[..., float]:
    """Returns a function like ``contact_grasp.held`` with another friction.

    ``friction`` returns friction, N, and the rate of its state, from the cone, N, the velocity and the state.
    """

    def held(normal: float, load: float, swing: float, lasts: float) -> float:
        cone = 2.0 * contact_grasp.MU * normal

        def rate(time: float, state: tuple[float, ...]) -> tuple[float, ...]:
            _, v, z = state
            force, change = friction(cone, v, z)
            applied = load + swing * math.sin(2.0 * math.pi * time / contact_grasp.PERIOD)
            return v, (applied - force) / contact_grasp.MASS, change

        state: tuple[float, ...] = (0.0, 0.0, 0.0)
        half, count = 0.0, round(lasts / step)
        for k in range(count):
            if 2 * k == count:
                half = state[0]
            state = rk4(rate, k * step, state, step)
        return abs(state[0] - half) / (lasts / 2)

    return held


def _smooth(cone: float, v: float, z: float) -> tuple[float, float]:
    return cone * math.tanh(v / SLOW), 0.0


def _lugre(cone: float, v: float, z: float) -> tuple[float, float]:
    change = v - BRISTLES * abs(v) / cone * z
    return BRISTLES * z + DAMPING * change, change


smooth = drift(_smooth, 1e-5)
lugre = drift(_lugre, 1e-4)


def in_smooth_hand(trace: oo.WorldTrace) -> Any:
    """Returns the place of a loaded bar in the hand, m, (T, 3), if the friction is smooth: the bar creeps."""
    cone = 2.0 * grasp_worlds.MU * grasp_worlds.FORCE
    place = grasp_worlds.in_hand(trace)
    place[:, 1] += SLOW * math.atanh(grasp.LOAD / cone) * trace["bar"].time
    return place


def with_equal_steps(normal: Any, steps: float = 32.0) -> Any:
    """Returns the impact of ``contact.impact`` by equal steps of RK4; the last one ends at zero depth.

    ``steps`` is their number per half oscillation with the stiffness at the largest depth.
    """
    assert isinstance(normal, oo.HuntCrossley)
    n, k = normal.exponent, normal.stiffness
    deepest = ((n + 1.0) * contact.MASS * contact.CLOSING**2 / (2.0 * k)) ** (1.0 / (n + 1.0))
    step = math.pi / steps / math.sqrt(n * k * deepest ** (n - 1.0) / contact.MASS)

    def rate(_: float, state: tuple[float, ...]) -> tuple[float, ...]:
        x, v = state
        return v, -k * math.copysign(abs(x) ** n, x) * (1.0 + normal.dissipation * v) / contact.MASS

    state: tuple[float, ...] = (0.0, contact.CLOSING)
    end = rk4(rate, 0.0, state, step)
    while end[0] > 0.0:
        state, end = end, rk4(rate, 0.0, end, step)
    shorter = step
    for _ in range(8):  # Newton's method for the length of the last step
        shorter -= end[0] / end[1]
        end = rk4(rate, 0.0, state, shorter)
    return SimpleNamespace(restitution=-end[1] / contact.SPEED)


def order(exponent: float, stiffness: float) -> float:
    """Returns the order of convergence of the restitution with equal steps, for ``d v0 = 0.3``."""
    law = oo.HuntCrossley(stiffness, exponent, dissipation=0.3 / contact.SPEED)
    errors = [abs(with_equal_steps(law, n).restitution - contact.RESTITUTIONS[0.3]) for n in (32.0, 512.0)]
    return math.log(errors[0] / errors[1]) / math.log(16.0)
