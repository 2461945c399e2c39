"""Tests the rotation of one body: NASA's brick, a torque-free symmetric top, and librations in orbit."""

from __future__ import annotations

from functools import partial

import numpy as np

import onorbit_rs as oo
from onorbit_rs.common.coordinates import QUATERNION
from onorbit_rs.common.rotations import matrix_from_quaternion, quaternion_from_matrix
from onorbit_rs.tools.validation.case import Case, Gate
from onorbit_rs.tools.validation.nasa import MU, TYPICAL

# slug ft², degrees per second; only the ratios of the moments matter
BRICK = [0.001894220, 0.006211019, 0.007194665]
BRICK_START, BRICK_END = [10.0, 20.0, 30.0], [12.618390776, -17.397474762, 31.119588887]


def brick() -> tuple[float]:
    """Return the largest error of the tumbling brick's angular velocity after 30 s, deg/s."""
    body = oo.Model.rigid_body(1.0, np.diag(BRICK))
    v = np.concatenate([np.zeros(3), np.radians(BRICK_START)])
    trace = oo.Simulation(body, body.neutral(), v, time_step=1e-3, record_every=1000).run(30.0)
    return (float(np.abs(np.degrees(trace.v[-1, 3:]) - BRICK_END).max()),)


TOP = (2.0, 2.0, 3.0)  # kg m²; the symmetry axis is last
SPIN = np.array([0.3, 0.0, 1.1])  # rad/s


def top() -> tuple[float, float]:
    """Return the errors of the top's rate, rad/s, and of the direction of its axis, rad, after 100 s.

    With the moments of inertia `C` about the symmetry axis and `A` across it, the angular velocity rotates in
    body axes about the symmetry axis at `λ = (C/A - 1) ω₃`, where `ω₃` is its component along that axis; in
    inertial axes, the symmetry axis rotates about the angular momentum `L` at `|L|/A`.
    """
    a, _, c = TOP
    body = oo.Model.rigid_body(1.0, np.diag(TOP))
    v = np.concatenate([np.zeros(3), SPIN])
    end = 100.0
    trace = oo.Simulation(body, body.neutral(), v, time_step=0.005, record_every=20_000).run(end)
    turn = (c / a - 1.0) * SPIN[2] * end
    rate = [SPIN[0] * np.cos(turn), SPIN[0] * np.sin(turn), SPIN[2]]
    momentum = np.array([a * SPIN[0], 0.0, c * SPIN[2]])
    size = float(np.linalg.norm(momentum))
    along = momentum / size
    angle = size / a * end
    # Rodrigues' formula on the axis z about L
    z = np.array([0.0, 0.0, 1.0])
    axis = z * np.cos(angle) + np.cross(along, z) * np.sin(angle) + along * along[2] * (1.0 - np.cos(angle))
    found = matrix_from_quaternion(trace.q[-1, QUATERNION])[:, 2]
    return float(np.abs(trace.v[-1, 3:] - rate).max()), float(np.linalg.norm(found - axis))


CYLINDER = (500.0, 12250.0, 12250.0)  # kg m², that of NASA's run 10A
TILT = 1e-3  # rad


def libration(axis: int, period_s: float) -> tuple[float]:
    """Return the relative error of the libration period about axis 2 (in plane) or 1 (out of plane)."""
    cylinder = oo.Model.rigid_body(1000.0, np.diag(CYLINDER))
    a = oo.Kepler.from_state(*TYPICAL, mu=MU).semi_major_axis
    orbit = oo.Kepler(semi_major_axis=a, inclination=0.9, raan=0.3, mu=MU)
    rot_il, w = orbit.lvlh(0.0)
    # the long axis is tilted by 1 mrad from the vertical and at rest in the local orbital frame
    c, s = np.cos(TILT), np.sin(TILT)
    in_plane, out_of_plane = [[c, -s, 0], [s, c, 0], [0, 0, 1]], [[c, 0, s], [0, 1, 0], [-s, 0, c]]
    tilt = np.array(in_plane if axis == 2 else out_of_plane)
    q = np.concatenate([np.zeros(3), quaternion_from_matrix(rot_il @ tilt)])
    v = np.concatenate([np.zeros(3), tilt.T @ w])
    trace = oo.Simulation(
        cylinder, q, v, orbit=orbit, environment=[oo.GravityGradient()], time_step=2.0, record_every=5
    ).run(20_000.0)
    rot_il, _ = orbit.lvlh(trace.time)
    long_axis = matrix_from_quaternion(trace.q[:, QUATERNION])[..., 0]
    off = np.einsum("tij,ti->tj", rot_il, long_axis)[:, 1 if axis == 2 else 2]
    rises = np.flatnonzero((off[:-1] < 0) & (off[1:] >= 0))
    # zeros of a sine by linear interpolation between rows 10 s apart: exact to 1e-6 of a period
    phase = np.array([np.interp(0.0, off[i : i + 2], trace.time[i : i + 2]) for i in rises])
    return (float(abs((phase[-1] - phase[0]) / (len(phase) - 1) / period_s - 1.0)),)


CASES = (
    Case(
        "rotation", "a tumbling brick, 30 s",
        "NASA/TM-2015-218675, atmospheric case 2, two of four simulators",
        (Gate("rate", 1e-8, "deg/s"),), brick,
    ),
    Case(
        "rotation", "a torque-free symmetric top, 100 s",
        "Euler; Landau and Lifshitz, Mechanics, sections 33 and 36",
        (Gate("rate", 1e-9, "rad/s"), Gate("axis", 1e-9, "rad")), top,
    ),
    *(
        Case(
            "rotation", f"small libration {where} of the orbit", f"linear theory: {period_s:g} s",
            (Gate("period", 1e-4),), partial(libration, axis, period_s),
        )
        for axis, period_s, where in ((2, 3259.797, "in the plane"), (1, 2808.169, "out of the plane"))
    ),
)  # fmt: skip
