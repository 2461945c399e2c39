"""Tests friction: sliding to rolling, oblique impacts, torsion, break-away, and the return after a pulse."""

from __future__ import annotations

import numpy as np

import onorbit_rs as oo
from onorbit_rs.tools.validation.case import Case, Gate
from onorbit_rs.tools.validation.contact_bodies import (
    IMMOVABLE,
    RADIUS,
    SPHERE,
    at,
    body,
    floor,
    oscillating,
    solid_sphere,
    turning,
)
from onorbit_rs.tools.validation.trees import Array

G = 9.81  # weight per mass, m/s^2
WEIGHT = G  # of 1 kg, N; used by the simulation
MU, STATIC, TORSIONAL = 0.3, 0.5, 0.002  # the last in m
FRICTION = oo.Friction(MU, stiffness=1e6)  # used by the simulation
STIFF = 1e6  # N/m
PRESSED = oo.HuntCrossley(STIFF, 1.0, dissipation=10.0)

# a solid sphere at 1 m/s: 2 v/(7 mu g), 12 v^2/(49 mu g) and 5/7 v
ROLLS_AFTER, ROLLS_AT, ROLLING = 0.097082665890, 0.083213713620, 0.714285714286


# oblique impacts
DOWN = 0.1  # normal speed, m/s
RESTITUTION = 0.8  # used by the simulation
BRISTLES = oo.Friction(MU, stiffness=1e12)
SLIPS, STICKS = 3.0, 0.5  # v_t/v_n; the limit is 3.5 mu (1 + e) = 1.89
IMPULSE = 0.3 * 1.8  # mu (1 + e)

# used by the simulation
HOLDS = STATIC
PULSE = 0.5  # tangential force relative to the cone


def pressed(sphere: oo.System, friction: oo.Friction, *loads: oo.BodyWrench, lasts: float) -> oo.WorldTrace:
    """Simulate a sphere on the floor; it starts at the depth at which its weight is balanced."""
    contact = oo.Contact(
        "floor/body", "sphere/body", normal=PRESSED, friction=friction, name="touch", start_overlapping=True
    )
    world = oo.World([floor(), sphere], contacts=[contact], environment=loads)
    trace = oo.Simulation(world, time_step=1e-3).run(lasts)
    assert isinstance(trace, oo.WorldTrace)
    return trace


def resting(model: oo.Model, velocity: tuple[float, ...] = (0, 0, 0, 0, 0, 0)) -> oo.System:
    """Return a sphere of 1 kg on the floor, at the depth at which its weight is balanced."""
    return at("sphere", model, [0.0, 0.0, RADIUS - G / STIFF], velocity)


def weight() -> oo.BodyWrench:
    """Return the weight of a sphere of 1 kg whose axis z remains parallel to that of W."""
    return oo.BodyWrench("sphere/body", force=[0.0, 0.0, -WEIGHT])


def block() -> oo.Model:
    """Return a sphere of 1 kg that cannot turn."""
    return body(SPHERE, 1.0, IMMOVABLE)


def rolling() -> tuple[float, float, float]:
    """Return the relative errors of time, path and speed at which a sliding sphere begins to roll."""
    lift = oo.BodyWrench("floor/body", force=[0.0, 0.0, (IMMOVABLE + 1.0) * WEIGHT])
    trace = pressed(resting(solid_sphere(), (1.0, 0, 0, 0, 0, 0)), FRICTION, lift, lasts=0.5)
    time, sphere, slip = trace["sphere"].time, trace["sphere"], trace.contacts["touch"].slip
    # the sliding speed decreases linearly
    rate, start = np.polyfit(*_between(time, slip, 0.02, 0.08), 1)
    ends = -start / rate
    path = np.interp(ends, time, sphere.q[:, 0])
    speed = sphere.momentum[-1, 0]  # of 1 kg
    return abs(ends / ROLLS_AFTER - 1.0), abs(path / ROLLS_AT - 1.0), abs(speed / ROLLING - 1.0)


def _between(time: Array, values: Array, start: float, end: float) -> tuple[Array, Array]:
    rows = (time > start) & (time < end)
    return time[rows], values[rows]


def oblique(across: float) -> tuple[float, float]:
    """Return the speeds along the floor and of the surface after an impact, relative to the normal speed.

    ``across`` is the ratio of tangential and normal speed before the impact.

    The contact is so stiff that the depth is 1e-4 of the radius, and the bristles are stiffer than the normal
    force: the closed form is the limit of a rigid contact, whose lever is the radius and which stores no
    tangential energy.
    """
    law = oo.HuntCrossley(1e11, restitution=RESTITUTION, speed=DOWN)
    contact = oo.Contact("floor/body", "sphere/body", normal=law, friction=BRISTLES, name="touch")
    velocity = [across * DOWN, 0, -DOWN, 0, 0, 0]
    sphere = at("sphere", solid_sphere(), [0.0, 0.0, RADIUS + 1e-4], velocity)
    trace = oo.Simulation(oo.World([floor(), sphere], contacts=[contact]), time_step=1e-3).run(5e-3)
    assert isinstance(trace, oo.WorldTrace)
    end = trace["sphere"].momentum[-1]
    return float(end[0] / DOWN), float(end[4] / (0.4 * RADIUS) / DOWN)


