"""Tests grasps by contact forces: closing rate, force, slip, creep, and balances of a whole capture."""

from __future__ import annotations

import numpy as np

import onorbit_rs as oo
from onorbit_rs.tools.validation import grasp_worlds
from onorbit_rs.tools.validation.case import Case, Gate
from onorbit_rs.tools.validation.grasp_worlds import BAR_MASS, FORCE, arm, grip, in_hand, run, world

INTEGRAL = 20.0  # gain of the force error, 1/s
PUSH = 3.0  # N, on one finger
JOINT_DAMPING = 2.0  # of each jaw, N s/m
HOLDS, SLIPS = 0.8, 1.02  # of the friction of both pads
SLIDER = 11.0  # mass that the arm moves, kg
LOAD, SHIFT = 10.0, 0.05  # along the bar, N, and motion of the arm, m
PIN = 0.03  # radius, m


def force_of(trace: oo.WorldTrace, names: tuple[str, ...] = ("left", "right")) -> float:
    """Return the mean normal force of the fingers at the end, N."""
    contacts = [trace.contacts[name] for name in names]
    forces = [abs(float(contact.force[-1] @ contact.normal[-1])) for contact in contacts]
    return sum(forces) / len(forces)


def closing() -> list[float]:
    """Return the relative error of the closing rate, `v = r d/(d + 2 b)`.

    `r` and `d` are the closing rate and the damping of the control law, `b` is the damping of each jaw.
    """
    trace = run(world([grip()], opening=0.11), 1.0)
    damping = grasp_worlds.DAMPING
    expected = grasp_worlds.CLOSING * damping / (damping + 2.0 * JOINT_DAMPING)
    return [abs(float(trace["hand"].v[-1, 7]) / expected - 1.0)]


def steady() -> list[float]:
    """Return the errors of the grip force, N, without a disturbance and with a force on one finger."""
    errors = []
    for push in (0.0, PUSH):
        load = oo.BodyWrench("hand/left_finger", force=[-push, 0.0, 0.0])
        made = world([arm([0.0, 0.0], [0.0, 1.0]), grip(integral=INTEGRAL)], loads=[load] if push else [])
        errors.append(abs(force_of(run(made, 3.0, every=20)) - FORCE))
    return errors


def pulled(fraction: float) -> tuple[float, float]:
    """Return the speed, m/s, and the acceleration, m/s², of the bar in the hand at the end of a pull.

    The arm has no motor, so that the hand, of mass `m`, follows the bar, of mass `M`. The friction that holds
    both together is `P m/(M + m)` for the pull `P`; ``fraction`` is its ratio to the largest one of the pads.
    """
    friction = 2.0 * grasp_worlds.MU * FORCE
    pull = fraction * friction * (BAR_MASS + SLIDER) / SLIDER
    load = oo.BodyWrench("bar/body", force=[0.0, pull, 0.0], start=2.0)
    trace = run(world([grip(integral=INTEGRAL)], loads=[load]), 3.0)
    time, place = np.asarray(trace["bar"].time), in_hand(trace)[:, 1]
    at = [int(np.searchsorted(time, start)) for start in (2.78, 2.8, 2.98)] + [-1]
    speeds = [(place[b] - place[a]) / (time[b] - time[a]) for a, b in (at[:2], at[2:])]
    middle = [0.5 * (time[a] + time[b]) for a, b in (at[:2], at[2:])]
    return float(speeds[1]), float((speeds[1] - speeds[0]) / (middle[1] - middle[0]))


def slip() -> list[float]:
    """Return the speed, m/s, under a pull that the pads hold, and an error of the slip under a stronger pull.

    The error is that of the acceleration of the bar in the hand, relative to `(c − 1) f (1/M + 1/m)`, where
    `f` is the largest friction of the pads and `c f` the load of the contact.
    """
    acceleration = (SLIPS - 1.0) * 2.0 * grasp_worlds.MU * FORCE * (1.0 / BAR_MASS + 1.0 / SLIDER)
    return [abs(pulled(HOLDS)[0]), abs(pulled(SLIPS)[1] / acceleration - 1.0)]


