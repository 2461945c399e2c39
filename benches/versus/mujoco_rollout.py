"""Worker process that times the rollouts of MuJoCo's Python package: ``mujoco_rollout.py FOLDER``."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Any

import inputs
import mujoco
import numpy as np
from mujoco import rollout
from worker import Job, serve

import onorbit_rs as oo

folder = Path(sys.argv[1])
ours = oo.Model.from_urdf(folder / "robot.urdf")
model = mujoco.MjModel.from_xml_path(str(folder / "robot.xml"))
off = [
    "CONTACT",
    "CONSTRAINT",
    "EQUALITY",
    "LIMIT",
    "FRICTIONLOSS",
    "GRAVITY",
    "SPRING",
    "DAMPER",
    "ACTUATION",
]
for name in [*off, "WARMSTART", "SENSOR", "EULERDAMP", "AUTORESET", "ISLAND"]:
    model.opt.disableflags |= int(getattr(mujoco.mjtDisableBit, f"mjDSBL_{name}"))
qpos, qvel = inputs.read(folder / "mujoco.bin", model.nq, model.nv)
PHYSICS = mujoco.mjtState.mjSTATE_FULLPHYSICS
width = mujoco.mj_stateSize(model, PHYSICS)
initial = np.zeros((len(qpos), width))
data = mujoco.MjData(model)
for row, position, velocity in zip(initial, qpos, qvel, strict=True):
    data.qpos[:], data.qvel[:] = position, velocity
    mujoco.mj_getState(model, data, row, PHYSICS)
state = np.zeros((len(qpos), inputs.ROLLOUT_STEPS, width))


def job(threads: int) -> Job:
    pool = rollout.Rollout(nthread=threads if threads > 1 else 0)
    datas = [mujoco.MjData(model) for _ in range(threads)]

    def run() -> None:
        pool.rollout(model, datas, initial, nstep=inputs.ROLLOUT_STEPS, state=state)

    def ends() -> Any:
        run()
        last = state[:, -1, 1:]  # the first column is time
        return oo.layouts.from_mujoco(ours, last[:, : model.nq], last[:, model.nq : model.nq + model.nv])

    return Job(len(qpos) * inputs.ROLLOUT_STEPS, run, ends, threads)


serve(f"mujoco {mujoco.__version__}", {"rollout": job(1), "rollout_threads": job(os.cpu_count() or 1)})
