"""Cases of the certificate campaign: exact or well-resolved motions, and faulty motions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import numpy as np

import onorbit_rs as oo

OFF = 1e-2
"""Error of a joint or of the attitude, rad, that a faulty run exceeds."""
FRACTION = 1e-3
"""Part of the distance travelled at the fastest rate that the error of a faulty run exceeds."""
CHAOS = 10.0
"""A motion is chaotic if a small difference of rates grows by this factor beyond linear growth."""

Rng = np.random.Generator


@dataclass(frozen=True)
class Run:
    """Settings of a case.

    ``is_wrong`` returns true if the run is faulty; it is None if this is known from the kind of the case.
    """

    model: oo.Model
    q: Any
    v: Any
    time_step: float
    duration: float
    settings: dict[str, Any]
    is_wrong: Callable[[], bool] | None = None

    def start(self) -> oo.Simulation:
        """Returns the simulation."""
        return oo.Simulation(self.model, self.q, self.v, time_step=self.time_step, **self.settings)

    def rows(self, finer: int = 1, moved: float = 0.0, phase: float = 0.0) -> oo.Trace:
        """Returns the trace of a run with shorter steps and changed initial rates.

        The step is divided by ``finer``. ``moved`` is the largest change of a rate relative to the largest
        rate, and ``phase``, rad, varies the changes. A common factor on all rates would only rescale time.
        """
        v = self.v + moved * np.abs(self.v).max() * np.cos(2.0 * np.arange(len(self.v)) + phase)
        run = replace(self, time_step=self.time_step / finer, v=v)
        return run.start().run(self.duration)

    def __str__(self) -> str:
        rates = ", ".join(f"{rate:.3g}" for rate in self.v)
        return f"{self.model.nv - 6} joints, v = [{rates}], {self.duration:g} s at {self.time_step:g} s"


def power(rng: Rng, low: float, high: float) -> float:
    """Returns ten to a random power between the two."""
    return float(10.0 ** rng.uniform(low, high))


def attitude(rng: Rng) -> Any:
    """Returns a random unit quaternion."""
    quaternion = rng.normal(size=4)
    return quaternion / np.linalg.norm(quaternion)


def body(rng: Rng) -> tuple[oo.Model, Any]:
    """Returns a body (1 g to 1000 t, radius of gyration 1 cm to 100 m) and its principal moments."""
    mass, size = power(rng, -3, 6), power(rng, -2, 2)
    moments = np.sort(rng.uniform(1.0, 1.9, 3)) * mass * size**2
    moments = np.full(3, moments[0]) if rng.random() < 0.3 else moments
    return oo.Model.rigid_body(mass, np.diag(moments)), moments


def sparse(rng: Rng) -> dict[str, Any]:
    """Returns a random number of steps between recorded rows, as a setting of a run."""
    return {"record_every": int(rng.choice([1, 1, 7, 100]))}


def spin(rng: Rng, most_rows: int) -> Run:
    """Returns a uniform spin about a stable principal axis, or about any axis of a sphere."""
    model, moments = body(rng)
    rate, rows = power(rng, -5, 0.5), int(power(rng, 2, np.log10(most_rows)))
    axis = np.eye(3)[rng.choice([0, 2])] if moments[0] < moments[2] else rng.normal(size=3)
    v = np.concatenate([np.zeros(3), rate * axis / np.linalg.norm(axis)])
    step = min(power(rng, -4, 1), 0.3 / rate)
    return Run(model, np.concatenate([np.zeros(3), attitude(rng)]), v, step, rows * step, sparse(rng))


def straight(rng: Rng, most_rows: int) -> Run:
    """Returns a body in uniform translation at up to 1 km/s."""
    model, _ = body(rng)
    step, rows = power(rng, -4, 1), int(power(rng, 2, np.log10(most_rows)))
    v = np.concatenate([rng.normal(size=3) * power(rng, -6, 3), np.zeros(3)])
    q = np.concatenate([rng.normal(size=3) * power(rng, -2, 3), attitude(rng)])
    return Run(model, q, v, step, rows * step, sparse(rng))


@cache
def station() -> oo.Model:
    """Returns the bundled robot with the lowest cost per step."""
    return oo.robots.load("station_arm")


def held(rng: Rng, most_rows: int) -> Run:
    """Returns a robot with locked joints, with or without gravity gradient, at rest or rotating."""
    model = station()
    q = model.neutral()
    q[3:7], q[7:] = attitude(rng), rng.uniform(-1.0, 1.0, model.nq - 7)
    v = np.zeros(model.nv)
    v[3:6] = rng.normal(size=3) * (power(rng, -5, -2) if rng.random() < 0.5 else 0.0)
    hold = oo.Control(oo.JointComputedTorque(kp=25.0, kd=10.0), reference=oo.JointHold(q[7:]))
    step, rows = power(rng, -3, -1.5), int(power(rng, 2, np.log10(most_rows)))
    has_environment = rng.choice([0, 1])
    around = {"orbit": circular(rng), "environment": [oo.GravityGradient()]} if has_environment else {}
    return Run(model, q, v, step, rows * step, sparse(rng) | around | {"controller": [hold]})


def circular(rng: Rng, eccentricity: float = 0.0) -> oo.Kepler:
    """Returns a random low orbit, which is circular by default."""
    return oo.Kepler(
        semi_major_axis=rng.uniform(6.7e6, 9e6), eccentricity=eccentricity, inclination=rng.uniform(0, np.pi)
    )


def kepler(rng: Rng, most_rows: int) -> Run:
    """Returns a body within metres of its orbit that rotates uniformly about a principal axis."""
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
    """Returns a base with one to three links of roughly the given masses, kg."""
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
    """Returns true if a run is faulty and its motion is not chaotic."""
    fine = run.rows(finer=8)
    travel = np.abs(fine.v[:, 3:]).max(axis=0) * run.duration

    def off(other: oo.Trace) -> Any:
        return np.abs(run.model.difference(other.q[-1], fine.q[-1])[3:])

    if not (off(run.rows()) > np.maximum(OFF, FRACTION * travel)).any():
        return False
    moved = 1e-9
    # two perturbations, because a chaotic motion may be insensitive to one of them
    parted = max(off(run.rows(finer=8, moved=moved, phase=phase)).max() for phase in (0.0, 0.5 * np.pi))
    return bool(parted < CHAOS * moved * travel.max())


def tumbling(rng: Rng, model: oo.Model) -> Run:
    """Returns a free-floating robot with a step that is too long for some of its motions."""
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
    """Returns a robot with links of typical mass and a step that is too long."""
    return tumbling(rng, chain(rng, base=10.0, link=power(rng, 0, 1)))


def light_link(rng: Rng) -> Run:
    """Returns a robot whose links are too light for the balances of the whole robot."""
    return tumbling(rng, chain(rng, base=100.0, link=power(rng, -5, -1)))


class InconsistentEngine:
    """Engine that reports a wrench on the base without applying it, or applies it without reporting it."""

    def __init__(self, model: oo.Model, force: Any, *, applies: bool) -> None:
        self.model, self.force, self.applies = model, force, applies

    def step(self, start: float, end: float, q: Any, v: Any, *_: Any) -> Any:
        """Returns the state after a step under the applied wrench, and an impulse that contradicts it."""
        effects = [oo.BodyWrench("base", force=self.force)] if self.applies else []
        h = end - start
        own = oo.Simulation(self.model, q, v, environment=effects, time_step=max(h, 1e-3)).run(max(h, 1e-3))
        moved = own.impulse[-1].copy()
        moved[:3] += 0.0 if self.applies else h * self.force
        moved[:3] *= 0.0 if self.applies else 1.0
        return own.q[-1], own.v[-1], own.acceleration[0], moved, float(own.work[-1]), 0.0


def omitted_wrench(rng: Rng) -> Run:
    """Returns a case with a wrench that is recorded but not applied, or applied but not recorded."""
    model = chain(rng, base=10.0, link=power(rng, -2, 1))
    run = tumbling(rng, model)
    engine = InconsistentEngine(model, rng.normal(size=3) * power(rng, -4, 0), applies=bool(rng.integers(2)))
    step = 0.01 / max(float(np.abs(run.v).sum()), 0.5)
    return replace(run, time_step=step, duration=20 * step, settings={"engine": engine}, is_wrong=None)


WRONG: dict[str, Callable[[Rng], Run]] = {
    "steps too long": long_step, "light links": light_link, "wrenches omitted": omitted_wrench,
}  # fmt: skip