def creep() -> list[float]:
    """Return the net speed, m/s, of a held and loaded bar in the hand while the arm moves back and forth."""
    lever = float(grasp_worlds.start()[1][2])
    loads = [
        oo.BodyWrench("bar/body", force=[0.0, LOAD, 0.0], start=1.2),
        oo.BodyWrench("hand/bus", force=[0.0, -LOAD, 0.0], torque=[lever * LOAD, 0.0, 0.0], start=1.2),
    ]
    motion = arm([0.0, 0.0, SHIFT, 0.0], [0.0, 3.0, 4.5, 6.0])
    trace = run(world([motion, grip(integral=INTEGRAL)], loads=loads), 8.0, every=20)
    time, place = np.asarray(trace["bar"].time), in_hand(trace)
    before = int(np.argmin(np.abs(time - 3.0)))
    return [float(np.linalg.norm(place[-1] - place[before]) / (time[-1] - time[before]))]


def levers() -> list[float]:
    """Return the error of the grip force, N, and the relative error of the torques of three revolute fingers.

    At rest, the torque of a finger is `N aᵀ (r × n)` with the normal force `N`, the axis `a` of its joint,
    and the point `r` and the normal `n` of its contact relative to the joint.
    """
    trace, model = grasp_worlds.three_fingers(PIN, INTEGRAL)
    names = grasp_worlds.FINGERS
    q, torques = np.asarray(trace["hand"].q[-1]), np.asarray(trace["hand"].tau[-1])
    errors = []
    for index, name in enumerate(names):
        contact = trace.contacts[name]
        pose = model.frame_pose(q, f"{name}_finger")
        arm_of = np.asarray(contact.point[-1]) - pose[:3, 3]
        moment = pose[:3, 1] @ np.cross(arm_of, -np.asarray(contact.normal[-1]))  # on the finger
        normal = float(contact.force[-1] @ contact.normal[-1])
        errors.append(abs(torques[index] / (-normal * moment) - 1.0))
    return [abs(force_of(trace, names) - FORCE), max(errors)]


def momentum_of(trace: oo.WorldTrace) -> np.ndarray:
    """Return the momentum of both systems, (T, 6), N s and N m s about the origin of W."""
    return np.asarray(trace.momentum)


def whole() -> list[float]:
    """Return the errors of momentum and energy through grasp, arm motion, latch, seating and release.

    The changes of linear and angular momentum are divided by the sum of the impulses; the error of the energy
    is relative to the work.
    """
    trace = grasp_worlds.operation()
    momentum = momentum_of(trace)
    impulse = sum(
        float(np.linalg.norm(np.diff(np.asarray(trace.contacts[name].impulse), axis=0), axis=1).sum())
        for name in ("left", "right")
    ) + sum(float(np.linalg.norm(event.impulse[:3])) for event in trace.events if event.kind == "capture")
    (energy,) = [
        value for name, value, *_ in trace.certificate() if name == "hand+bar/energy_balance_error_rel"
    ]
    assert energy is not None
    kinds = [event.kind for event in trace.events if event.kind in ("capture", "release")]
    if kinds != ["capture", "release"]:
        raise ValueError(f"the events are {kinds}; expected a capture, then a release")
    return [
        float(np.linalg.norm(momentum[:, :3] - momentum[0, :3], axis=1).max() / impulse),
        float(np.linalg.norm(momentum[:, 3:] - momentum[0, 3:], axis=1).max() / impulse),
        energy,
    ]


CASES = (
    Case(
        "grasp", "jaws close until they touch", "v = r d/(d + 2 b)", (Gate("closing rate", 1e-10),), closing
    ),
    Case(
        "grasp", "jaws close to 25 N", "the integral removes the error",
        (Gate("force", 1e-9, "N"), Gate("force, 3 N on one finger", 1e-9, "N")), steady,
    ),
    Case(
        "grasp", "a held bar is pulled out", "Coulomb: (c − 1) f (1/M + 1/m)",
        (
            Gate("speed, 80 % of the friction", 1e-7, "m/s"),
            Gate("acceleration, 102 % of the friction", 1e-4),
        ), slip,
    ),
    Case(
        "grasp", "a held and loaded bar, the arm moves", "Coulomb: rest inside the friction cone",
        (Gate("net speed in the hand", 1e-9, "m/s"),), creep,
    ),
    Case(
        "grasp", "three revolute fingers", "N aᵀ (r × n)",
        (Gate("force", 1e-9, "N"), Gate("torques", 1e-5)), levers,
    ),
    Case(
        "grasp", "grasp, arm motion, latch, seating and release", "conservation",
        (
            Gate("linear momentum, of the impulses", 1e-12), Gate("angular momentum, of the impulses", 1e-12),
            Gate("energy, of the work", 1e-8),
        ), whole,
    ),
)  # fmt: skip
