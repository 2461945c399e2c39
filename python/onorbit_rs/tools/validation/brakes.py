"""Tests brakes of joints against closed forms of a wheel and, for random robots, Gauss's principle."""

from __future__ import annotations

from typing import Any

import numpy as np

import onorbit_rs as oo
from onorbit_rs.common.coordinates import BASE_NV
from onorbit_rs.tools.validation.capture import random_craft, random_pair, run
from onorbit_rs.tools.validation.case import Case, Gate, worst
from onorbit_rs.tools.validation.gauss import Craft, mass_matrix, project, relative_twist
from onorbit_rs.tools.validation.trees import Array

BASE, WHEEL = 2.0, 0.5
"""Moments of inertia of base and wheel about the axis of the wheel, kg m²."""
SPIN = 2.0
"""Initial rate of the wheel relative to the base, rad/s."""
SLIP = 0.9
"""Slip torque of the brake, N m."""
TORQUE = SLIP
"""Slip torque in the closed form, N m."""
SEEDS = range(3200, 3212)


def wheel() -> oo.Model:
    """Return a base with a wheel; the axis z of the wheel passes through both centres of mass."""
    builder = oo.ModelBuilder("craft", base="base", mass=20.0, inertia=np.diag([BASE, BASE, BASE]))
    builder.add_link(
        "wheel", parent="base", joint="spin", kind="continuous", axis=[0, 0, 1],
        mass=5.0, inertia=np.diag([WHEEL, WHEEL, WHEEL]),
    )  # fmt: skip
    return builder.build()


class _Torque:
    """Controller with a constant torque."""

    def __init__(self, torque: float) -> None:
        self.torque = torque

    def update(self, t: float, state: oo.State) -> list[float]:
        return [self.torque]


def wheel_system(
    spin: float, slip_torque: float = np.inf, torque: float | None = None
) -> tuple[oo.System, oo.System]:
    """Return the craft with the brake of its wheel, engaged if the wheel is at rest, and a distant body."""
    brake = oo.Brake("brake", "spin", slip_torque=slip_torque, engaged=spin == 0.0)
    q, v = np.zeros(8), np.zeros(7)
    q[6], v[6] = 1.0, spin
    controller = None if torque is None else _Torque(torque)
    chaser = oo.System("chaser", wheel(), q, v, actuators=[brake], controller=controller)
    far = [10.0, 0, 0, 0, 0, 0, 1.0]
    return chaser, oo.System("target", oo.Model.rigid_body(1.0, np.eye(3)), far, np.zeros(6))


def spinning_wheel(slip_torque: float = np.inf, **settings: Any) -> oo.WorldTrace:
    """Return a run of 2 s in which the brake of the spinning wheel is engaged at 0.5 s."""
    event = oo.Engage("stop", "chaser/brake", at=0.5)
    return run(wheel_system(SPIN, slip_torque), [event], 2.0, **{"time_step": 0.01} | settings)


def slowing() -> tuple[float, ...]:
    """Return the errors of rate, rad/s, angle, rad, energy, J, and momentum, N s and N m s, with a brake."""
    trace = spinning_wheel(slip_torque=SLIP)
    chaser, reduced = trace["chaser"], BASE * WHEEL / (BASE + WHEEL)
    stop = SPIN * reduced / TORQUE
    slowed = np.clip(chaser.time - 0.5, 0.0, stop)
    rate = SPIN - TORQUE / reduced * slowed
    angle = SPIN * (np.minimum(chaser.time, 0.5) + slowed) - 0.5 * TORQUE / reduced * slowed**2
    return (
        float(np.abs(chaser.v[:, 6] - rate).max()),
        float(np.abs(chaser.q[:, 7] - angle).max()),
        abs(float(chaser.dissipated[-1]) - 0.5 * reduced * SPIN**2),
        float(np.abs(trace.momentum - trace.momentum[0]).max()),
    )


def _held(craft: Craft, seed: int) -> tuple[Craft, list[int]]:
    """Return the robot with up to two random joints at rest, and the indices of these joints."""
    rng = np.random.default_rng(seed)
    count = min(2, craft.model.nv - BASE_NV)
    joints = sorted(int(joint) for joint in rng.permutation(craft.model.nv - BASE_NV)[:count])
    v = craft.v.copy()
    v[[BASE_NV + joint for joint in joints]] = 0.0
    return Craft(craft.model, craft.q, v, craft.frame), joints


def _brakes(craft: Craft, joints: list[int], *, engaged: bool) -> list[oo.Brake]:
    names = craft.model.joint_names
    return [oo.Brake(names[joint], names[joint], engaged=engaged) for joint in joints]


def rows(joints: list[int], nv: int) -> Array:
    """Return the constraint rows of joints that brakes hold, (joints, nv)."""
    held = np.zeros((len(joints), nv))
    held[np.arange(len(joints)), [BASE_NV + joint for joint in joints]] = 1.0
    return held


