"""Tests seating, the motion to a nominal pose after a capture, against closed forms of two bodies."""

from __future__ import annotations

import numpy as np

import onorbit_rs as oo
from onorbit_rs.common.coordinates import POSITION, QUATERNION
from onorbit_rs.common.rotations import matrix_from_quaternion
from onorbit_rs.tools.validation.capture import rigid, run
from onorbit_rs.tools.validation.case import Case, Gate

DURATION = 3.0  # s
SEAT = DURATION  # used by the simulation; the closed forms use the constants above
MASSES = (90.0, 10.0)  # kg
PULL = 1.0  # m
INERTIAS, TURN = (6.0, 2.0), 1.2  # kg m² about the axis of the turn, rad
TURNED = INERTIAS[1]  # used by the simulation


def pulled() -> tuple[float, float, float, float]:
    """Return the errors of final positions, m, energy halfway (relative), momentum, N s, and work, J.

    Two bodies are pulled together along the line through their centres of mass; the common centre of mass
    stays at rest. Halfway, the relative speed `v` is 15/8 of its mean, and the kinetic energy of the masses
    `m1` and `m2` is `½ m1 m2/(m1 + m2) v²`.
    """
    systems = [rigid("a", MASSES[0], [9, 9, 9], [0, 0, 0], np.zeros(6)),
               rigid("b", MASSES[1], [1, 1, 1], [2, 0, 0], np.zeros(6))]  # fmt: skip
    pose = np.eye(4)
    pose[0, 3] = 2.0 - PULL
    event = oo.Capture("grasp", "a/base", "b/base", at=0.0, seat=SEAT, pose=pose)
    trace = run(systems, [event], DURATION + 1.0, time_step=0.01)
    m1, m2 = MASSES
    ends = [trace[name].q[-1, 0] for name in "ab"]
    places = [m2 / (m1 + m2) * PULL, 2.0 - m1 / (m1 + m2) * PULL]
    middle = int(np.argmin(np.abs(trace["a"].time - DURATION / 2)))
    energy = sum(trace[name].kinetic_energy[middle] for name in "ab")
    expected = 0.5 * m1 * m2 / (m1 + m2) * (15 / 8 * PULL / DURATION) ** 2
    work = sum(float(trace[name].work[-1]) for name in "ab")
    return (
        float(np.abs(np.subtract(ends, places)).max()),
        float(abs(energy / expected - 1.0)),
        float(np.abs(trace.momentum).max()),
        abs(work),
    )


def turned() -> tuple[float, float]:
    """Return the errors of the first body's final attitude, rad, and of the relative rotation matrix.

    The bodies share a rotation `θ` about the common axis according to their moments of inertia `I1` and `I2`
    about it: the first turns by `θ1 = −θ I2/(I1 + I2)`. The first value is the larger one of the error of
    `θ1` and of the largest displacement of a body, m, which should be zero.
    """
    first, second = INERTIAS
    systems = [rigid("a", 50.0, [4, 4, first], [0, 0, 0], np.zeros(6)),
               rigid("b", 5.0, [1, 1, TURNED], [0, 0, 0], np.zeros(6))]  # fmt: skip
    pose = np.eye(4)
    pose[:2, :2] = [[np.cos(TURN), -np.sin(TURN)], [np.sin(TURN), np.cos(TURN)]]
    event = oo.Capture("grasp", "a/base", "b/base", at=0.0, seat=DURATION, pose=pose)
    trace = run(systems, [event], DURATION + 1.0, time_step=0.01)
    a, b = (matrix_from_quaternion(trace[name].q[-1, QUATERNION]) for name in "ab")
    moved = np.abs([trace[name].q[-1, POSITION] for name in "ab"]).max()
    angle = np.arctan2(a[1, 0], a[0, 0])
    share = abs(angle + TURN * second / (first + second))
    return float(max(share, moved)), float(np.abs(a.T @ b - pose[:3, :3]).max())


CASES = (
    Case(
        "capture", "a captured body is pulled by 1 m", "common centre of mass, ½ m1 m2/(m1 + m2) v²",
        (
            Gate("places", 1e-10, "m"), Gate("energy halfway", 1e-10), Gate("momentum", 1e-12, "N s"),
            Gate("work at the end", 1e-12, "J"),
        ), pulled,
    ),
    Case(
        "capture", "a captured body is turned by 1.2 rad", "θ1 = −θ I2/(I1 + I2)",
        (Gate("attitude", 1e-9, "rad"), Gate("relative attitude", 1e-14)), turned,
    ),
)  # fmt: skip
