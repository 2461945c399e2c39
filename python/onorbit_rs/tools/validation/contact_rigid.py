"""Tests rigid impacts and lasting contacts: closed forms, energy, and Painlevé's case."""

from __future__ import annotations

import itertools

import numpy as np

import onorbit_rs as oo
from onorbit_rs.common.rotations import matrix_from_quaternion
from onorbit_rs.exceptions import SimulationError
from onorbit_rs.tools.validation.case import Case, Gate, worst
from onorbit_rs.tools.validation.contact_bodies import RADIUS, at, body, floor, solid_sphere
from onorbit_rs.tools.validation.trees import Array

MU, DOWN = 0.3, 0.2  # coefficient of friction, and speed towards the floor, m/s
RESTITUTIONS = (0.0, 0.5, 1.0)
STICKS, SLIPS = 0.9, 2.0  # tangential speed relative to that at which the sphere begins to slip

LAW = oo.ImpactLaw  # used by the simulations
EDGES = (0.4, 0.6, 0.2)  # of a box, m
ROUGH = 0.8  # coefficient of friction of the boxes
TIP, LENGTH = 1e-3, 1.0  # radius of the tip of the rod, and its length, m
TANGENT = 2.0  # of the angle of the rod
HEIGHT = 0.1  # from which the ball falls, m


def _run(world: oo.World, lasts: float, time_step: float = 0.01) -> oo.WorldTrace:
    trace = oo.Simulation(world, time_step=time_step).run(lasts)
    assert isinstance(trace, oo.WorldTrace)
    return trace


def _on_floor(thing: oo.System, law: oo.ImpactLaw, environment: tuple[oo.BodyWrench, ...] = ()) -> oo.World:
    contact = oo.Contact("floor/*", f"{thing.name}/*", normal=law, name="touch")
    return oo.World([floor(), thing], contacts=[contact], environment=environment)


def _sphere(share: float, restitution: float) -> tuple[float, float, float]:
    """Return the speeds, m/s, of a sphere after an impact: along the floor, of its surface, and upwards.

    ``share`` is the speed along the floor before the impact, as a fraction of the largest one for which the
    sphere sticks.
    """
    along = share * 3.5 * MU * (1.0 + restitution) * DOWN
    ball = at("ball", solid_sphere(), [0.0, 0.0, RADIUS + 0.01], [along, 0.0, -DOWN, 0.0, 0.0, 0.0])
    trace = _run(_on_floor(ball, LAW(restitution, MU)), 0.1)["ball"]
    along, _, up = trace.momentum[-1, :3]  # the mass is 1 kg
    return float(along), float(trace.v[-1, 4] * RADIUS), float(up)


def oblique() -> list[float]:
    """Return the largest errors of the velocities of spheres that stick and of spheres that slip, m/s."""
    errors = []
    for share in (STICKS, SLIPS):
        found = []
        for e in RESTITUTIONS:
            along = share * 3.5 * 0.3 * (1.0 + e) * 0.2
            push = 0.3 * (1.0 + e) * 0.2
            ends = (along - push, 2.5 * push) if share > 1.0 else (along * 5.0 / 7.0,) * 2
            found += [abs(x - y) for x, y in zip(_sphere(share, e), (*ends, e * 0.2), strict=True)]
        errors.append(float(worst(found)))
    return errors


def _row(gap: float) -> Array:
    """Return the speeds of three balls in a row after an elastic impact of the first, relative to its speed.

    The second and the third ball are ``gap``, m, apart.
    """
    places = (0.0, 2.0 * RADIUS + 0.01, 4.0 * RADIUS + 0.01 + gap)
    balls = [
        at(name, solid_sphere(), [x, 0.0, 0.0], [DOWN if name == "a" else 0.0, 0, 0, 0, 0, 0])
        for name, x in zip("abc", places, strict=True)
    ]
    contacts = [
        oo.Contact(f"{a}/body", f"{b}/body", normal=LAW(1.0, 0.0), name=a + b)
        for a, b in itertools.pairwise("abc")
    ]
    trace = _run(oo.World(balls, contacts=contacts), 0.3)
    return np.array([trace[name].v[-1, 0] for name in "abc"]) / DOWN


