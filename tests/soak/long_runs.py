"""Long runs: certificates pass, and errors are small for motions with a closed form."""

from __future__ import annotations

import time
from typing import Any

import numpy as np

import onorbit_rs as oo
from onorbit_rs.scenario import Scenario, load
from onorbit_rs.scenario.build import build
from onorbit_rs.tools.validation import contact_grasp


def red(trace: oo.Trace) -> list[str]:
    """Returns the failed checks of a run."""
    rows = trace.certificate()
    return [f"{name} {value} > {gate}" for name, value, gate, is_passed in rows if not is_passed]


def spin(steps: int, *, time_step: float = 1e-3, record_every: int = 1000) -> dict[str, Any]:
    """Returns error and failed checks of a uniform rotation about a principal axis after ``steps`` steps."""
    rate, started = 0.1, time.monotonic()
    model = oo.Model.rigid_body(100.0, np.diag([10.0, 20.0, 30.0]))
    v = np.zeros(6)
    v[5] = rate
    simulation = oo.Simulation(model, model.neutral(), v, time_step=time_step, record_every=record_every)
    trace = simulation.run(steps * time_step)
    half = 0.5 * rate * trace.time[-1]
    exact = np.array([0.0, 0.0, np.sin(half), np.cos(half)])
    attitude = trace.q[-1, 3:7] * np.sign(trace.q[-1, 3:7] @ exact)
    return {
        "steps": steps,
        "seconds": round(time.monotonic() - started, 1),
        "attitude_error": float(2.0 * np.linalg.norm(attitude - exact)),
        "wrong": red(trace),
    }


def arm(duration: float) -> dict[str, Any]:
    """Runs the bundled humanoid, tumbling with an unactuated arm, for a long time."""
    data = load("free_tumble").resolved()
    # at the scenario's 2 ms, the step-doubling error of the joints reaches 1.01 of its gate in an hour
    data["simulation"] |= {"duration": duration, "time_step": 1e-3, "record_every": 100}
    started, built = time.monotonic(), build(Scenario(**data))
    trace = built.simulation.run(duration)
    return {"simulated_s": duration, "seconds": round(time.monotonic() - started, 1), "wrong": red(trace)}


def grasp(duration: float, normal: float) -> dict[str, Any]:
    """Returns the drift of a capsule that two pads hold with ``normal``, N, under a constant load."""
    started = time.monotonic()
    drift = contact_grasp.held(normal, contact_grasp.LOAD, 0.0, duration)
    wrong = [] if drift < DRIFT else [f"drift {drift} > {DRIFT} m/s"]
    return {
        "simulated_s": duration, "normal": normal, "seconds": round(time.monotonic() - started, 1),
        "drift": drift, "wrong": wrong,
    }  # fmt: skip


DRIFT = 1e-9  # m/s
