"""Tests closed loops and mimic joints against closed forms of planar linkages."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np

import onorbit_rs as oo
from onorbit_rs.common.coordinates import BASE_NV, JOINTS_Q, JOINTS_V
from onorbit_rs.tools.validation.capture import run
from onorbit_rs.tools.validation.case import Case, Gate, worst
from onorbit_rs.tools.validation.linkages import (
    BASE_INERTIA,
    BASE_MASS,
    OFFSET,
    Linkage,
    base,
    cranks_with_rod,
    four_bar_linkage,
    geared_wheels,
    slider_crank_linkage,
    two_fingers,
)  # fmt: skip
from onorbit_rs.tools.validation.trees import Array

CRANK, RATE = 1.0, 2.0
"""Initial angle of the crank, rad, and its rate, rad/s."""
TORQUE = 0.3
"""Torque on the crank, N m, with which accelerations are compared."""
STATES = ((1.0, 2.0), (2.5, -1.0), (4.0, 3.0), (5.5, 0.0))
"""Angles of the crank, rad, and its rates, rad/s, at which accelerations are compared."""


def simulate(model: oo.Model, q: Array, v: Array, duration: float, step: float = 1e-3) -> oo.Trace:
    """Return the trace of free motion."""
    return oo.Simulation(model, q, v, time_step=step, record_every=10).run(duration)


class _Efforts:
    """Controller with constant efforts."""

    def __init__(self, efforts: Sequence[float]) -> None:
        self.efforts = list(efforts)

    def update(self, t: float, state: oo.State) -> list[float]:
        return self.efforts


def along_the_run(linkage: Linkage, duration: float = 5.0) -> tuple[float, float, float]:
    """Return the errors of joint positions and rates at the simulated angle of the crank, and of its rate.

    Without momentum, the energy is `½ J(θ) θ̇²`, so `θ̇ = θ̇0 √(J(θ0)/J(θ))`. The last error is relative.
    """
    trace = simulate(linkage.model, *linkage.state(CRANK, RATE), duration)
    inertia = linkage.reduced(CRANK).inertia
    errors = []
    for q, v in zip(trace.q, trace.v, strict=True):
        crank, rate = float(q[JOINTS_Q][0]), float(v[JOINTS_V][0])
        position, slope, _ = linkage.joints(crank)
        off = q[JOINTS_Q] - position
        errors.append((
            np.abs(off - 2.0 * np.pi * np.round(off / (2.0 * np.pi))).max(),
            np.abs(v[JOINTS_V] - rate * slope).max(),
            abs(rate / (RATE * np.sqrt(inertia / linkage.reduced(crank).inertia)) - 1.0),
        ))  # fmt: skip
    return tuple(worst(errors))


def accelerations(linkage: Linkage) -> float:
    """Return the largest error of the joint accelerations, relative to those by Eksergian's equation."""
    errors = []
    for crank, rate in STATES:
        (q, v), tau = linkage.state(crank, rate), np.zeros(linkage.model.nv)
        tau[BASE_NV] = TORQUE
        _, slope, slope2 = linkage.joints(crank)
        expected = linkage.reduced(crank).acceleration(rate, TORQUE) * slope + rate**2 * slope2
        found = linkage.model.constrained_forward_dynamics(q, v, tau)[0][JOINTS_V]
        errors.append(np.abs(found - expected).max() / np.abs(expected).max())
    return float(worst(errors))


def linkages(*makers: Callable[[], Linkage]) -> tuple[float, ...]:
    """Return the largest errors of joint positions, joint rates, rate of the crank, and accelerations."""
    return tuple(worst((*along_the_run(one), accelerations(one)) for one in (make() for make in makers)))


SPIN, MASS, RADIUS = 1.5, 2.0, 0.6
"""Rate of a craft, rad/s, and the mass, kg, and distance from the axis, m, of one of two sliders on it."""