def slipping() -> tuple[float, float]:
    """Return the errors of both speeds, see :func:`oblique`, if the sphere slips throughout the impact."""
    speed, spin = oblique(SLIPS)
    return abs(speed - (SLIPS - IMPULSE)), abs(spin - 2.5 * IMPULSE)


def sticking() -> tuple[float, float]:
    """Return the errors of both speeds, see :func:`oblique`, if the sphere rolls at the end of the impact."""
    speed, spin = oblique(STICKS)
    return abs(speed - 5.0 / 7.0 * STICKS), abs(spin - 5.0 / 7.0 * STICKS)


def spinning() -> tuple[float, float]:
    """Return the error, rad/s, of a spin about the normal after 0.2 s, and the rate, rad/s, at the end."""
    friction = oo.Friction(MU, torsional=TORSIONAL, stiffness=1e6)
    trace = pressed(resting(solid_sphere(), (0, 0, 0, 0, 0, 2.0)), friction, weight(), lasts=3.0)
    time, rate = trace["sphere"].time, trace["sphere"].v[:, 5]
    row = int(np.searchsorted(time, 0.2))
    inertia = 0.4 * RADIUS**2
    return float(abs(rate[row] - (2.0 - 0.002 * G / inertia * time[row]))), float(abs(rate[-1]))


def stopping() -> tuple[float, float]:
    """Return the relative errors of path and dissipated energy of a body that slides to rest from 1 m/s."""
    trace = pressed(resting(block(), (1.0, 0, 0, 0, 0, 0)), FRICTION, weight(), lasts=0.5)
    path, (start, *_, end) = trace["sphere"].q[-1, 0], trace.contacts["touch"].dissipated
    return abs(path * 2.0 * 0.3 * G - 1.0), abs((end - start) / 0.5 - 1.0)


def break_away() -> tuple[float, float]:
    """Return the relative errors of the largest friction before a body slides, and of sliding friction."""
    model = body(SPHERE, 1.0, IMMOVABLE, rotors="0 0 1")
    growing = oscillating("sphere", 1.2 * STATIC * G, (1.0, 0.0, 0.0))
    start = turning("sphere", model, [0.0, 0.0, RADIUS - G / STIFF], 2.0)
    friction = oo.Friction(HOLDS, MU, stiffness=1e6)
    trace = pressed(start, friction, weight(), *growing, lasts=0.7)
    touch, time = trace.contacts["touch"], trace["sphere"].time
    ratio = np.hypot(touch.force[:, 0], touch.force[:, 1]) / touch.force[:, 2]
    late = time > 0.65
    slowest = float(touch.slip[late].min())
    if slowest < 0.01:
        raise ValueError(f"the body slides at only {slowest:.3g} m/s at the end; the minimum is 0.01 m/s")
    top = int(np.argmax(ratio))  # the last row at rest; the step after it ends where the body breaks away
    near = slice(top - 2, top + 1)
    at_cut = np.polyval(np.polyfit(time[near] - time[top], ratio[near], 2), time[top + 1] - time[top])
    return abs(float(at_cut) / STATIC - 1.0), float(np.abs(ratio[late] / MU - 1.0).max())


def returning() -> tuple[float]:
    """Return the displacement, m, that remains after a tangential force inside the cone acts for 0.1 s."""
    pulse = oo.BodyWrench("sphere/body", force=[PULSE * MU * G, 0.0, 0.0], start=0.1, end=0.2)
    trace = pressed(resting(block()), FRICTION, weight(), pulse, lasts=0.5)
    moved = trace["sphere"].q[:, 0]
    if moved.max() < 1e-7:
        raise ValueError(f"the force moved the body by only {moved.max():.3g} m; it must be at least 1e-7 m")
    return (abs(float(moved[-1])),)


CASES = (
    Case(
        "contact", "a sphere slides, then rolls", "2 v/(7 mu g), 12 v^2/(49 mu g) and 5/7 v",
        (Gate("time", 1e-4), Gate("path", 1e-4), Gate("speed", 1e-4)), rolling,
    ),
    Case(
        "contact", "oblique impact of a sphere that slips", "v_t - mu (1 + e) v_n, 5/2 mu (1 + e) v_n",
        (Gate("speed", 1e-4), Gate("circumferential speed", 1e-4)), slipping,
    ),
    Case(
        "contact", "oblique impact of a sphere that sticks", "5/7 v_t, if v_t < 7/2 mu (1 + e) v_n",
        (Gate("speed", 1e-4), Gate("circumferential speed", 1e-4)), sticking,
    ),
    Case(
        "contact", "torsional friction stops a spin", "torsional coefficient times normal force",
        (Gate("rate after 0.2 s", 1e-6, "rad/s"), Gate("rate at the end", 1e-9, "rad/s")), spinning,
    ),
    Case(
        "contact", "a body slides to rest", "Coulomb: v^2/(2 mu g) and m v^2/2",
        (Gate("path", 1e-4), Gate("dissipated energy", 1e-4)), stopping,
    ),
    Case(
        "contact", "a growing force moves a pressed body", "Coulomb: static and kinetic coefficient",
        (Gate("friction at rest", 1e-6), Gate("friction while sliding", 1e-6)), break_away,
    ),
    Case(
        "contact", "a body returns after a force inside the cone", "the friction cone is elastic inside",
        (Gate("displacement", 1e-9, "m"),), returning,
    ),
)  # fmt: skip