def capture_against_gauss(seed: int) -> tuple[float, float]:
    """Return the errors of a capture with rigid brakes against Gauss's principle with and without brakes.

    Both are errors of the velocities, relative to the largest rate. The second is large: it shows that the
    brakes change the result.
    """
    first, second = random_pair(seed)
    (first, held_a), (second, held_b) = _held(first, seed), _held(second, seed + 1)
    systems = [
        oo.System(name, craft.model, craft.q, craft.v, actuators=_brakes(craft, held, engaged=True))
        for name, craft, held in zip("ab", (first, second), (held_a, held_b), strict=True)
    ]
    event = oo.Capture("grasp", f"a/{first.frame}", f"b/{second.frame}", at=0.0)
    trace = run(systems, [event], 1e-3, time_step=1e-3)
    after = np.concatenate([trace[name].v[np.flatnonzero(trace[name].time == 0.0)[-1]] for name in "ab"])
    crafts, before = (first, second), np.concatenate([first.v, second.v])
    mass, twist = mass_matrix(crafts), relative_twist(crafts, 0, 1)
    shift = first.model.nv
    held = rows(held_a + [shift + joint for joint in held_b], len(before))
    expected = project(mass, np.vstack([twist, held]), before)[0]
    control = project(mass, twist, before)[0]
    size = np.abs(np.concatenate([before, expected])).max()
    return float(np.abs(after - expected).max() / size), float(np.abs(after - control).max() / size)


ENGAGE = {"velocity": 1e-12, "energy": 1e-12, "momentum": 1e-13, "impulse": 1e-12}
"""Quantities of a rigid engagement, and the largest relative error allowed in each."""


def engage_against_gauss(seed: int) -> tuple[float, ...]:
    """Return the relative errors when a rigid brake stops a moving joint while another one is held.

    The errors are those of the quantities of :data:`ENGAGE`, in the same order.
    """
    craft, (held, *_) = _held(random_craft(seed), seed)
    moving = next(j for j in range(craft.model.nv - BASE_NV) if craft.v[BASE_NV + j] != 0.0)
    actuators = [*_brakes(craft, [held], engaged=True), *_brakes(craft, [moving], engaged=False)]
    name = craft.model.joint_names[moving]
    systems = [
        oo.System("a", craft.model, craft.q, craft.v, actuators=actuators),
        oo.System("far", oo.Model.rigid_body(1.0, np.eye(3)), [1e3, 0, 0, 0, 0, 0, 1.0], np.zeros(6)),
    ]
    trace = run(systems, [oo.Engage("stop", f"a/{name}", at=0.0)], 1e-3, time_step=1e-3)
    after = trace["a"].v[np.flatnonzero(trace["a"].time == 0.0)[-1]]
    mass, held_rows = mass_matrix([craft]), rows([held, moving], len(craft.v))
    expected, impulse = project(mass, held_rows, craft.v)
    (record,) = trace.events
    lost = 0.5 * (craft.v @ mass @ craft.v - expected @ mass @ expected)
    size = np.linalg.norm(record.impulse)
    return (
        float(np.abs(after - expected).max() / np.abs(craft.v).max()),
        float(abs(record.energy_lost - lost) / (0.5 * craft.v @ mass @ craft.v)),
        float(np.max(record.momentum_error)),
        abs(float(size) / abs(impulse[-1]) - 1.0),
    )


def engaged() -> tuple[float, ...]:
    """Return the largest errors of rigid engagements of random robots, in the order of :data:`ENGAGE`."""
    return tuple(worst(engage_against_gauss(seed) for seed in SEEDS))


def captured() -> tuple[float]:
    """Return the largest relative error of the velocities after captures with engaged brakes."""
    return (float(worst(capture_against_gauss(seed)[0] for seed in SEEDS)),)


CASES = (
    Case(
        "brakes", "a brake that slips stops a wheel", "q̇ = q̇0 − T t/I, E = ½ I q̇0², 1/I = 1/I1 + 1/I2",
        (
            Gate("rate", 1e-12, "rad/s"), Gate("angle", 1e-12, "rad"), Gate("energy dissipated", 1e-12, "J"),
            Gate("momentum", 1e-13, "N s"),
        ), slowing,
    ),
    Case(
        "brakes", "12 random trees, a brake engaged in motion", "Gauss's principle with the rows of brakes",
        tuple(Gate(name, gate) for name, gate in ENGAGE.items()), engaged,
    ),
    Case(
        "brakes", "12 random pairs of trees, captured with engaged brakes",
        "Gauss's principle with the rows of brakes", (Gate("velocity", 1e-12),), captured,
    ),
)  # fmt: skip
