"""What a robot that nothing holds must keep, whatever anybody has published."""

from __future__ import annotations

from typing import Any

import numpy as np

import onorbit_rs as oo
from onorbit_rs.validation.case import Case, Gate

ARM = [0.5342, -2.341, -2.0077, -2.2249, -2.2693, -0.1342, -0.1974]
TUMBLING = np.array([0.02, -0.01, 0.03, 0.1, -0.05, 0.08, 1.0, -0.8, 0.9, 1.1, -0.7, 1.0, -1.2])
STEP = 1e-3  # s


def humanoid() -> tuple[oo.Model, Any]:
    """The torso with one arm in the posture of the paper's reach."""
    model = oo.robots.load("humanoid_torso")
    q = model.neutral()
    q[7:] = ARM
    return model, q


def free_motion() -> tuple[float, float, float, float]:
    """Drifts of momentum, energy and centre of mass of a torso that tumbles while its arm swings."""
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
    """The energy (T,) in the frame that turns with a circular orbit, J.

    `Σ ½m|ρ̇−n×ρ|² + ½n²ρ_z²m − m n²R²X + ½(ω−n)·I(ω−n) − ½n·In + (3μ/2r³) r̂·I r̂` with `X = (s−1)²(s+2)/2s`,
    `s² = 1 + (2R u + ρ²)/R²`, `u = R̂·ρ`: tide and centrifugal potential together, without cancellation.
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
    """Drift of that integral as a share of the kinetic energy, 37 m from the reference, the arm limp."""
    model, q = humanoid()
    q[:3] = [20.0, -30.0, 10.0]  # where tides are not small
    orbit = oo.Kepler(semi_major_axis=RADIUS, inclination=np.radians(51.6), mean_anomaly=0.0)
    trace = oo.Simulation(
        model, q, 0.1 * TUMBLING, orbit=orbit, environment=[oo.GravityGradient()], time_step=0.005
    ).run(300.0)
    kept = jacobi(model, orbit, trace, slice(None, None, 200))
    return (float(np.abs(kept - kept[0]).max() / trace.kinetic_energy[0]),)


SLIDER_MASS, FRICTION, SPEED = 2.0, 3.0, 1.5  # kg, N, m/s


def stopped_by_friction() -> tuple[float, float]:
    """A slider on a base a million times as heavy stops after `v²/2a`, and stays: errors of both, m."""
    builder = oo.ModelBuilder("slider", base="base", mass=2e6, com=[0, 0, 0], inertia=1e6 * np.eye(3))
    builder.add_link(
        "link", parent="base", joint="slide", kind="prismatic", axis=[1, 0, 0], mass=SLIDER_MASS,
        com=[0, 0, 0], inertia=np.eye(3), friction=FRICTION,
    )  # fmt: skip
    model = builder.build()
    trace = oo.Simulation(
        model, model.neutral(), [0, 0, 0, 0, 0, 0, SPEED], time_step=0.01
    ).run(2.0)  # fmt: skip
    # both feel the friction: a = F (1/m + 1/M)
    expected = SPEED**2 / (2.0 * FRICTION * (1.0 / SLIDER_MASS + 1.0 / 2e6))
    at_rest = trace.q[trace.time > 1.5, 7]
    return abs(float(trace.q[-1, 7]) - expected), float(np.ptp(at_rest))


CASES = (
    Case(
        "conservation", "100 s of free motion of the humanoid", "Newton and Euler: nothing acts on the whole",
        (
            Gate("linear momentum", 1e-12), Gate("angular momentum", 1e-12),
            Gate("kinetic energy", 1e-8), Gate("centre of mass off its line", 1e-7, "m"),
        ), free_motion,
    ),
    Case(
        "conservation", "the humanoid on a circular orbit, 300 s", "Jacobi's integral",
        (Gate("energy in the turning frame", 1e-8),), in_orbit,
    ),
    Case(
        "conservation", "a slider that friction stops", "Coulomb: v²/2a",
        (Gate("where it stops", 1e-12, "m"), Gate("that it stays", 0.0, "m")), stopped_by_friction,
    ),
)  # fmt: skip
