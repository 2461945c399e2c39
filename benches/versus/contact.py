"""Scene of two craft in contact: four pads of one craft press on a plate of the other."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import robots
from robots import REACH, Array, Robot

import onorbit_rs as oo

PADS = [(0.4, y, z) for y in (-0.3, 0.3) for z in (-0.3, 0.3)]  # spheres on the base of the first craft, m
RADIUS = 0.05  # m
PLATE, PLATE_AT = (0.05, 0.5, 0.5), (-0.4, 0.0, 0.0)  # half edges and centre of the second craft's box, m
TIME_STEP = 1e-3
CLOSING = 0.02  # m/s
FINER = 64  # factor by which the steps of the converged solutions are shorter


class Pads:
    """Parameters of the pads: stiffness, N/m, and damping, N s/m, of each pad, and initial depth, m.

    ``steps`` is the number of steps of a run, during which all pads press on the plate.
    """

    def __init__(self, name: str, stiffness: float, damping: float, depth: float, steps: int) -> None:
        self.name, self.stiffness, self.damping = name, stiffness, damping
        self.depth, self.steps = depth, steps

    @property
    def duration(self) -> float:
        return self.steps * TIME_STEP


SOFT, HARD = Pads("soft", 1e3, 10.0, 1e-3, 250), Pads("hard", 3e5, 200.0, 5e-5, 15)


def start(model: oo.Model, pads: Pads) -> list[tuple[Array, Array]]:
    """Returns the initial configuration and velocity of each craft.

    Both bases rotate slowly, and the arm of the first craft moves.
    """
    states = []
    for craft, (x, speed) in enumerate([(0.0, 0.0), (0.9 - pads.depth, -CLOSING)]):
        q, v = model.neutral(), np.zeros(model.nv)
        q[0], q[7:] = x, np.tile(REACH, (model.nv - 6) // 7)
        v[0], v[3:6], v[6:] = speed, 2e-3 * np.array([1.0, -1.0, 2.0]) * (1 - 2 * craft), 0.01 * (1 - craft)
        states.append((q, v))
    return states


def write(folder: Path, robot: Robot) -> None:
    """Writes to `folder` both craft as URDF, the scene as MJCF, and its initial states and pad parameters."""
    words = robots.text
    spheres = "".join(collision(words(pad), f'<sphere radius="{RADIUS}"/>') for pad in map(list, PADS))
    edges = words([2 * half for half in PLATE])
    plate = collision(words(list(PLATE_AT)), f'<box size="{edges}"/>')
    (folder / "pads.urdf").write_text(robots.urdf(robot, spheres))
    (folder / "plate.urdf").write_text(robots.urdf(robot, plate))
    shape = 'contype="0" conaffinity="0" mass="0"'
    geoms = "".join(
        f'<geom name="pad{i}" type="sphere" size="{RADIUS}" pos="{words(list(pad))}" {shape}/>'
        for i, pad in enumerate(PADS)
    )
    box = f'<geom name="plate" type="box" size="{words(list(PLATE))}" pos="{words(list(PLATE_AT))}" {shape}/>'
    bodies = robots.mjcf_bodies(robot, "a_", geoms) + robots.mjcf_bodies(robot, "b_", box)
    pairs = "".join(f'<pair geom1="pad{i}" geom2="plate" condim="1"/>' for i in range(len(PADS)))
    option = f'<option timestep="{TIME_STEP!r}" gravity="0 0 0"/>'
    (folder / "contact.xml").write_text(
        f"<mujoco>{robots.ANGLES}{option}<worldbody>{bodies}</worldbody><contact>{pairs}</contact></mujoco>"
    )
    model = oo.Model.from_urdf(folder / "pads.urdf")
    for pads in (SOFT, HARD):
        states = [oo.layouts.to_mujoco(model, q, v) for q, v in start(model, pads)]
        numbers = [pads.stiffness, pads.damping, *(x for part in zip(*states, strict=True) for x in part)]
        np.concatenate([np.atleast_1d(x) for x in numbers]).tofile(folder / f"contact_{pads.name}.bin")


def collision(xyz: str, geometry: str) -> str:
    return f'<collision><origin xyz="{xyz}"/><geometry>{geometry}</geometry></collision>'


def simulation(folder: Path, pads: Pads, time_step: float = TIME_STEP) -> oo.Simulation:
    models = [oo.Model.from_urdf(folder / f"{name}.urdf") for name in ("pads", "plate")]
    states = start(models[0], pads)
    systems = [
        oo.System(name, model, *state) for name, model, state in zip("ab", models, states, strict=True)
    ]
    law = oo.SpringDashpot(pads.stiffness, pads.damping)
    touch = oo.Contact("a/body00", "b/body00", normal=law, name="touch", start_overlapping=True)
    return oo.Simulation(oo.World(systems, contacts=[touch]), time_step=time_step)


def ends(trace: Any) -> tuple[Array, Array]:
    """Returns the final configurations (2, nq) and velocities (2, nv) of both craft."""
    return tuple(np.array([getattr(trace[name], x)[-1] for name in "ab"]) for x in "qv")  # type: ignore[return-value]


def errors(model: oo.Model, pads: Pads, end: Array, converged: Array) -> dict[str, float]:
    """Returns the errors of a final state, compared with a converged solution, and the momentum lost.

    `end` and `converged` hold `q` and `v` of one craft after the other. `position_m` is the largest error of
    a coordinate of a base, m, and `energy` the relative error of the kinetic energy. `momentum_lost` is the
    change of the total momentum since the start, divided by the sum of the magnitudes of both craft; it is
    the larger value of the linear and the angular part.
    """
    begin = np.array([np.hstack(state) for state in start(model, pads)])
    first, last, exact = (totals(model, rows.reshape(2, -1)) for rows in (begin, end, converged))
    position = np.abs(end - converged).reshape(2, -1)[:, :3].max()
    lost = [
        np.linalg.norm((last[0] - first[0]).sum(axis=0)[part])
        / np.linalg.norm(first[0][:, part], axis=1).sum()
        for part in (slice(3), slice(3, 6))
    ]
    return {"position_m": float(position), "energy": abs(last[1] / exact[1] - 1), "momentum_lost": max(lost)}


def totals(model: oo.Model, rows: Array) -> tuple[Array, float]:
    """Returns the momentum of each craft about the origin of W, (2, 6), and the total kinetic energy, J."""
    q, v = (np.ascontiguousarray(part) for part in np.split(rows, [model.nq], axis=1))
    h = np.array(model.momentum(q, v))
    h[:, 3:] += np.cross(model.center_of_mass(q), h[:, :3])
    return h, float(np.sum(model.kinetic_energy(q, v)))
