"""Compares relative motion in orbit with Hill's equations."""

from __future__ import annotations

import numpy as np

import onorbit_rs as oo
from onorbit_rs.tools.validation.case import Case, Gate

VALLADO = "Vallado, Fundamentals of Astrodynamics, 2007, example 6-14 (valladopy, tests)"
MU, RADIUS = 398600.4415e9, 6968136.3  # m³/s², m: 590 km up
FLIGHT_S = 300.0
# x radial, y along track, z across; m, m/s
START = [0.0, 0.0, 0.0, -0.1, -0.04, -0.02]
END = [
    -33.345724432187964, -1.473560307487475, -5.894530311607677,
    -0.120337093866688, 0.032387584447866, -0.018949031717993,
]  # fmt: skip
FROM = [-70.933, 20.357, -11.17]
INTERCEPT = [0.274190838333, 0.013466718841345, 0.035907981315]


def mean_motion() -> float:
    """Return the mean motion of the target's orbit, rad/s."""
    return float(np.sqrt(MU / RADIUS**3))


def transition() -> tuple[float, float]:
    """Return the errors of position, m, and velocity, m/s, after 300 s of free flight."""
    end = oo.relative.hill_transition(mean_motion(), FLIGHT_S) @ START - np.array(END)
    return float(np.abs(end[:3]).max()), float(np.abs(end[3:]).max())


def intercept() -> tuple[float]:
    """Return the error of the initial velocity, m/s, with which a body reaches its target after 300 s."""
    found = oo.relative.intercept_velocity(mean_motion(), FROM, FLIGHT_S)
    return (float(np.abs(found - np.array(INTERCEPT)).max()),)


ALTITUDE_RADIUS = 6_778_137.0


def ellipse() -> tuple[float, float]:
    """Simulate a point 100 m above and 50 m beside its target, and 0.23 m/s slower, for two revolutions.

    Returns the distance from Hill's closed form, m, which is of second order in the separation, and the
    relative deviation of the ratio of the ellipse's axes from 2.
    """
    chief = oo.Kepler(semi_major_axis=ALTITUDE_RADIUS, inclination=np.radians(51.6))
    n = np.sqrt(oo.MU_EARTH / ALTITUDE_RADIUS**3)
    start = np.array([100.0, 0.0, 50.0, 0.0, -2.0 * n * 100.0, 0.0])
    rotation, rate = chief.lvlh(0.0)
    body = oo.Model.rigid_body(100.0, np.eye(3))
    q = body.neutral()
    q[:3] = rotation @ start[:3]
    v = np.zeros(6)
    v[:3] = rotation @ (start[3:] + np.cross(rate, start[:3]))
    duration = 2.0 * float(chief.period or 0.0)
    trace = oo.Simulation(body, q, v, orbit=chief, time_step=5.0).run(duration)
    place, _ = oo.relative.to_lvlh(chief, trace.time, trace.position_eci, trace.velocity_eci)
    closed = (oo.relative.hill_transition(n, trace.time) @ start)[:, :3]
    high, wide, _ = np.ptp(place, axis=0)
    return float(np.linalg.norm(place - closed, axis=1).max()), abs(wide / high / 2.0 - 1.0)


CASES = (
    Case(
        "relative", "300 s of free flight", VALLADO,
        (Gate("position", 1e-11, "m"), Gate("velocity", 1e-13, "m/s")), transition,
    ),
    Case("relative", "velocity to a target in 300 s", VALLADO, (Gate("velocity", 1e-10, "m/s"),), intercept),
    Case(
        "relative", "a body integrated beside its target, two revolutions",
        "Hill, American Journal of Mathematics 1, 1878: the closed form",
        (Gate("position", 0.05, "m"), Gate("length over height", 0.02)), ellipse,
    ),
)  # fmt: skip
