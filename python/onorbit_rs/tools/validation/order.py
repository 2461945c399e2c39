"""Measures the order of convergence of the integrators and of interpolated paths."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

import onorbit_rs as oo
from onorbit_rs.common.coordinates import ANGULAR, JOINTS_V, LINEAR
from onorbit_rs.tools.validation.case import Case, Gate, worst
from onorbit_rs.tools.validation.trees import build, random_state, random_tree

SEED, DURATION = 3, 2.0
NAMES = {
    "rk4": "a tree of eight links by RK4",
    "semi_implicit_euler": "a tree of eight links by semi-implicit Euler",
}
STEPS = {"rk4": 160, "semi_implicit_euler": 1600}
EXPECTED = {"rk4": 4.0, "semi_implicit_euler": 1.0}


def robot() -> tuple[oo.Model, Any, Any]:
    """Return a robot of eight links with joints of every kind, with a configuration and velocities."""
    model = build(random_tree(SEED, links=8))
    state = random_state(model, np.random.default_rng(7), frames=1)
    return model, state.q, 0.5 * state.v


def end(integrator: Any, steps: int) -> Any:
    """Return the configuration (nq,) of the robot after a run with this number of steps."""
    model, q, v = robot()
    settings: Any = {"integrator": integrator, "time_step": DURATION / steps, "record_every": steps}
    return oo.Simulation(model, q, v, **settings).run(DURATION).q[-1]


def orders(integrator: str) -> tuple[float, float, float]:
    """Return the deviations of measured orders (position, attitude, joints) from the method's order."""
    model, *_ = robot()
    exact = end("rk4", 8000)

    def errors(steps: int) -> Any:
        off = model.difference(exact, end(integrator, steps))
        return np.array([np.linalg.norm(part) for part in (off[LINEAR], off[ANGULAR], off[JOINTS_V])])

    steps = STEPS[integrator]
    found = np.log2(errors(steps) / errors(2 * steps))
    position, attitude, joints = np.abs(found - EXPECTED[integrator])
    return position, attitude, joints


TOLERANCES = [1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9]
TUMBLING = [0.1, 0.0, -0.2, 0.7, 0.9, -0.4]


def adaptive() -> tuple[float]:
    """Return the largest attitude error over one and a half revolutions, divided by the tolerance."""
    body = oo.Model.rigid_body(10.0, np.diag([1.0, 2.0, 2.5]))

    def run(**settings: Any) -> Any:
        return oo.Simulation(body, body.neutral(), TUMBLING, **settings).run(8.0).q

    exact = run(time_step=2e-4, record_every=2000)
    errors = []
    for tolerance in TOLERANCES:
        found = run(integrator="dormand_prince", tolerance=tolerance, time_step=0.4)
        off = np.linalg.norm(body.difference(exact, found)[:, 3:], axis=1).max()
        errors.append(off / tolerance)
    return (worst(errors),)


PATHS = {"positions": 4.0, "positions and velocities": 6.0}


def path(given: str) -> tuple[float]:
    """Return the deviation of the measured order of an interpolated ellipse from the order of the spline."""
    orbit = oo.Kepler(semi_major_axis=8e6, eccentricity=0.15, inclination=0.9, raan=0.3, mean_anomaly=0.0)
    between = np.linspace(0.0, 2000.0, 998)

    def error(pieces: int) -> float:
        uneven = np.where(np.arange(pieces + 1) % 2, 0.2, 0.0)
        uneven[-1] = 0.0
        times = 2000.0 / pieces * (np.arange(pieces + 1) + uneven)
        r, v = orbit.state(times)
        along = oo.CustomPath(times, r, velocities=v if "velocities" in given else None)
        return float(np.linalg.norm(along.state(between)[0] - orbit.state(between)[0], axis=1).max())

    return (abs(float(np.log2(error(10) / error(20))) - PATHS[given]),)


CASES = (
    *(
        Case(
            "order", f"{NAMES[integrator]}, step halved",
            f"order {EXPECTED[integrator]:g}",
            tuple(Gate(f"convergence order, {what}", limit) for what in ("position", "attitude", "joints")),
            partial(orders, integrator),
        )
        for integrator, limit in (("rk4", 0.4), ("semi_implicit_euler", 0.15))
    ),
    Case(
        "order", "Dormand and Prince's pair, tolerances 1e-4 to 1e-9", "within a factor of ten over a turn",
        (Gate("attitude, in tolerances", 10.0),), adaptive,
    ),
    *(
        Case(
            "order", f"a path through {given}, spacing halved", f"order {expected:g}",
            (Gate("convergence order", 0.6),), partial(path, given),
        )
        for given, expected in PATHS.items()
    ),
)  # fmt: skip
