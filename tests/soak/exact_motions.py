"""Motions with exact solutions over hours and millions of rows: certificates pass and errors are small."""

from __future__ import annotations

import time
from typing import Any

import numpy as np
from long_runs import red

import onorbit_rs as oo

RADIUS = 6778e3  # m
RATE = float(np.sqrt(oo.MU_EARTH / RADIUS**3))  # rad/s
ORBIT = oo.Kepler.from_state([RADIUS, 0, 0], [0, RADIUS * RATE, 0])


def about_z(angle: float) -> np.ndarray:
    """Returns the quaternion of a rotation about z, rad."""
    return np.array([0.0, 0.0, np.sin(0.5 * angle), np.cos(0.5 * angle)])


def turned(attitude: np.ndarray, angle: float) -> float:
    """Returns the angle between an attitude and a rotation about z, rad."""
    exact = about_z(angle)
    return float(2.0 * np.linalg.norm(attitude * np.sign(attitude @ exact) - exact))


def spins(seed: int, count: int, rows: int) -> dict[str, Any]:
    """Runs bodies of many shapes in uniform rotation about z at many rates and steps; records every step."""
    rng, began, wrong, worst = np.random.default_rng(seed), time.monotonic(), [], 0.0
    for _ in range(count):
        moments = np.sort(rng.uniform(1.0, 1.9, 3)) * 10 ** rng.uniform(-6, 8)
        rate = 10 ** rng.uniform(-5, 0.5)
        step = min(10 ** rng.uniform(-4, 1), 0.1 / rate)
        model = oo.Model.rigid_body(10 ** rng.uniform(-3, 6), np.diag(moments))
        v = np.array([0, 0, 0, 0, 0, rate])
        trace = oo.Simulation(model, model.neutral(), v, time_step=step).run(rows * step)
        wrong += [f"{rate:g} rad/s, {step:g} s: {check}" for check in red(trace)]
        worst = max(worst, turned(trace.q[-1, 3:7], rate * trace.time[-1]))
    return {"rows": rows, "seconds": round(time.monotonic() - began, 1), "error": worst, "wrong": wrong}


def earth_pointing(orbits: float, time_step: float) -> dict[str, Any]:
    """Runs an Earth-pointing rigid body that is stabilised by the gravity gradient."""
    began = time.monotonic()
    trace = oo.Simulation(
        oo.Model.rigid_body(100.0, np.diag([8.0, 10.0, 12.0])), np.array([0, 0, 0, 0, 0, 0, 1.0]),
        np.array([0, 0, 0, 0, 0, RATE]), orbit=ORBIT, environment=[oo.GravityGradient()],
        time_step=time_step, record_every=100,
    ).run(orbits * 2.0 * np.pi / RATE)  # fmt: skip
    error = turned(trace.q[-1, 3:7], RATE * trace.time[-1])
    seconds = round(time.monotonic() - began, 1)
    return {"orbits": orbits, "time_step": time_step, "seconds": seconds, "error": error, "wrong": red(trace)}


def station(orbits: float, time_step: float) -> dict[str, Any]:
    """Runs the bundled station with locked arm under gravity gradient; without an exact solution."""
    began, arm = time.monotonic(), oo.robots.load("station_arm")
    hold = oo.Control(oo.JointComputedTorque(kp=25.0, kd=10.0), reference=oo.JointHold(arm.neutral()[7:]))
    trace = oo.Simulation(
        arm, arm.neutral(), np.zeros(arm.nv), orbit=ORBIT, environment=[oo.GravityGradient()],
        controller=[hold], time_step=time_step, record_every=100,
    ).run(orbits * 2.0 * np.pi / RATE)  # fmt: skip
    return {"orbits": orbits, "seconds": round(time.monotonic() - began, 1), "wrong": red(trace)}
