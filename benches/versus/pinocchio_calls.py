"""Worker process that times calls of Pinocchio from Python: ``pinocchio_calls.py FOLDER``."""

from __future__ import annotations

import sys
from pathlib import Path

import inputs
import numpy as np
import pinocchio as pin  # type: ignore[import-untyped]
from worker import Job, serve

folder = Path(sys.argv[1])
model = pin.buildModelFromUrdf(str(folder / "robot.urdf"), pin.JointModelFreeFlyer())
model.gravity.linear = np.zeros(3)
data = model.createData()
states = list(zip(*inputs.read(folder / "states.bin", model.nq, model.nv, model.nv), strict=True))


def calls() -> None:
    for q, v, x in states:
        pin.aba(model, data, q, v, x)


serve(
    f"pin {pin.__version__}",
    {"call": Job(len(states), calls, lambda: [np.array([pin.aba(model, data, *state) for state in states])])},
)
