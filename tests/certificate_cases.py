"""Cases of the certificate's campaign: motions that are exact or resolved, and motions made wrong."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import numpy as np

import onorbit_rs as oo

OFF = 1e-2
"""A run is wrong where a joint or the attitude is off by more, rad,"""
SHARE = 1e-3
"""and by more than this share of how far its fastest rate takes it."""
CHAOS = 10.0
"""A motion is chaotic where a small difference of rates ends this many times as far as they take it."""

Rng = np.random.Generator


@dataclass(frozen=True)
class Run:
    """How to run a case; ``is_wrong`` says whether it came out wrong, None where it is so by construction."""

    model: oo.Model
    q: Any
    v: Any
    time_step: float
    duration: float
    settings: dict[str, Any]
    is_wrong: Callable[[], bool] | None = None

    def start(self) -> oo.Simulation:
        """The simulation."""
        return oo.Simulation(self.model, self.q, self.v, time_step=self.time_step, **self.settings)

    def rows(self, finer: int = 1, moved: float = 0.0, phase: float = 0.0) -> oo.Trace:
        """The run with steps that are ``finer``, the start's rates moved by a share, each another way.

        All of them moved alike would only be another clock.
        """
        v = self.v + moved * np.abs(self.v).max() * np.cos(2.0 * np.arange(len(self.v)) + phase)
        run = replace(self, time_step=self.time_step / finer, v=v)
        return run.start().run(self.duration)

    def __str__(self) -> str:
        rates = ", ".join(f"{rate:.3g}" for rate in self.v)
        return f"{self.model.nv - 6} joints, v = [{rates}], {self.duration:g} s at {self.time_step:g} s"


def power(rng: Rng, low: float, high: float) -> float:
    """Ten to a power between the two."""
    return float(10.0 ** rng.uniform(low, high))


def attitude(rng: Rng) -> Any:
    """A random unit quaternion."""
    quaternion = rng.normal(size=4)
    return quaternion / np.linalg.norm(quaternion)


def body(rng: Rng) -> tuple[oo.Model, Any]:
    """A rigid body of 1 g to 1000 t and a radius of gyration of 1 cm to 100 m, and its principal moments."""
    mass, size = power(rng, -3, 6), power(rng, -2, 2)
    moments = np.sort(rng.uniform(1.0, 1.9, 3)) * mass * size**2
    moments = np.full(3, moments[0]) if rng.random() < 0.3 else moments
    return oo.Model.rigid_body(mass, np.diag(moments)), moments


def sparse(rng: Rng) -> dict[str, Any]:
    """Every step a row, or not."""
    return {"record_every": int(rng.choice([1, 1, 7, 100]))}


def spin(rng: Rng, most_rows: int) -> Run:
    """A uniform spin about a stable principal axis, or any axis of a sphere."""
    model, moments = body(rng)
    rate, rows = power(rng, -5, 0.5), int(power(rng, 2, np.log10(most_rows)))
    axis = np.eye(3)[rng.choice([0, 2])] if moments[0] < moments[2] else rng.normal(size=3)
    v = np.concatenate([np.zeros(3), rate * axis / np.linalg.norm(axis)])
    step = min(power(rng, -4, 1), 0.3 / rate)
    return Run(model, np.concatenate([np.zeros(3), attitude(rng)]), v, step, rows * step, sparse(rng))


def straight(rng: Rng, most_rows: int) -> Run:
    """A body that flies straight on, at up to a kilometre per second."""
    model, _ = body(rng)
    step, rows = power(rng, -4, 1), int(power(rng, 2, np.log10(most_rows)))
    v = np.concatenate([rng.normal(size=3) * power(rng, -6, 3), np.zeros(3)])
    q = np.concatenate([rng.normal(size=3) * power(rng, -2, 3), attitude(rng)])
    return Run(model, q, v, step, rows * step, sparse(rng))


@cache
def station() -> oo.Model:
    """The bundled robot that is fastest to step."""
    return oo.robots.load("station_arm")


def held(rng: Rng, most_rows: int) -> Run:
    """A robot whose joints are held, in empty space or under the gravity gradient, at rest or turning."""
    model = station()
    q = model.neutral()
    q[3:7], q[7:] = attitude(rng), rng.uniform(-1.0, 1.0, model.nq - 7)
    v = np.zeros(model.nv)
    v[3:6] = rng.normal(size=3) * (power(rng, -5, -2) if rng.random() < 0.5 else 0.0)
    hold = oo.Control(oo.JointComputedTorque(kp=25.0, kd=10.0), reference=oo.JointHold(q[7:]))
    step, rows = power(rng, -3, -1.5), int(power(rng, 2, np.log10(most_rows)))
    surroundings = rng.choice([0, 1])
    around = {"orbit": circular(rng), "environment": [oo.GravityGradient()]} if surroundings else {}
    return Run(model, q, v, step, rows * step, sparse(rng) | around | {"controller": [hold]})


def circular(rng: Rng, eccentricity: float = 0.0) -> oo.Kepler:
    """A low orbit."""
    return oo.Kepler(
        semi_major_axis=rng.uniform(6.7e6, 9e6), eccentricity=eccentricity, inclination=rng.uniform(0, np.pi)
    )


def kepler(rng: Rng, most_rows: int) -> Run:
    """A body on its orbit or some metres beside it, which turns evenly about a principal axis."""
    model, moments = body(rng)
    axis = np.eye(3)[rng.choice([0, 2])] if moments[0] < moments[2] else rng.normal(size=3)
    v = np.concatenate([np.zeros(3), 1e-3 * axis / np.linalg.norm(axis)])
    q = np.concatenate([rng.normal(size=3) * rng.choice([0.0, 10.0]), attitude(rng)])
    step, rows = power(rng, -2, 1), int(power(rng, 2, np.log10(most_rows)))
    orbit = circular(rng, rng.uniform(0.0, 0.02))
    return Run(model, q, v, step, min(rows * step, 20_000.0), sparse(rng) | {"orbit": orbit})


EXACT: dict[str, Callable[[Rng, int], Run]] = {
    "spins": spin, "straight flights": straight, "held robots": held, "Kepler": kepler,
}  # fmt: skip


def chain(rng: Rng, base: float, link: float) -> oo.Model:
    """A base and one to three links of about the given masses, kg."""
    builder = oo.ModelBuilder(
        "chain", base="base", mass=base, inertia=np.diag(base * rng.uniform(0.1, 0.15, 3))
    )
    parent = "base"
    for k in range(rng.integers(1, 4)):
        mass, length = link * rng.uniform(0.5, 2.0), rng.uniform(0.1, 0.5)
        axis = rng.normal(size=3)
        builder.add_link(
            f"link{k}", parent=parent, joint=f"joint{k}", kind="continuous", axis=axis / np.linalg.norm(axis),
            xyz=rng.uniform(-0.4, 0.4, 3), mass=mass, com=rng.normal(size=3) * 0.3 * length,
            inertia=np.diag(mass * length**2 * rng.uniform(0.1, 0.15, 3)),
        )  # fmt: skip
        parent = f"link{k}"
    return builder.build()


def differs(run: Run) -> bool:
    """Whether a run is wrong, and not because its motion is chaotic."""
    fine = run.rows(finer=8)
    travel = np.abs(fine.v[:, 3:]).max(axis=0) * run.duration

    def off(other: oo.Trace) -> Any:
        return np.abs(run.model.difference(other.q[-1], fine.q[-1])[3:])

    if not (off(run.rows()) > np.maximum(OFF, SHARE * travel)).any():
        return False
    moved = 1e-9
    # in two ways: one alone may lie where even a chaotic motion does not part
    parted = max(off(run.rows(finer=8, moved=moved, phase=phase)).max() for phase in (0.0, 0.5 * np.pi))
    return bool(parted < CHAOS * moved * travel.max())


def tumbling(rng: Rng, model: oo.Model) -> Run:
    """A free robot at a step too long for some of its motions."""
    q, v = model.neutral(), np.zeros(model.nv)
    q[3:7], q[7:] = attitude(rng), rng.uniform(-np.pi, np.pi, model.nq - 7)
    v[3:6], v[6:] = (
        rng.normal(size=3) * power(rng, -2, 0.3),
        rng.normal(size=model.nv - 6) * power(rng, -0.5, 1),
    )
    step = rng.uniform(0.02, 0.5) / max(float(np.abs(v).sum()), 0.5)
    run = Run(
        model, q, v, step, step * int(rng.integers(50, 2000)), {"record_every": int(rng.choice([1, 10]))}
    )
    return replace(run, is_wrong=lambda: differs(run))


def long_step(rng: Rng) -> Run:
    """Links as heavy as robots' are, at a step too long."""
    return tumbling(rng, chain(rng, base=10.0, link=power(rng, 0, 1)))


