"""The files that contestants start from: robot, states and task, the same numbers for all."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import robots
from robots import REACH, Array

import onorbit_rs as oo

STATES = 256  # random states of the one-state kernels; batches repeat them
ARMS = 1024  # arms under control side by side
SEED = 5

# humanoid_reach's controller and path (kp, kd, self-motion damping; displacement, height, duration)
KP, KD, SELF_MOTION = 100.0, 20.0, 2.0
DISPLACEMENT, HEIGHT, DURATION = (0.5, 0.0, 0.0), (0.0, 0.0, 0.4), 2.0
TIME_STEP = 1e-3
REACH_STEPS, PASSIVE_STEPS, ROLLOUT_STEPS, CONTROLLED_STEPS = 6000, 1000, 100, 200
PASSIVE_RUNS = 8  # of the random states


def write(folder: Path, arms: int) -> None:
    """Robot, states and tasks for one number of arms into `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    robot = robots.humanoid(arms)
    (folder / "robot.urdf").write_text(robots.urdf(robot))
    (folder / "robot.txt").write_text(robots.table(robot))
    (folder / "robot.xml").write_text(robots.mjcf(robot))
    model = oo.Model.from_urdf(folder / "robot.urdf")
    assert model.joint_names == [f"joint{k}" for k in range(1, robot.nv - 5)], (
        "rows must mean the same to all"
    )
    rng = np.random.default_rng(SEED)
    q, v, x = random_states(model, rng, STATES)
    np.hstack([q, v, x]).tofile(folder / "states.bin")
    np.hstack(oo.layouts.to_mujoco(model, q, v)).tofile(folder / "mujoco.bin")
    arms_file = np.hstack(arms_at_rest(model, rng))
    arms_file.tofile(folder / "arms.bin")
    arms_file[:1].tofile(folder / "arm.bin")
    start = model.frame_pose(reach(model), "tool")
    for name, steps in (("reach", REACH_STEPS), ("controlled", CONTROLLED_STEPS)):
        numbers = [KP, KD, SELF_MOTION, TIME_STEP, steps, DURATION, *start[:3, :3].ravel(), *start[:3, 3]]
        written = " ".join(
            repr(float(x)) if x != steps else str(steps) for x in [*numbers, *DISPLACEMENT, *HEIGHT]
        )
        (folder / f"{name}.txt").write_text(written)


def random_states(model: oo.Model, rng: np.random.Generator, count: int) -> tuple[Array, Array, Array]:
    """Everything between -1 and 1, attitudes anywhere."""
    q = rng.uniform(-1.0, 1.0, (count, model.nq))
    q[:, 3:7] /= np.linalg.norm(q[:, 3:7], axis=1, keepdims=True)
    return q, rng.uniform(-1.0, 1.0, (count, model.nv)), rng.uniform(-1.0, 1.0, (count, model.nv))


def reach(model: oo.Model) -> Array:
    """Where humanoid_reach starts; a second arm likewise."""
    q = model.neutral()
    q[7:] = np.tile(REACH, (model.nv - 6) // 7)
    return q


def arms_at_rest(model: oo.Model, rng: np.random.Generator) -> tuple[Array, Array, Array]:
    """Humanoids at rest near there, the first one exactly."""
    q = np.tile(reach(model), (ARMS, 1))
    q[1:, 7:] += rng.uniform(-0.02, 0.02, (ARMS - 1, model.nv - 6))
    return q, np.zeros((ARMS, model.nv)), np.zeros((ARMS, model.nv))


def read(file: Path, *widths: int) -> list[Array]:
    """Columns of a file of rows."""
    rows = np.fromfile(file).reshape(-1, sum(widths))
    return [np.ascontiguousarray(part) for part in np.split(rows, np.cumsum(widths)[:-1], axis=1)]
