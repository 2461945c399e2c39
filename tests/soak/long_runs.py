"""Long runs: their certificate is green, and where the motion has a closed form their error is small."""

from __future__ import annotations

import time
from typing import Any

import numpy as np

import onorbit_rs as oo
from onorbit_rs.scenario import Scenario, load
from onorbit_rs.scenario.build import build


def red(trace: oo.Trace) -> list[str]:
    """Checks of a run that are not passed."""
    rows = trace.certificate()
    return [f"{name} {value} > {gate}" for name, value, gate, is_passed in rows if not is_passed]


def spin(steps: int, *, time_step: float = 1e-3, record_every: int = 1000) -> dict[str, Any]:
    """A body that turns evenly about a principal axis: its error and certificate after ``steps`` steps."""
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
    """The bundled humanoid tumbling with a limp arm for a long time."""
    data = load("free_tumble").resolved()
    # at the scenario's 2 ms, differences to halved steps add up to 1.01 of the gate of the joints in an hour
    data["simulation"] |= {"duration": duration, "time_step": 1e-3, "record_every": 100}
    started, built = time.monotonic(), build(Scenario(**data))
    trace = built.simulation.run(duration)
    return {"simulated_s": duration, "seconds": round(time.monotonic() - started, 1), "wrong": red(trace)}
