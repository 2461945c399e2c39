"""Tests impacts: restitution, Hertz's impact, spring and dashpot, and momentum of tumbling arms."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

import onorbit_rs as oo
from onorbit_rs.tools.validation.capture import momentum
from onorbit_rs.tools.validation.case import Case, Gate, worst
from onorbit_rs.tools.validation.gauss import Craft
from onorbit_rs.tools.validation.trees import Array

SPEED = 0.1  # m/s
CLOSING = SPEED  # used by the simulation; the closed forms use the constants above
MASS = 1.0  # effective mass of both balls, kg
BALLS = 2.0 * MASS  # mass of one ball in the simulation, kg

# d v0 and e, the root of d v0 (1 + e) = ln[(1 + d v0)/(1 - e d v0)], with 12 digits
RESTITUTIONS = {
    0.01: 0.993377454399, 0.03: 0.980391402985, 0.1: 0.937475579950, 0.3: 0.832869792266,
    1.0: 0.593624260040, 3.0: 0.306896798291, 10.0: 0.099981624753,
}  # fmt: skip
LOSS = 0.7  # restitution of unequal balls, used by the simulation
PAIRS = ((2.0, 2.0), (0.5, 40.0), (40.0, 0.5))  # their masses, kg
LAST = BALLS  # mass of the last ball of a row, kg
LAWS = ((1.0, 1e5), (1.5, 1e7))  # n, k in N/m^n

# Hertz, k = 1e7 N/m^1.5: largest depth (5 m v0^2/4 k)^(2/5), force k x^1.5, duration 2.9432 x/v0
HERTZ = 1e7
DEPTH, FORCE, DURATION = 2.746401358e-4, 45.514105076, 8.083414964e-3

# damping ratio and e of a spring and dashpot that release where the force vanishes
DASHPOTS = {0.05: 0.858758101775, 0.1: 0.744079397722, 0.3: 0.450975452893}
SPRING = 1e5  # N/m
OF_CRITICAL = 2.0  # critical damping is 2 sqrt(k m)

NormalLaw = oo.HuntCrossley | oo.SpringDashpot


class Impact(NamedTuple):
    """Result of an impact: ratio of the speeds of separation and approach, and the rows of the contact."""

    restitution: float
    time: Array
    contact: oo.ContactTrace


def balls(normal: NormalLaw, masses: Sequence[float], speed: float) -> oo.WorldTrace:
    """Simulate balls in a row, 1 cm apart; the first one moves towards the others, which are at rest."""
    ball = oo.robots.load("ball")
    systems = [
        oo.System(
            "abc"[i], ball.with_link("body", mass=mass, inertia=0.4 * mass * 0.1**2 * np.eye(3)),
            [0.21 * i, 0, 0, 0, 0, 0, 1], [speed if i == 0 else 0.0, 0, 0, 0, 0, 0],
        )
        for i, mass in enumerate(masses)
    ]  # fmt: skip
    contacts = [
        oo.Contact(f"{a.name}/body", f"{b.name}/body", normal=normal, name=a.name + b.name)
        for a, b in itertools.pairwise(systems)
    ]
    lasts = 0.015 / speed * len(masses)
    trace = oo.Simulation(oo.World(systems, contacts=contacts), time_step=0.01).run(lasts)
    assert isinstance(trace, oo.WorldTrace)
    return trace


def impact(normal: NormalLaw) -> Impact:
    """Simulate the central impact of two equal balls, the second of which is at rest."""
    trace = balls(normal, (BALLS, BALLS), CLOSING)
    parting = float(trace["b"].v[-1, 0] - trace["a"].v[-1, 0])
    return Impact(parting / SPEED, trace["a"].time, trace.contacts["ab"])


def restitution() -> list[float]:
    """Return the largest error of the restitution for each exponent of the force law, 1 and 1.5."""
    return [
        worst(
            abs(impact(oo.HuntCrossley(k, n, dissipation=p / SPEED)).restitution - e)
            for p, e in RESTITUTIONS.items()
        )
        for n, k in LAWS
    ]


def unequal() -> list[float]:
    """Return the largest errors of both velocities after impacts of unequal balls at 0.1 and 0.2 m/s.

    For masses `m1` and `m2`, the initial speed `v` of the first ball and the restitution `e`, the velocities
    are `v (m1 - e m2)/(m1 + m2)` and `v m1 (1 + e)/(m1 + m2)`; the errors are relative to `v`.
    """
    errors = []
    for first, second in PAIRS:
        for speed in (SPEED, 2.0 * SPEED):
            law = oo.HuntCrossley(1e6, restitution=LOSS, speed=speed)
            trace = balls(law, (first, second), speed)
            a, b = trace["a"].v[-1, 0] / speed, trace["b"].v[-1, 0] / speed
            both = first + second
            errors.append((abs(a - (first - 0.7 * second) / both), abs(b - 1.7 * first / both)))
    return list(worst(errors))


def row() -> list[float]:
    """Return the relative errors of the velocities of three equal balls after two elastic impacts."""
    trace = balls(oo.HuntCrossley(HERTZ), (BALLS, BALLS, LAST), SPEED)
    return [abs(trace[name].v[-1, 0] / SPEED - end) for name, end in (("a", 0.0), ("b", 0.0), ("c", 1.0))]


def elastic() -> list[float]:
    """Return the errors of the coefficient of restitution for exponents 1 and 1.5, at 0.2 m/s.

    Without dissipation, the exact value is 1.
    """
    traces = (balls(oo.HuntCrossley(k, n), (BALLS, BALLS), 2.0 * CLOSING) for n, k in LAWS)
    return [abs(float(t["b"].v[-1, 0] - t["a"].v[-1, 0]) / (2.0 * SPEED) - 1.0) for t in traces]


def hertz() -> tuple[float, float, float]:
    """Return the relative errors of depth, force and duration of an elastic impact of spheres."""
    _, time, contact = impact(oo.HuntCrossley(HERTZ))
    depth, force = -contact.gap, np.linalg.norm(contact.force, axis=1)
    during = np.flatnonzero(force > 0.0)
    lasted = time[during[-1] + 1] - time[during[0]]
    return (
        abs(_peak(time, depth) / DEPTH - 1.0),
        abs(_peak(time, force) / FORCE - 1.0),
        float(abs(lasted / DURATION - 1.0)),
    )


def _peak(time: Array, values: Array) -> float:
    """Return the maximum of sampled values: the vertex of a parabola through three rows at the peak."""
    top = int(np.argmax(values))
    near = slice(top - 1, top + 2)
    a, b, c = np.polyfit(time[near] - time[top], values[near], 2)
    return float(c - b * b / (4.0 * a))


def dashpot() -> float:
    """Return the largest error of the restitution of a spring and dashpot for all damping ratios."""
    critical = OF_CRITICAL * np.sqrt(SPRING * MASS)
    found = (
        (impact(oo.SpringDashpot(SPRING, ratio * critical)).restitution, e) for ratio, e in DASHPOTS.items()
    )
    return float(worst(abs(measured - e) for measured, e in found))


def arms() -> tuple[float, float, float]:
    """Return the errors of linear and angular momentum of two arms that hit each other, and of their energy.

    Momenta are sums over the links, relative to the sum of the magnitudes of the impulses, and energies are
    relative to the energy at the start.
    """
    pusher = oo.robots.load("pusher")
    # base pose, joints, and velocities; the second arm faces the first
    starts = [
        ([0.0, 0.0, 0.0, 0, 0, 0, 1, 0.8, -1.6, 0.8], [0.15, 0, 0, 0.01, 0.01, 0.02, 0.01, -0.02, 0.01]),
        ([2.7, 0.0, 0.0, 0, 0, 1, 0, 0.6, -1.2, 0.9], [0.05, 0, 0, 0.02, -0.01, 0.01, -0.01, 0.02, 0.01]),
    ]
    states = [tuple(map(np.array, start)) for start in starts]
    systems = [oo.System(name, pusher, *state) for name, state in zip("ab", states, strict=True)]
    touch = oo.Contact(
        ["a/link_*", "a/hand", "a/pad", "a/bus"], ["b/link_*", "b/hand", "b/pad"], name="touch",
        normal=oo.HuntCrossley(1e5, restitution=0.8, speed=0.2), friction=oo.Friction(0.4),
    )  # fmt: skip
    trace = oo.Simulation(oo.World(systems, contacts=[touch]), time_step=0.01).run(10.0)
    assert isinstance(trace, oo.WorldTrace)
    contact = trace.contacts["touch"]
    before, after = (sum(_momentum(pusher, trace[name], row) for name in "ab") for row in (0, -1))
    force = np.linalg.norm(contact.force, axis=1)
    impulses = np.trapezoid(force, trace["a"].time)
    energy = trace.kinetic_energy + contact.elastic + contact.dissipated
    change = np.abs(np.subtract(after, before))
    return (
        float(change[:3].max() / impulses),
        float(change[3:].max() / impulses),
        float(np.abs(energy - energy[0]).max() / energy[0]),
    )


def _momentum(model: oo.Model, trace: oo.Trace, row: int) -> Array:
    """Return the momentum (6,) of a robot about the origin of W, as a sum over its links."""
    q, v = trace.q[row], trace.v[row]
    return momentum(Craft(model, q, v, "bus"), v, np.zeros(3))[0]


CASES = (
    Case(
        "contact", "restitution for d v0 from 0.01 to 10", "d v0 (1 + e) = ln[(1 + d v0)/(1 - e d v0)]",
        (Gate("restitution, exponent n = 1", 1e-6), Gate("restitution, exponent n = 1.5", 1e-6)), restitution,
    ),
    Case(
        "contact", "balls of unequal masses", "conservation of momentum, restitution 0.7",
        (Gate("velocity of the first", 1e-6), Gate("velocity of the second", 1e-6)), unequal,
    ),
    Case(
        "contact", "three balls in a row", "conservation of momentum and energy",
        (Gate("velocity of the first", 1e-8), Gate("velocity of the second", 1e-8),
         Gate("velocity of the last", 1e-8)), row,
    ),
    Case(
        "contact", "elastic impact of two balls", "conservation of energy",
        (Gate("restitution, exponent n = 1", 1e-8), Gate("restitution, exponent n = 1.5", 1e-8)), elastic,
    ),
    Case(
        "contact", "Hertz's impact of two balls", "Hertz 1882: (5 m v0^2/4 k)^(2/5), 2.9432 x/v0",
        (Gate("largest depth", 1e-6), Gate("largest force", 1e-6), Gate("duration", 1e-6)), hertz,
    ),
    Case(
        "contact", "spring and dashpot, damping ratios to 0.3", "solution of m x'' + c x' + k x = 0",
        (Gate("restitution", 1e-6),), lambda: [dashpot()],
    ),
    Case(
        "contact", "two tumbling arms collide", "Newton and Euler: no external wrench",
        (Gate("linear momentum", 1e-12), Gate("angular momentum", 1e-12), Gate("energy", 1e-8)), arms,
    ),
)  # fmt: skip
