"""Worker process that times this package from Python: ``ours.py FOLDER``.

The environment variable ``ONORBIT_INSTRUCTION_SET`` selects a lower instruction set.
"""

from __future__ import annotations

import itertools
import os
import sys
from pathlib import Path
from typing import Any

import contact
import inputs
import numpy as np
from worker import Job, serve

import onorbit_rs as oo

folder = Path(sys.argv[1])
model = oo.Model.from_urdf(folder / "robot.urdf")
nq, nv = model.nq, model.nv
q, v, x = inputs.read(folder / "states.bin", nq, nv, nv)
arms_q, arms_v, _ = inputs.read(folder / "arms.bin", nq, nv, nv)
batch = [np.tile(rows, (8, 1)) for rows in (q, v, x)]
law = oo.ComputedTorque(model, "tool", kp=inputs.KP, kd=inputs.KD, null_space_damping=inputs.SELF_MOTION)
start = model.frame_pose(inputs.reach(model), "tool")
path = oo.LineParabola(
    start, displacement=inputs.DISPLACEMENT, height=inputs.HEIGHT, duration=inputs.DURATION
)


def output(kernel: Any, *given: Any) -> dict[str, Any]:
    """Returns the argument ``out`` with arrays for the results; empty if the kernel has no such argument."""
    result = kernel(*given, threads=1)
    try:
        kernel(*given, threads=1, out=result)
    except TypeError:
        return {}
    return {"out": result}


def batch_of(kernel: Any, *given: Any) -> Job:
    out = output(kernel, *given)

    def first() -> Any:
        result = kernel(*given, threads=1)
        return [part[: len(q)] for part in (result if isinstance(result, tuple) else (result,))]

    return Job(len(given[0]), lambda: kernel(*given, threads=1, **out), first)


def calls() -> None:
    for k in range(len(q)):
        model.forward_dynamics(q[k], v[k], x[k])


def passive() -> Job:
    runs = [oo.Simulation(model, *state, time_step=inputs.TIME_STEP) for state in zip(q, v, strict=True)]
    duration = inputs.PASSIVE_STEPS * inputs.TIME_STEP
    turn = itertools.cycle(runs[: inputs.PASSIVE_RUNS])

    def ends() -> Any:
        traces = [run.run(duration) for run in runs[: inputs.PASSIVE_RUNS]]
        return np.array([trace.q[-1] for trace in traces]), np.array([trace.v[-1] for trace in traces])

    return Job(inputs.PASSIVE_STEPS, lambda: next(turn).run(duration), ends)


def rollout(threads: int) -> Job:
    def run() -> Any:
        return oo.rollout(
            model, q, v, steps=inputs.ROLLOUT_STEPS, time_step=inputs.TIME_STEP, threads=threads
        )

    return Job(len(q) * inputs.ROLLOUT_STEPS, run, run, threads)


def controlled_rollout() -> Job:
    def run() -> Any:
        control = {"controller": law, "reference": path, "threads": 1}
        return oo.rollout(
            model, arms_q, arms_v, steps=inputs.CONTROLLED_STEPS, time_step=inputs.TIME_STEP, **control
        )

    return Job(len(arms_q) * inputs.CONTROLLED_STEPS, run, run)


def reach(**environment: Any) -> Job:
    """Returns the job of the scenario ``humanoid_reach`` in `environment`, with every step recorded.

    The result is the final state without the environment.
    """
    control = {"controller": law, "reference": path, "tool": "tool", "time_step": inputs.TIME_STEP}
    run = oo.Simulation(model, arms_q[0], arms_v[0], **control, **environment)
    duration = inputs.REACH_STEPS * inputs.TIME_STEP

    def end() -> Any:
        trace = oo.Simulation(model, arms_q[0], arms_v[0], **control).run(duration)
        return trace.q[-1:], trace.v[-1:]

    return Job(inputs.REACH_STEPS, lambda: run.run(duration), end)


def touch(pads: contact.Pads, parts: int = 1) -> Job:
    """Returns the job of two craft in contact, with steps divided by `parts` and every step recorded."""
    run = contact.simulation(folder, pads, contact.TIME_STEP / parts)
    steps = len(run.run(pads.duration)["a"].time) - 1
    return Job(steps, lambda: run.run(pads.duration), lambda: contact.ends(run.run(pads.duration)))


orbit = oo.Kepler(
    semi_major_axis=6778e3, eccentricity=0.0005, inclination=np.radians(51.6), raan=np.radians(30)
)
jobs = {
    "call": Job(
        len(q), calls, lambda: [np.array([model.forward_dynamics(*s) for s in zip(q, v, x, strict=True)])]
    ),
    "batch": batch_of(model.forward_dynamics, *batch),
    "passive": passive(),
    "rollout": rollout(1),
    "rollout_threads": rollout(os.cpu_count() or 1),
    "controlled_rollout": controlled_rollout(),
    "reach": reach(orbit=orbit, environment=[oo.GravityGradient()]),
    "reach_empty": reach(),
}
if hasattr(oo, "Contact"):
    jobs["contact"], jobs["hard_contact"] = touch(contact.SOFT), touch(contact.HARD)
    jobs["converged_contact"] = touch(contact.SOFT, contact.FINER)
    jobs["converged_hard_contact"] = touch(contact.HARD, contact.FINER)
if hasattr(model, "forward_dynamics_derivatives"):
    jobs["derivatives"] = batch_of(model.forward_dynamics_derivatives, *batch)
steps = {name: job.units for name, job in jobs.items() if "contact" in name}
serve(oo.build_info()["instruction_set"], jobs, steps=steps)
