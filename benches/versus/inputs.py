"""Writer of the input files: robot, states and tasks, with the same numbers for all programs."""

from __future__ import annotations

from pathlib import Path

import contact
import held_load
import numpy as np
import robots
from robots import REACH, Array

import onorbit_rs as oo

STATES = 256  # random states of the one-state kernels; batches repeat them
ARMS = 1024  # controlled arms in a rollout
SEED = 5

# humanoid_reach's controller and path (kp, kd, self-motion damping; displacement, height, duration)
KP, KD, SELF_MOTION = 100.0, 20.0, 2.0
DISPLACEMENT, HEIGHT, DURATION = (0.5, 0.0, 0.0), (0.0, 0.0, 0.4), 2.0
TIME_STEP = 1e-3
REACH_STEPS, PASSIVE_STEPS, ROLLOUT_STEPS, CONTROLLED_STEPS = 6000, 1000, 100, 200
PASSIVE_RUNS = 8  # number of random states that are run


def write(folder: Path, arms: int) -> None:
    """Writes to `folder` the robot with the given number of arms, its states and its tasks."""
    folder.mkdir(parents=True, exist_ok=True)
    robot = robots.humanoid(arms)
    (folder / "robot.urdf").write_text(robots.urdf(robot))
    (folder / "robot.txt").write_text(robots.table(robot))
    (folder / "robot.xml").write_text(robots.mjcf(robot))
    contact.write(folder, robot)
    if arms == 2:
        held_load.write(folder, robot, STATES)
    model = oo.Model.from_urdf(folder / "robot.urdf")
    assert model.joint_names == [f"joint{k}" for k in range(1, robot.nv - 5)], (
        "all programs must have the same joint order"
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
    """Returns random configurations, velocities and efforts: any attitude, all other numbers from -1 to 1."""
    q = rng.uniform(-1.0, 1.0, (count, model.nq))
    q[:, 3:7] /= np.linalg.norm(q[:, 3:7], axis=1, keepdims=True)
    return q, rng.uniform(-1.0, 1.0, (count, model.nv)), rng.uniform(-1.0, 1.0, (count, model.nv))


def reach(model: oo.Model) -> Array:
    """Returns the initial configuration of humanoid_reach; a second arm has the same joint positions."""
    q = model.neutral()
    q[7:] = np.tile(REACH, (model.nv - 6) // 7)
    return q


def arms_at_rest(model: oo.Model, rng: np.random.Generator) -> tuple[Array, Array, Array]:
    """Returns states of humanoids at rest: the first one as in `reach`, the others near it."""
    q = np.tile(reach(model), (ARMS, 1))
    q[1:, 7:] += rng.uniform(-0.02, 0.02, (ARMS - 1, model.nv - 6))
    return q, np.zeros((ARMS, model.nv)), np.zeros((ARMS, model.nv))


def read(file: Path, *widths: int) -> list[Array]:
    """Reads a binary file of rows and returns its columns as one array (N, width) for each of `widths`."""
    rows = np.fromfile(file).reshape(-1, sum(widths))
    return [np.ascontiguousarray(part) for part in np.split(rows, np.cumsum(widths)[:-1], axis=1)]