def light_link(rng: Rng) -> Run:
    """Links that the balances of the whole robot do not see."""
    return tumbling(rng, chain(rng, base=100.0, link=power(rng, -5, -1)))


class Forgetful:
    """A plant that books a wrench on the base and does not apply it, or applies it and does not book it."""

    def __init__(self, model: oo.Model, force: Any, *, applies: bool) -> None:
        self.model, self.force, self.applies = model, force, applies

    def step(self, start: float, end: float, q: Any, v: Any, *_: Any) -> Any:
        """A step of the engine itself, whose momentum is right for what it applied."""
        effects = [oo.BodyWrench("base", force=self.force)] if self.applies else []
        h = end - start
        own = oo.Simulation(self.model, q, v, environment=effects, time_step=max(h, 1e-3)).run(max(h, 1e-3))
        moved = own.impulse[-1].copy()
        moved[:3] += 0.0 if self.applies else h * self.force
        moved[:3] *= 0.0 if self.applies else 1.0
        return own.q[-1], own.v[-1], own.acceleration[0], moved, float(own.work[-1]), 0.0


def left_out(rng: Rng) -> Run:
    """A wrench that is booked and not applied, or applied and not booked."""
    model = chain(rng, base=10.0, link=power(rng, -2, 1))
    run = tumbling(rng, model)
    plant = Forgetful(model, rng.normal(size=3) * power(rng, -4, 0), applies=bool(rng.integers(2)))
    step = 0.01 / max(float(np.abs(run.v).sum()), 0.5)
    return replace(run, time_step=step, duration=20 * step, settings={"plant": plant}, is_wrong=None)


WRONG: dict[str, Callable[[Rng], Run]] = {
    "steps too long": long_step, "light links": light_link, "wrenches left out": left_out,
}  # fmt: skip