def spinning_sliders() -> tuple[float, float, float]:
    """Return the relative errors of a rod's tension `m ω² r` and its direction, and the loop's opening, m."""
    builder = base("sliders")
    for name, mass, x in (("near", 1.5 * MASS, -RADIUS / 1.5), ("far", MASS, RADIUS)):
        builder.add_link(
            name, parent="base", joint=f"{name}_slide", kind="prismatic", axis=[1, 0, 0], mass=mass,
            xyz=[x, 0, 0], inertia=0.1 * np.eye(3),
        )  # fmt: skip
    builder.close(oo.Loop("rod", "distance", "near", "far"))
    model = builder.build()
    trace = simulate(model, model.neutral(), np.array([0, 0, 0, 0, 0, SPIN, 0, 0.0]), 3.0)
    force, expected = trace.loops["rod"].force, MASS * SPIN**2 * RADIUS
    radial = np.array([np.cos(SPIN * trace.time), np.sin(SPIN * trace.time), 0.0 * trace.time]).T
    return (
        float(np.abs(np.linalg.norm(force, axis=1) / expected - 1.0).max()),
        float(np.abs(force / expected + radial).max()),
        float(trace.loops["rod"].opening.max()),
    )


FINGERS = (1.0, 1.5, 3.0)
"""Masses of two fingers and of the load between them, kg."""
SQUEEZE, PUSH = (12.0, -12.0), (12.0, -9.0)
"""Efforts of both fingers, N: balanced, and with a force that moves the load."""


def squeezed(efforts: tuple[float, float]) -> tuple[float, float]:
    """Return the errors of the force between load and second finger, N, and of the joint travel, m.

    The efforts `f` accelerate fingers and load by `a = Σf/Σm` in W; the force on the second finger, with the
    mass `m`, is `m a - f`. Relative to the base of mass `M`, they travel `½ (a + Σf/M) t²`.
    """
    model = two_fingers(FINGERS)
    trace = oo.Simulation(
        model, model.neutral(), np.zeros(model.nv), controller=_Efforts(efforts), time_step=1e-2
    ).run(1.0)
    absolute = sum(efforts) / sum(FINGERS)
    force = FINGERS[1] * absolute - efforts[1]
    travel = 0.5 * (absolute + sum(efforts) / BASE_MASS) * trace.time**2
    return (
        float(np.abs(trace.loops["grasp"].force - [0.0, force, 0.0]).max()),
        float(np.abs(trace.q[:, JOINTS_Q] - travel[:, None]).max()),
    )


def squeezed_load() -> tuple[float, float]:
    """Return the largest errors of :func:`squeezed` for a load at rest and for one that accelerates."""
    return tuple(worst(squeezed(efforts) for efforts in (SQUEEZE, PUSH)))


RATIO, WHEELS = -2.5, (0.2, 0.05)
"""Ratio of two geared wheels, and their moments of inertia, kg m²."""


def geared() -> tuple[float, float, float]:
    """Return the errors of the angles, rad, of a driven and a mimicking wheel, and of the momentum.

    `J = I1 + n² I2 - (I1 + n I2)²/(I + I1 + I2)` is the reduced inertia about the axis, with the inertias
    `I1` and `I2` of the wheels, their ratio `n`, and the inertia `I` of the base and the wheels' masses.
    """
    model = geared_wheels(RATIO, WHEELS)
    q = model.neutral()
    q[JOINTS_Q] = 0.0, OFFSET
    trace = oo.Simulation(
        model, q, np.zeros(model.nv), controller=_Efforts([TORQUE, 0.0]), time_step=1e-2
    ).run(2.0)  # fmt: skip
    # the second wheel, 1 kg, is 0.3 m beside the axis through the base and the first wheel
    beside = 1.0 * (BASE_MASS + 1.0) / (BASE_MASS + 2.0) * 0.3**2
    coupled = WHEELS[0] + RATIO * WHEELS[1]
    inertia = WHEELS[0] + RATIO**2 * WHEELS[1] - coupled**2 / (BASE_INERTIA[2] + beside + sum(WHEELS))
    turned = 0.5 * TORQUE / inertia * trace.time**2
    return (
        float(np.abs(trace.q[:, 7] - turned).max()),
        float(np.abs(trace.q[:, 8] - (RATIO * turned + OFFSET)).max()),
        float(np.abs(trace.momentum).max()),
    )


SLIP = 0.05
"""Slip torque of a brake on the crank, N m."""
BRAKE = SLIP


