"""Worker process that times the capture of a rigid craft by another one, and measures its accuracy.

The craft are rigidly connected at t = 0 at the point (1.5, 0, 0) m, by an event of this package or by a weld
constraint of MuJoCo.
"""

from __future__ import annotations

from functools import partial
from typing import Any

import mujoco
import numpy as np
from mujoco import rollout
from worker import Job, serve

import onorbit_rs as oo
from onorbit_rs.common.rotations import matrix_from_quaternion

MASSES, INERTIAS = (1000.0, 500.0), ([300.0, 400.0, 500.0], [120.0, 90.0, 150.0])  # kg, kg m²
POSITIONS = ([0.0, 0.0, 0.0], [2.5, 0.0, 0.0])  # m
VELOCITIES = (np.zeros(6), np.array([-0.05, 0.02, 0.01, 0.02, 0.05, -0.03]))  # m/s, rad/s
GRIPS = ([1.5, 0.0, 0.0], [-1.0, 0.0, 0.0])  # the common point in the axes of each craft, m
TIME_STEP, STEPS = 2e-3, 5000
STIFFER = "solref='0.004 1'"  # a fifth of the default time constant

XML = """<mujoco>
 <option timestep='{step!r}' gravity='0 0 0'/>
 <worldbody>{bodies}</worldbody>
 <equality><weld body1='craft0' body2='craft1' anchor='-1 0 0' {weld}/></equality>
</mujoco>"""
BODY = """<body name='craft{i}' pos='{pos}'><freejoint/>
 <inertial pos='0 0 0' mass='{mass!r}' diaginertia='{inertia}'/></body>"""


def words(numbers: Any) -> str:
    return " ".join(repr(float(x)) for x in numbers)


def errors(q: Any, v: Any) -> tuple[float, float]:
    """Returns the largest change of the total angular momentum, relative to a scale, and the largest gap, m.

    `q` (2, T, 7) and `v` (2, T, 6) are the states of both craft in the layout of this package. The scale is
    `Σ |r × m v + H|` at the start, with the angular momentum `H` of a craft about its centre of mass. The gap
    is the distance of the grip points.
    """
    totals, scale, points = np.zeros((q.shape[1], 3)), 0.0, []
    for craft in range(2):
        rot = matrix_from_quaternion(q[craft, :, 3:7])
        linear = MASSES[craft] * np.einsum("tij,tj->ti", rot, v[craft, :, :3])
        spin = np.einsum("tij,tj->ti", rot, np.array(INERTIAS[craft]) * v[craft, :, 3:])
        angular = np.cross(q[craft, :, :3], linear) + spin
        totals += angular
        scale += float(np.linalg.norm(angular[0]))
        points.append(q[craft, :, :3] + rot @ GRIPS[craft])
    lost = np.linalg.norm(totals - totals[0], axis=1).max() / scale
    return float(lost), float(np.linalg.norm(points[1] - points[0], axis=1).max())


def ours() -> Job:
    def system(i: int) -> oo.System:
        model = oo.Model.rigid_body(MASSES[i], np.diag(INERTIAS[i]))
        return oo.System("ab"[i], model, [*POSITIONS[i], 0.0, 0.0, 0.0, 1.0], VELOCITIES[i])

    world = oo.World([system(0), system(1)], events=[oo.Capture("grasp", "a/base", "b/base", at=0.0)])
    simulation = oo.Simulation(world, time_step=TIME_STEP)

    def run() -> Any:
        return simulation.run(STEPS * TIME_STEP)

    def accuracy() -> Any:
        trace = run()
        return [np.array([errors(*(np.array([getattr(trace[name], x) for name in "ab"]) for x in "qv"))])]

    return Job(STEPS, run, accuracy)


def theirs(weld: str) -> Job:
    """Returns the job of MuJoCo with the given XML attributes of the weld.

    The job uses ``mujoco.rollout``, which has no loop in Python.
    """
    bodies = "".join(
        BODY.format(i=i, pos=words(POSITIONS[i]), mass=MASSES[i], inertia=words(INERTIAS[i]))
        for i in range(2)
    )
    model = mujoco.MjModel.from_xml_string(XML.format(step=TIME_STEP, bodies=bodies, weld=weld))
    data, physics = mujoco.MjData(model), mujoco.mjtState.mjSTATE_FULLPHYSICS
    data.qvel[:] = np.concatenate(VELOCITIES)  # attitudes are the identity
    start = np.zeros((1, mujoco.mj_stateSize(model, physics)))
    mujoco.mj_getState(model, data, start[0], physics)
    states = np.zeros((1, STEPS, start.shape[1]))
    pool = rollout.Rollout(nthread=0)

    def run() -> None:
        pool.rollout(model, [data], start, nstep=STEPS, state=states)

    def accuracy() -> Any:
        run()
        rows = np.vstack([start, states[0]])[:, 1:]
        q, v = rows[:, :14].reshape(-1, 2, 7), rows[:, 14:26].reshape(-1, 2, 6)
        q = np.concatenate([q[..., :3], q[..., 4:7], q[..., 3:4]], axis=-1).swapaxes(0, 1)
        rot = matrix_from_quaternion(q[..., 3:7])
        linear = np.einsum("...ji,...j->...i", rot, v[..., :3].swapaxes(0, 1))
        return [np.array([errors(q, np.concatenate([linear, v[..., 3:].swapaxes(0, 1)], axis=-1))])]

    return Job(STEPS, run, accuracy)


if __name__ == "__main__":
    makers = {"ours": ours, "weld": partial(theirs, ""), "stiffer_weld": partial(theirs, STIFFER)}
    serve(
        f"mujoco {mujoco.__version__}", {name: make() for name, make in makers.items()}, time_step=TIME_STEP
    )