def cradle() -> list[float]:
    """Return the errors of the speeds of balls that touch each other, and of balls with gaps."""
    touching, apart = np.array([-1.0, 2.0, 2.0]) / 3.0, np.array([0.0, 0.0, 1.0])
    return [float(np.abs(_row(0.0) - touching).max()), float(np.abs(_row(1e-3) - apart).max())]


def landing() -> list[float]:
    """Return the errors of velocity, m/s and rad/s, and lost energy, J, of a box that lands on a face."""
    shape = '<box size="{} {} {}"/>'.format(*EDGES)
    errors = []
    for e in RESTITUTIONS:
        thing = at("box", body(shape, 2.0, (0.1, 0.05, 0.12)), [0.3, 0.2, 0.11], [0, 0, -DOWN, 0, 0, 0])
        trace = _run(_on_floor(thing, LAW(e, MU)), 0.2)
        after = int(np.searchsorted(trace.time, trace.events[0].time, side="right"))
        end = trace["box"].v[after].copy()
        end[2] -= e * 0.2
        lost = trace.contacts["touch"].dissipated[-1]
        errors.append((float(np.abs(end).max()), abs(lost - 0.5 * 2.0 * 0.2**2 * (1.0 - e * e))))
    return list(worst(errors))


def _fall(restitution: float, turn: Array, velocity: Array) -> oo.WorldTrace:
    """Simulate a box with an attitude (4,) and a velocity (6,) that falls on a free plate."""
    quat = turn / np.linalg.norm(turn)
    q = np.array([0.0, 0.0, 0.5, *quat])
    velocity[:3] = matrix_from_quaternion(quat).T @ [*velocity[:2], -abs(velocity[2]) - 0.5]
    shape = '<box size="{} {} {}"/>'.format(*EDGES)
    plate = oo.System("plate", body('<box size="4 4 0.2"/>', 5.0, 6.0), [0, 0, -0.1, 0, 0, 0, 1], np.zeros(6))
    thing = oo.System("box", body(shape, 2.0, (0.1, 0.05, 0.12)), q, velocity)
    contact = oo.Contact("plate/*", "box/*", normal=LAW(restitution, ROUGH), name="touch")
    return _run(oo.World([plate, thing], contacts=[contact]), 1.0)


def falls() -> list[float]:
    """Return the largest errors of boxes that fall on a plate, corner by corner, with friction.

    They are the energy created by an impact and the error of the energy balance, both relative to the energy
    at the start, the change of linear momentum, relative to the impulse, and the change of angular momentum,
    divided by the impulse, m.
    """
    rng = np.random.default_rng(3)
    errors = []
    for e in (*RESTITUTIONS, 0.9):
        for _ in range(3):
            trace = _fall(e, rng.normal(size=4), 0.5 * rng.normal(size=6))
            energy, touch = trace.kinetic_energy, trace.contacts["touch"]
            first = energy[0]
            change = np.abs(trace.momentum - trace.momentum[0]).max(axis=0)
            impulse = np.linalg.norm(touch.impulse, axis=1).max()
            errors.append(
                (
                    max(float(np.diff(energy).max() / first), 0.0),
                    float(np.abs(energy + touch.dissipated - first).max() / first),
                    float(change[:3].max() / impulse), float(change[3:].max() / impulse),
                )
            )  # fmt: skip
    return list(worst(errors))


def _rod(normal: oo.ImpactLaw | oo.HuntCrossley, friction: oo.Friction | None = None) -> oo.WorldTrace:
    """Simulate a uniform rod, inclined at an angle of tangent 2, whose tip slides on the floor under 1 N."""
    cosine, half = 1.0 / np.sqrt(5.0), 0.5 * LENGTH
    sine, moment = TANGENT * cosine, half**2 / 3.0
    model = oo.Model.from_urdf_string(
        '<robot name="rod"><link name="rod"><inertial><mass value="1"/>'
        f'<inertia ixx="{moment}" iyy="{moment}" izz="{moment}" ixy="0" ixz="0" iyz="0"/></inertial>'
        f'<collision><origin xyz="{-half * cosine} 0 {-half * sine + TIP}"/>'
        f'<geometry><sphere radius="{TIP}"/></geometry></collision></link></robot>'
    )
    rod = at("rod", model, [half * cosine, 0.0, half * sine], [-0.5, 0.0, 0.0, 0.0, 0.0, 0.0])
    contact = oo.Contact("floor/*", "rod/*", normal=normal, friction=friction, name="tip")
    press = oo.BodyWrench("rod/rod", force=[0.0, 0.0, -1.0])
    return _run(oo.World([floor(), rod], contacts=[contact], environment=[press]), 0.02, 1e-3)


