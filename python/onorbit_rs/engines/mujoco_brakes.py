"""Engaged brakes of joints in a MuJoCo model."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.common.coordinates import JOINTS_Q
from onorbit_rs.engines.mujoco_common import harden

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from types import ModuleType

    from numpy.typing import NDArray

    from onorbit_rs.engines.mujoco_share import Share

    Floats = NDArray[np.float64]
    Engaged = tuple[int, int, float]
    """Index of the system, index of its joint, and slip torque, N m or N, of an engaged brake."""


def add_locks(mujoco: ModuleType, spec: Any, joints: Iterable[str], time_step: float) -> None:
    """Add an inactive equality for each joint, which holds the joint at a position while it is active."""
    for name in joints:
        lock = spec.add_equality()
        lock.type, lock.objtype = mujoco.mjtEq.mjEQ_JOINT, mujoco.mjtObj.mjOBJ_JOINT
        lock.name1, lock.active = name, False
        harden(lock, 2.0 * time_step)


class Brakes:
    """Brakes of the joints of a compiled MuJoCo model.

    A brake with a finite slip torque is Coulomb friction of that torque, added to the friction of the joint.
    A brake with an infinite slip torque activates the lock of the joint at its position at the start of the
    step, because the engine keeps no state between steps.
    """

    def __init__(self, model: Any, parts: Sequence[Share], first_lock: int) -> None:
        """Find the locks, which are the equalities from ``first_lock`` on, and the friction of the joints."""
        self._model, self._parts, self._first = model, parts, first_lock
        self._friction = np.array(model.dof_frictionloss)
        counts = [len(part.dofs) for part in parts]
        self._offsets = np.concatenate([[0], np.cumsum(counts)])

    def engage(self, data: Any, brakes: Sequence[Engaged], qpos: Floats) -> None:
        """Engage these brakes, and no others, in a step that starts at MuJoCo's configuration ``qpos``."""
        self._model.dof_frictionloss[:] = self._friction
        data.eq_active[self._first : self._first + self._offsets[-1]] = 0
        for system, joint, slip_torque in brakes:
            part = self._parts[system]
            if math.isfinite(slip_torque):
                self._model.dof_frictionloss[part.dofs[joint]] += slip_torque
                continue
            lock = self._first + self._offsets[system] + joint
            self._model.eq_data[lock, :5] = [qpos[part.q_columns[JOINTS_Q][joint]], 0.0, 0.0, 0.0, 0.0]
            data.eq_active[lock] = 1
