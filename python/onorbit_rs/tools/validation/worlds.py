"""Tests worlds of several spacecraft: groups, latches, chains of captures, and motion between events."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

import onorbit_rs as oo
from onorbit_rs.tools.validation.capture import STEP, momentum, random_craft, rigid, run
from onorbit_rs.tools.validation.case import Case, Gate
from onorbit_rs.tools.validation.gauss import Craft, mass_matrix, project, relative_twist
from onorbit_rs.tools.validation.trees import Array

NAMES = "abcd"


def system(name: str, craft: Craft) -> oo.System:
    """Return a system with the robot and the state of a craft."""
    return oo.System(name, craft.model, craft.q, craft.v)


def slow(seed: int, scale: float = 0.2) -> Craft:
    """Return a random robot in slow motion."""
    craft = random_craft(seed)
    return Craft(craft.model, craft.q, scale * craft.v, craft.frame)


def separate() -> tuple[float]:
    """Return the number of columns in which two robots without events differ from separate runs."""
    crafts = [slow(2000), slow(2001)]
    systems = [system(name, craft) for name, craft in zip(NAMES, crafts, strict=False)]
    both = run(systems, [], 0.2, time_step=STEP)
    different = 0
    for name, craft in zip(NAMES, crafts, strict=False):
        alone = oo.Simulation(craft.model, craft.q, craft.v, time_step=ALONE_STEP).run(0.2)
        for column in alone.columns():
            expected, found = getattr(alone, column), getattr(both[name], column)
            different += expected.tobytes() != found.tobytes()
    return (float(different),)


ALONE_STEP = STEP


def free_again() -> tuple[float, float]:
    """Return the largest errors of q and v after a release, against runs from the state at the release."""
    crafts = [slow(2002), slow(2003)]
    systems = [system(name, craft) for name, craft in zip(NAMES, crafts, strict=False)]
    events: list[oo.Capture | oo.Release] = [
        oo.Capture("grasp", f"a/{crafts[0].frame}", f"b/{crafts[1].frame}", at=0.1),
        oo.Release("let_go", "grasp", at=RELEASE),
    ]
    trace = run(systems, events, 1.0, time_step=STEP)
    row = np.flatnonzero(trace.time == 0.5)[-1]
    errors = np.zeros(2)
    for name, craft in zip(NAMES, crafts, strict=False):
        found = trace[name]
        alone = oo.Simulation(craft.model, found.q[row], found.v[row], time_step=STEP).run(0.5)
        off = craft.model.difference(alone.q[-1], found.q[-1]), alone.v[-1] - found.v[-1]
        errors = np.maximum(errors, [np.abs(each).max() for each in off])
    return float(errors[0]), float(errors[1])


RELEASE = 0.5  # s


def at_row(trace: oo.WorldTrace, crafts: Sequence[Craft], row: int) -> list[Craft]:
    """Return the crafts with their states in one row of a trace."""
    return [
        Craft(craft.model, trace[name].q[row], trace[name].v[row], craft.frame)
        for name, craft in zip(NAMES, crafts, strict=False)
    ]


CHAIN = (("b", "c"), ("d", "a"), ("c", "d"))  # the first captures the second


def chain() -> tuple[float, float, float]:
    """Return the relative errors of velocity, energy and momentum of three captures of four robots.

    Earlier connections persist, so each capture is a projection with the constraints of all captures so far.
    """
    crafts = [slow(2010 + i) for i in range(4)]
    events = [
        oo.Capture(first + second, *(f"{name}/{crafts[NAMES.index(name)].frame}" for name in (first, second)),
                   at=0.1 * (i + 1))
        for i, (first, second) in enumerate(CHAIN)
    ]  # fmt: skip
    systems = [system(name, craft) for name, craft in zip(NAMES, crafts, strict=True)]
    trace = run(systems, events, 0.4, time_step=0.005)
    pairs = [(NAMES.index(first), NAMES.index(second)) for first, second in CHAIN]
    errors = np.zeros(3)
    for count, record in enumerate(trace.events, start=1):
        rows = np.flatnonzero(trace.time == record.time)
        before, after = (at_row(trace, crafts, int(row)) for row in (rows[0], rows[-1]))
        lines = np.vstack([relative_twist(before, *pair) for pair in pairs[:KEPT][:count]])
        v, impulse = project(mass_matrix(before), lines, joined(before))
        lost = -0.5 * (lines @ joined(before)) @ impulse
        errors = np.maximum(errors, [
            np.abs(joined(after) - v).max() / np.abs(joined(before)).max(),
            abs(record.energy_lost / lost - 1.0),
            change(before, after),
        ])  # fmt: skip
    return (errors[0], errors[1], errors[2])


KEPT = 3  # number of captures whose constraints are taken into account


def joined(crafts: Sequence[Craft]) -> Array:
    """Return the velocities of several craft, (nv,) each, joined in one array (Σnv,)."""
    return np.concatenate([craft.v for craft in crafts])


def change(before: Sequence[Craft], after: Sequence[Craft]) -> float:
    """Return the larger relative change of linear or angular momentum.

    Changes are relative to the sum of the magnitudes of the links' momenta.
    """
    point = before[0].pose[:3, 3]
    old, new = ([momentum(craft, craft.v, point) for craft in crafts] for crafts in (before, after))
    difference = sum(m for m, _ in new) - sum(m for m, _ in old)
    scales = sum((scale for _, scale in old), np.zeros(2))
    return float((np.linalg.norm(np.reshape(difference, (2, 3)), axis=1) / scales).max())


GAP, SPEED, HELD, REACH = 1.7, 0.3, 0.25, 0.5  # m, m/s, s, m


def latch() -> tuple[float, float]:
    """Return the errors of the time at which a latch closes, s, and of the energy lost, J.

    The time is `(d − r)/v + t_held`.

    `d` is the initial distance, `v` the closing speed, `r` the latch's reach, `t_held` the time for which its
    conditions must hold.
    """
    systems = [
        rigid("a", 40.0, [3, 4, 5], [0, 0, 0], np.zeros(6)),
        rigid("b", 20.0, [1, 2, 2], [GAP, 0, 0], [-SPEED, 0, 0, 0, 0, 0]),
    ]
    event = oo.Capture("grasp", "a/base", "b/base", within=[0.5, 0.1], held_for=HELD)
    trace = run(systems, [event], 6.0, time_step=0.03)
    (record,) = trace.events
    energy = 0.5 * (40.0 * 20.0 / 60.0) * 0.3**2
    return abs(record.time - ((GAP - REACH) / 0.3 + 0.25)), abs(record.energy_lost - energy)


SPINS = (0.02, -0.015)  # rad/s about the common axis


def latch_by_angle() -> tuple[float]:
    """Return the error of the time, s, at which a latch closes by angle; both craft rotate about one axis."""
    systems = [
        rigid("a", 40.0, [3, 4, 5], [0, 0, 0], [0, 0, 0, 0, 0, SPINS[0]]),
        rigid("b", 20.0, [1, 2, 2], [0, 0, 1.0], [0, 0, 0, 0, 0, -0.015]),
    ]
    systems[1] = oo.System("b", systems[1].model, [0, 0, 1.0, 0, 0, np.sin(0.2), np.cos(0.2)],
                           [0, 0, 0, 0, 0, -0.015])  # fmt: skip
    event = oo.Capture("grasp", "a/base", "b/base", within=[2.0, 0.05])
    (record,) = run(systems, [event], 20.0, time_step=0.1).events
    return (abs(record.time - (0.4 - 0.05) / (0.02 + 0.015)),)


RADIUS = 6_778e3  # m


def on_orbit() -> tuple[float, float, float]:
    """Return the errors of the common centre of mass, m, and of momentum at and after a capture in orbit.

    The common centre of mass obeys the Clohessy-Wiltshire equations before and after the capture.
    """
    orbit = oo.Kepler(semi_major_axis=RADIUS, inclination=0.9, mean_anomaly=0.3)
    start = [[0.0, 0.0, 0.0], [2.5, 0.0, 0.0]]
    v = [np.zeros(6), np.array([-0.005, 0.002, 0.001, 0.02, 0.05, -0.03])]
    masses = [1000.0, 500.0]
    systems = [
        rigid("a", masses[0], [300, 400, 500], start[0], v[0]),
        rigid("b", masses[1], [120, 90, 150], start[1], v[1]),
    ]
    event = oo.Capture("grasp", "a/base", "b/base", at=100.0)
    trace = run(systems, [event], 300.0, orbit=orbit, time_step=0.1, record_every=10)
    weights = np.array(WEIGHTS) / sum(WEIGHTS)
    center = sum(w * trace[name].center_of_mass for w, name in zip(weights, "ab", strict=True))
    expected = clohessy_wiltshire(
        orbit,
        np.average(start, axis=0, weights=masses),
        np.average(v, axis=0, weights=masses)[:3],
        trace.time,
    )
    certificate = {name: value for name, value, *_ in trace.certificate()}
    drift = [certificate[f"a+b/{kind}_momentum_drift_rel"] for kind in ("linear", "angular")]
    return (
        float(np.abs(center - expected).max()),
        float(trace.events[0].momentum_error.max()),
        max(np.inf if value is None else value for value in drift),
    )


WEIGHTS = (1000.0, 500.0)  # kg


def clohessy_wiltshire(orbit: oo.Kepler, r: Array, v: Array, t: Array) -> Array:
    """Return positions (T, 3), m, relative to a circular orbit, in inertial axes, from the initial `r, v`."""
    place, speed = orbit.state(0.0)
    n = np.linalg.norm(np.cross(place, speed)) / RADIUS**2
    radial, normal = place / RADIUS, np.cross(place, speed)
    normal = normal / np.linalg.norm(normal)
    axes = np.column_stack([radial, np.cross(normal, radial), normal])
    x, y, z = axes.T @ r
    u, w, s = axes.T @ v - np.cross([0, 0, n], axes.T @ r)
    c, k = np.cos(n * t), np.sin(n * t)
    along = np.array([
        (4 - 3 * c) * x + k / n * u + 2 / n * (1 - c) * w,
        6 * (k - n * t) * x + y - 2 / n * (1 - c) * u + (4 * k - 3 * n * t) / n * w,
        z * c + s / n * k,
    ])  # fmt: skip
    turned = np.array([c * along[0] - k * along[1], k * along[0] + c * along[1], along[2]])
    return np.asarray((axes @ turned).T)


CASES = (
    Case(
        "world", "two robots that no event connects, 0.2 s", "a run of each alone",
        (Gate("columns whose bits differ", 0.0),), separate,
    ),
    Case(
        "world", "two robots after a capture and a release",
        "a run of each alone from its state at the release",
        (Gate("configuration", 1e-12), Gate("velocity", 1e-12)), free_again,
    ),
    Case(
        "world", "three captures connect four robots", "Gauss's principle from four mass matrices",
        (Gate("velocity", 1e-12), Gate("energy lost", 1e-11), Gate("momentum", 1e-14)), chain,
    ),
    Case(
        "world", "a latch that closes by distance", "(d - r)/v + t, reduced mass",
        (Gate("time", 1e-12, "s"), Gate("energy lost", 1e-14, "J")), latch,
    ),
    Case(
        "world", "a latch that closes by angle", "difference of angles over that of rates",
        (Gate("time", 1e-10, "s"),), latch_by_angle,
    ),
    Case(
        "world", "a capture on a circular orbit, 300 s", "Clohessy and Wiltshire: the common centre of mass",
        (
            Gate("centre of mass", 1e-7, "m"), Gate("momentum at the capture", 1e-14),
            Gate("momentum without the effect of gravity", 1e-11),
        ), on_orbit,
    ),
)  # fmt: skip