def painleve() -> list[float]:
    """Return the errors of the largest friction coefficient of a sliding rod, and of its energy balance.

    Above this coefficient, the rigid rod has no contact force. The energy balance is that of a compliant
    contact, relative to the energy.
    """
    try:
        _rod(LAW(0.0, 1.4))
    except SimulationError as error:
        limit = float(error.expected)
    else:
        limit = np.nan
    trace = _rod(oo.HuntCrossley(1e6, 1.0, dissipation=1.0), oo.Friction(1.4))
    if not trace.contacts["tip"].largest_force[-1] > 1.0:
        force = float(trace.contacts["tip"].largest_force[-1])
        raise ValueError(f"the largest force of the tip of the rod is {force:g} N; it must be above 1 N")
    balance = [row[1] for row in trace.certificate() if "energy_balance" in row[0] and row[1] is not None]
    return [abs(limit - 4.0 / 3.0), float(worst(balance))]


def rest() -> list[float]:
    """Return the errors of a ball that bounces to rest under a constant force of 1 N.

    They are those of the gap, m, the speed, m/s, and the force, N, at the end, and of the energy lost, J.
    """
    ball = at("ball", solid_sphere(), [0.0, 0.0, RADIUS + HEIGHT])
    world = _on_floor(ball, LAW(0.5, MU), (oo.BodyWrench("ball/body", force=[0.0, 0.0, -1.0]),))
    trace = _run(world, 4.0)
    touch = trace.contacts["touch"]
    return [
        abs(float(touch.gap[-1])), float(np.abs(trace["ball"].v[-1]).max()),
        abs(float(touch.force[-1, 2]) - 1.0), abs(float(touch.dissipated[-1]) - 0.1),
    ]  # fmt: skip


CASES = (
    Case(
        "contact", "oblique impact of a rigid sphere", "Coulomb: sticks if v_t/v_n <= 3.5 mu (1 + e)",
        (
            Gate("velocity, spheres that stick", 1e-12, "m/s"),
            Gate("velocity, spheres that slip", 1e-12, "m/s"),
        ), oblique,
    ),
    Case(
        "contact", "three rigid balls in a row", "conservation of momentum and energy",
        (Gate("speeds, balls that touch", 1e-12), Gate("speeds, balls with gaps", 1e-12)), cradle,
    ),
    Case(
        "contact", "a rigid box lands on four corners", "Newton: v' = e v, loss m v^2 (1 - e^2)/2",
        (Gate("velocity", 1e-12, "m/s"), Gate("energy lost", 1e-12, "J")), landing,
    ),
    Case(
        "contact", "rigid boxes fall on a plate", "conservation of momentum; an impact creates no energy",
        (
            Gate("energy created", 1e-12), Gate("energy balance", 1e-9),
            Gate("linear momentum", 1e-12), Gate("angular momentum", 1e-12, "m"),
        ), falls,
    ),
    Case(
        "contact", "a sliding rod, Painlevé's case", "mu < (1 + 3 cos^2)/(3 sin cos), 4/3 at tan = 2",
        (Gate("coefficient without a force", 1e-9), Gate("energy balance, compliant contact", 1e-8)),
        painleve,
    ),
    Case(
        "contact", "a rigid ball bounces to rest", "conservation of energy; rest under a constant force",
        (
            Gate("gap", 1e-12, "m"), Gate("speed", 1e-12, "m/s"),
            Gate("force", 1e-9, "N"), Gate("energy lost", 1e-9, "J"),
        ), rest,
    ),
)  # fmt: skip