def braked(slip_torque: float, duration: float) -> tuple[Linkage, oo.WorldTrace]:
    """Return a four-bar linkage without momentum, and a run in which its crank's brake engages at once."""
    linkage = four_bar_linkage()
    brake = oo.Brake("brake", "crank_joint", slip_torque=slip_torque)
    system = oo.System("craft", linkage.model, *linkage.state(CRANK, RATE), actuators=[brake])
    bystander = oo.System("far", oo.Model.rigid_body(1.0, np.eye(3)), [1e3, 0, 0, 0, 0, 0, 1.0], np.zeros(6))
    event = oo.Engage("stop", "craft/brake", at=0.0)
    return linkage, run([system, bystander], [event], duration, time_step=1e-3)


def rigid_brake() -> tuple[float, float, float]:
    """Return the errors of energy lost, J, and impulse, N m s, of a rigid brake, and the speed afterwards.

    The speed is the largest component of the velocity, m/s or rad/s.

    The brake stops the whole linkage: the energy lost is `½ J θ̇²`, the impulse about the crank's axis `-J θ̇`.
    """
    linkage, trace = braked(np.inf, 0.1)
    inertia, (record,) = linkage.reduced(CRANK).inertia, trace.events
    return (
        abs(record.energy_lost - 0.5 * inertia * RATE**2),
        abs(float(record.impulse[5]) + inertia * RATE),
        float(np.abs(trace["craft"].v[1:]).max()),
    )


def slipping_brake() -> tuple[float, float]:
    """Return the errors of a slipping brake: the final angle of the crank, rad, and dissipated energy, J.

    The crank turns by `½ J θ̇²/T` until it stops.
    """
    linkage, trace = braked(BRAKE, 3.0)
    craft, energy = trace["craft"], 0.5 * linkage.reduced(CRANK).inertia * RATE**2
    return (
        abs(float(craft.q[-1, 7]) - CRANK - energy / SLIP),
        abs(float(craft.dissipated[-1]) - energy),
    )


LINKAGE = (
    Gate("joint positions", 1e-12, "rad or m"), Gate("joint rates", 1e-11, "rad/s or m/s"),
    Gate("rate of the crank", 1e-10), Gate("joint accelerations", 1e-12),
)  # fmt: skip
EKSERGIAN = "; J θ̈ + ½ J' θ̇² = τ"

CASES = (
    Case(
        "loops", "a four-bar linkage, 5 s, closed by a pin or a ball joint",
        "Norton, Design of Machinery: a e^(iθ) + b e^(iφ) = d + c e^(iψ)" + EKSERGIAN, LINKAGE,
        partial(linkages, four_bar_linkage, partial(four_bar_linkage, "spherical")),
    ),
    Case(
        "loops", "two cranks with a massless rod, 5 s", "as for a four-bar linkage", LINKAGE,
        partial(linkages, cranks_with_rod),
    ),
    Case(
        "loops", "a slider-crank, 5 s, closed at its pin or at its slide",
        "Norton, Design of Machinery: x = a cos θ + √(b² - a² sin² θ)" + EKSERGIAN, LINKAGE,
        partial(linkages, slider_crank_linkage, partial(slider_crank_linkage, "prismatic")),
    ),
    Case(
        "loops", "a rod holds two sliders on a spinning craft", "m ω² r",
        (Gate("tension", 1e-12), Gate("direction", 1e-12), Gate("opening", 1e-12, "m")), spinning_sliders,
    ),
    Case(
        "loops", "two fingers squeeze a load, at rest and moving", "a = Σf/Σm, force m a - f",
        (Gate("force", 1e-12, "N"), Gate("travel", 1e-12, "m")), squeezed_load,
    ),
    Case(
        "loops", "a mimic joint with the ratio -2.5", "J = I1 + n² I2 - (I1 + n I2)²/(I + I1 + I2)",
        (
            Gate("angle of the leader", 1e-12, "rad"), Gate("angle of the mimic joint", 1e-12, "rad"),
            Gate("momentum", 1e-13, "N s"),
        ), geared,
    ),
    Case(
        "loops", "a rigid brake on the crank of a four-bar linkage", "energy ½ J θ̇², impulse -J θ̇",
        (
            Gate("energy lost", 1e-12, "J"), Gate("impulse", 1e-12, "N m s"),
            Gate("rates afterwards", 1e-12, "rad/s"),
        ), rigid_brake,
    ),
    Case(
        "loops", "a slipping brake on the crank of a four-bar linkage", "angle ½ J θ̇²/T",
        (Gate("angle", 1e-11, "rad"), Gate("energy dissipated", 1e-12, "J")), slipping_brake,
    ),
)  # fmt: skip
