"""Tests springs at joints on a free base against closed forms: linear, cubic, damped, and with friction."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

import onorbit_rs as oo
from onorbit_rs.tools.validation.case import Case, Gate
from onorbit_rs.tools.validation.trees import Array

BASE, WHEEL = 2.0, 0.5
"""Moments of inertia of base and wheel about the axis of the wheel, kg m²."""
REDUCED = BASE * WHEEL / (BASE + WHEEL)
"""Reduced moment of inertia of the wheel on the free base, kg m²."""
STIFFNESS = 30.0
"""Stiffness of the spring of the wheel, N m/rad."""
DAMPING = 0.4
"""Damping of the wheel in the damped oscillation, N m s/rad."""
HARDENING, SOFTENING = 80.0, -4.0
"""Cubic stiffnesses of a hardening and of a softening spring, N m/rad³."""
AMPLITUDE = 1.2
"""Initial deflection, rad."""
REST = 0.4
"""Rest position of the spring, rad."""
FRICTION = 2.0
"""Coulomb friction of the wheel that comes to rest, N m."""


def wheel(**joint: Any) -> oo.Model:
    """Return a base with a wheel on a spring; the axis z of the wheel passes through both centres of mass."""
    builder = oo.ModelBuilder("craft", base="base", mass=20.0, inertia=np.diag([BASE, BASE, BASE]))
    builder.add_link(
        "wheel", parent="base", joint="spin", kind="continuous", axis=[0, 0, 1],
        mass=5.0, inertia=np.diag([WHEEL, WHEEL, WHEEL]), **{"stiffness": STIFFNESS} | joint,
    )  # fmt: skip
    return builder.build()


def released(model: oo.Model, deflection: float, duration: float, time_step: float) -> oo.Trace:
    """Return a run in which the only joint starts at rest, with a spring deflected by ``deflection``, rad."""
    q = model.neutral()
    q[7] = model.joints[0].rest_position + deflection
    simulation = oo.Simulation(model, q, np.zeros(model.nv), time_step=time_step)
    return simulation.run(duration)


def flapping(offset: float, length: float, *, is_free: bool = True) -> tuple[oo.Model, float]:
    """Return a plate on a base with a spring, and the inertia of its small oscillations, kg m².

    The joint is at the distance `a` (``offset``) from the centre of mass of the base, and the centre of mass
    of the plate at the distance `l` (``length``) beyond it. With the masses `M` and `m`, the moments of
    inertia `J` and `j`, `μ = M m/(M + m)`, `A = J + μ a (a + l)` and `B = j + μ l (a + l)`, angular momentum
    zero gives the rates `-B q̇/(A + B)` of the base and `A q̇/(A + B)` of the plate, and so the inertia
    `[J B² + j A² + μ (l A - a B)²] / (A + B)²`. With an infinite inertia of the base (``is_free`` is False),
    it is `j + m l²`.
    """
    mass, plate, inertia, own = 20.0, 5.0, BASE, WHEEL
    builder = oo.ModelBuilder("craft", base="base", mass=mass, inertia=np.diag([inertia] * 3))
    builder.add_link(
        "plate", parent="base", joint="hinge", kind="continuous", axis=[0, 0, 1], xyz=[offset, 0, 0],
        mass=plate, com=[length, 0, 0], inertia=np.diag([own] * 3), stiffness=STIFFNESS,
    )  # fmt: skip
    mu = mass * plate / (mass + plate)
    a = inertia + mu * offset * (offset + length)
    b = own + mu * length * (offset + length)
    free = (inertia * b * b + own * a * a + mu * (length * a - offset * b) ** 2) / (a + b) ** 2
    return builder.build(), free if is_free else own + plate * length * length


def frequency_error(model: oo.Model, inertia: float, deflection: float, periods: int = 10) -> float:
    """Return the relative error of the frequency `√(k/I)` of an oscillation, from its phase at the end."""
    rate = math.sqrt(model.joints[0].stiffness / inertia)
    end = 2.0 * math.pi * periods / rate
    trace = released(model, deflection, end, 0.02 / rate)
    position, velocity = float(trace.q[-1, 7]) - model.joints[0].rest_position, float(trace.v[-1, 6])
    return abs(math.atan2(-velocity / rate, position)) / (2.0 * math.pi * periods)


def frequencies() -> tuple[float, float]:
    """Return the relative errors of the frequencies of a wheel and of a plate on a free base."""
    model, inertia = flapping(0.6, 0.8)
    return (
        frequency_error(wheel(rest_position=REST), REDUCED, AMPLITUDE),
        frequency_error(model, inertia, 1e-5),
    )


def complete_elliptic(parameter: float) -> float:
    """Return the complete elliptic integral `K(m) = π / (2 agm(1, √(1 - m)))`."""
    a, b = 1.0, math.sqrt(1.0 - parameter)
    while abs(a - b) > 1e-15 * a:
        a, b = 0.5 * (a + b), math.sqrt(a * b)
    return math.pi / (a + b)


def duffing_period(stiffness: float, cubic: float, amplitude: float) -> float:
    """Return the period of `I q̈ = -k q - k3 q³` with the amplitude `A`, s.

    `T = 4 K(m) √(I/(k + k3 A²))` with `m = k3 A² / (2 (k + k3 A²))`.

    Source: Kovacic and Brennan, The Duffing Equation, 2011, section 4.2.
    """
    hardened = stiffness + cubic * amplitude**2
    parameter = 0.5 * cubic * amplitude**2 / hardened
    return 4.0 * complete_elliptic(parameter) * math.sqrt(REDUCED / hardened)


def duffing_error(stiffness: float, cubic: float, *, period: float | None = None) -> float:
    """Return the relative error of the period of a cubic spring, from the rate after four periods.

    ``period`` replaces the period of the closed form, s.
    """
    model = wheel(
        stiffness=stiffness, cubic_stiffness=cubic, rest_position=REST, lower=-0.9, upper=1.9
    )  # within the limits, which are not enforced, the softening spring pulls back ever more strongly
    period = duffing_period(stiffness, cubic, AMPLITUDE) if period is None else period
    trace = released(model, AMPLITUDE, 4.0 * period, period / 1000.0)
    torque = stiffness * AMPLITUDE + cubic * AMPLITUDE**3
    # near the turning point, q̇ = -(torque/I) δt
    late = -float(trace.v[-1, 6]) * REDUCED / torque
    return abs(late) / (4.0 * period)


def duffing() -> tuple[float, ...]:
    """Return the relative errors of the periods of hardening, softening and purely cubic springs."""
    return (
        duffing_error(STIFFNESS, HARDENING),
        duffing_error(STIFFNESS, SOFTENING),
        duffing_error(0.0, HARDENING),
    )


def damped_position(time: Array) -> Array:
    """Return the deflection of the damped wheel, rad, which starts at rest with :data:`AMPLITUDE`."""
    decay = 0.5 * DAMPING / REDUCED
    rate = math.sqrt(STIFFNESS / REDUCED - decay**2)
    found: Array = (
        AMPLITUDE * np.exp(-decay * time) * (np.cos(rate * time) + decay / rate * np.sin(rate * time))
    )
    return found


def damped() -> tuple[float, float]:
    """Return the errors of the deflection, rad, and of the energy balance, J, of the damped wheel."""
    trace = released(wheel(damping=DAMPING, rest_position=REST), AMPLITUDE, 3.0, 1e-3)
    deflection = np.asarray(trace.q)[:, 7] - REST
    energies = (
        np.asarray(trace.kinetic_energy) + np.asarray(trace.spring_energy) + np.asarray(trace.dissipated)
    )
    return (
        float(np.abs(deflection - damped_position(np.asarray(trace.time))).max()),
        float(np.abs(energies - 0.5 * STIFFNESS * AMPLITUDE**2).max()),
    )


def rubbing_end() -> tuple[float, float]:
    """Return the deflection, rad, and the time, s, at which the wheel with friction sticks.

    In each half swing, of the duration `π/ω`, friction `f` reduces the amplitude by `2 f/k`. The wheel sticks
    at the first turning point at which the torque of the spring is at most `f`.
    """
    deflection, swings = AMPLITUDE, 0
    while abs(deflection) > FRICTION / STIFFNESS:
        deflection = -math.copysign(abs(deflection) - 2.0 * FRICTION / STIFFNESS, deflection)
        swings += 1
    return deflection, swings * math.pi * math.sqrt(REDUCED / STIFFNESS)


def rubbing() -> tuple[float, float, float]:
    """Return the errors of deflection, rad, and time, s, at which the wheel sticks, and its creep, rad."""
    trace = released(wheel(friction=FRICTION, rest_position=REST), AMPLITUDE, 4.5, 1e-3)
    deflection, time = np.asarray(trace.q)[:, 7] - REST, np.asarray(trace.time)
    end, stop = rubbing_end()
    stuck = np.flatnonzero(time > stop + 1e-6)
    found = float(time[np.flatnonzero(np.asarray(trace.v)[:, 6])[-1] + 1])
    return (
        abs(float(deflection[-1]) - end), abs(found - stop), float(np.ptp(deflection[stuck]))
    )  # fmt: skip


CASES = (
    Case(
        "joints", "oscillation of a joint with a spring on a free base", "ω = √(k/I), I reduced inertia",
        (Gate("frequency of a wheel", 1e-8), Gate("frequency of a plate beside the base", 1e-8)), frequencies,
    ),
    Case(
        "joints", "period of a joint with a cubic spring", "T = 4 K(m) √(I/(k + k3 A²))",
        (
            Gate("period, hardening", 1e-9), Gate("period, softening", 1e-9),
            Gate("period, without linear stiffness", 1e-9),
        ), duffing,
    ),
    Case(
        "joints", "damped oscillation of a joint with a spring", "solution of I q'' + c q' + k q = 0",
        (Gate("deflection", 1e-9, "rad"), Gate("energy", 1e-8, "J")), damped,
    ),
    Case(
        "joints", "a joint with a spring and friction comes to rest", "each half swing loses 2 f/k",
        (Gate("deflection", 1e-9, "rad"), Gate("time", 1e-9, "s"), Gate("creep", 0.0, "rad")), rubbing,
    ),
)  # fmt: skip
