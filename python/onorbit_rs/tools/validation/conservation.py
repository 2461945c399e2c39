"""Tests conservation laws of free-floating robots: momentum, energy and Jacobi's integral."""

from __future__ import annotations

from typing import Any

import numpy as np

import onorbit_rs as oo
from onorbit_rs.common.coordinates import JOINTS_Q
from onorbit_rs.tools.validation.case import Case, Gate

ARM = [0.5342, -2.341, -2.0077, -2.2249, -2.2693, -0.1342, -0.1974]
TUMBLING = np.array([0.02, -0.01, 0.03, 0.1, -0.05, 0.08, 1.0, -0.8, 0.9, 1.1, -0.7, 1.0, -1.2])
STEP = 1e-3  # s


def humanoid() -> tuple[oo.Model, Any]:
    """Return the torso with one arm, and its initial configuration in the OnOrbitROS paper's experiment."""
    model = oo.robots.load("humanoid_torso")
    q = model.neutral()
    q[JOINTS_Q] = ARM
    return model, q


def free_motion() -> tuple[float, float, float, float]:
    """Return the drifts of a tumbling torso with a swinging arm.

    The drifts are those of linear and angular momentum and kinetic energy, all relative, and the deviation of
    the centre of mass from a straight line, m.
    """
    model, q = humanoid()
    trace = oo.Simulation(model, q, 0.5 * TUMBLING, time_step=STEP, record_every=10).run(100.0)
    certificate = {name: value for name, value, *_ in trace.certificate()}

    def drift(kind: str) -> float:
        found = certificate[f"{kind}_momentum_drift_rel"]
        return float("inf") if found is None else found

    elapsed = trace.time[:, None]
    line = trace.center_of_mass[0] + elapsed * trace.momentum[0, :3] / model.mass
    energy = trace.kinetic_energy
    return (
        drift("linear"),
        drift("angular"),
        float(np.abs(energy / energy[0] - 1.0).max()),
        float(np.linalg.norm(trace.center_of_mass - line, axis=1).max()),
    )


RADIUS = 6_778e3


def jacobi(model: oo.Model, orbit: oo.Kepler, trace: oo.Trace, rows: slice) -> Any:
    """Return the energy, (T,), J, in the frame that rotates with a circular orbit.

    `Σ ½m|ρ̇−n×ρ|² + ½n²ρ_z²m − m n²R²X + ½(ω−n)·I(ω−n) − ½n·In + (3μ/2r³) r̂·I r̂` with `X = (s−1)²(s+2)/2s`,
    `s² = 1 + (2R u + ρ²)/R²`, `u = R̂·ρ`. Tidal and centrifugal potential are combined, which avoids
    cancellation. The sum is over links of mass `m`, inertia `I`, rate `ω` and position `ρ` from the
    reference; the reference orbit has radius `R`, direction `R̂` and rate `n`, with `ρ_z` along `n`. The link
    is at the distance `r` from the Earth, with gravitational parameter `μ`, in the direction `r̂`.
    """
    q, v, t = trace.q[rows], trace.v[rows], trace.time[rows]
    r, velocity = orbit.state(t)
    radius = np.linalg.norm(r, axis=1)
    n = np.cross(r, velocity) / (radius**2)[:, None]
    total = np.zeros(len(t))
    for body in model.bodies:
        pose = model.frame_pose(q, body.name)
        twist = model.frame_velocity(q, v, body.name)
        arm = pose[:, :3, :3] @ np.array(body.com)
        rho = pose[:, :3, 3] + arm
        rate = twist[:, :3] + np.cross(twist[:, 3:], arm) - np.cross(n, rho)
        shift = (2.0 * np.sum(r * rho, axis=1) + np.sum(rho**2, axis=1)) / radius**2
        s = np.sqrt(1.0 + shift)
        x = (shift / (1.0 + s)) ** 2 * (s + 2.0) / (2.0 * s)
        total += body.mass * (
            0.5 * np.sum(rate**2, axis=1)
            + 0.5 * np.sum(n * rho, axis=1) ** 2
            - np.sum(n * n, axis=1) * radius**2 * x
        )
        inertia = pose[:, :3, :3] @ np.array(body.inertia) @ np.swapaxes(pose[:, :3, :3], 1, 2)
        place = r + rho
        distance = np.linalg.norm(place, axis=1)
        for vector, weight in (
            (twist[:, 3:] - n, 0.5), (n, -0.5),
            (place / distance[:, None], 1.5 * oo.MU_EARTH / distance**3),
        ):  # fmt: skip
            total += weight * np.einsum("ti,tij,tj->t", vector, inertia, vector)
    return total


def in_orbit() -> tuple[float]:
    """Return the drift of Jacobi's integral, relative to kinetic energy, 37 m from the reference."""
    model, q = humanoid()
    q[:3] = [20.0, -30.0, 10.0]  # far enough for tides to matter
    orbit = oo.Kepler(semi_major_axis=RADIUS, inclination=np.radians(51.6), mean_anomaly=0.0)
    trace = oo.Simulation(
        model, q, 0.1 * TUMBLING, orbit=orbit, environment=[oo.GravityGradient()], time_step=0.005
    ).run(300.0)
    kept = jacobi(model, orbit, trace, slice(None, None, 200))
    return (float(np.abs(kept - kept[0]).max() / trace.kinetic_energy[0]),)


SLIDER_MASS, FRICTION, SPEED = 2.0, 3.0, 1.5  # kg, N, m/s


def stopped_by_friction() -> tuple[float, float]:
    """Return the error of a slider's stopping distance `v²/2a`, and its motion after the stop, m.

    `v` is the initial speed, `a` the deceleration by friction.

    The slider moves on a base that is a million times heavier.
    """
    builder = oo.ModelBuilder("slider", base="base", mass=2e6, com=[0, 0, 0], inertia=1e6 * np.eye(3))
    builder.add_link(
        "link", parent="base", joint="slide", kind="prismatic", axis=[1, 0, 0], mass=SLIDER_MASS,
        com=[0, 0, 0], inertia=np.eye(3), friction=FRICTION,
    )  # fmt: skip
    model = builder.build()
    trace = oo.Simulation(
        model, model.neutral(), [0, 0, 0, 0, 0, 0, SPEED], time_step=0.01
    ).run(2.0)  # fmt: skip
    # friction acts on both bodies: a = F (1/m + 1/M)
    expected = SPEED**2 / (2.0 * FRICTION * (1.0 / SLIDER_MASS + 1.0 / 2e6))
    at_rest = trace.q[trace.time > 1.5, 7]
    return abs(float(trace.q[-1, 7]) - expected), float(np.ptp(at_rest))


CASES = (
    Case(
        "conservation", "100 s of free motion of the humanoid", "Newton and Euler: no external wrench",
        (
            Gate("linear momentum", 1e-12), Gate("angular momentum", 1e-12),
            Gate("kinetic energy", 1e-8), Gate("deviation of the centre of mass", 1e-7, "m"),
        ), free_motion,
    ),
    Case(
        "conservation", "the humanoid on a circular orbit, 300 s", "Jacobi's integral",
        (Gate("energy in the rotating frame", 1e-8),), in_orbit,
    ),
    Case(
        "conservation", "a slider stopped by friction", "Coulomb: v²/2a",
        (Gate("stopping distance", 1e-12, "m"), Gate("motion after the stop", 0.0, "m")), stopped_by_friction,
    ),
)  # fmt: skip
