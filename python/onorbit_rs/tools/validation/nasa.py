"""NASA's orbital check-cases: simulations of one rigid body over 8 h with steps of 1 s.

``nasa_states.csv`` holds the numbers of NASA/TM-2015-218675 (JEOD's SIM_dyncomp verification logs): position
and velocity of the centre of mass in inertial axes, the rotation ``T`` from inertial to body components, and
rates in body axes. An independent integration with DOP853 agrees with them to 5e-6 m, 6e-8 m/s, 1.4e-13
rad/s, 2e-9 degrees.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple

import numpy as np

import onorbit_rs as oo
from onorbit_rs.common.coordinates import ANGULAR, QUATERNION
from onorbit_rs.common.rotations import angle_between, quaternion_from_matrix
from onorbit_rs.tools.validation.case import Case, Gate, table, worst
from onorbit_rs.tools.validation.fields import field

SOURCE = "NASA/TM-2015-218675 (JEOD)"
MU = 3.986004415e14  # GGM02C; with 3.986004418e14 the error of run 2 is 0.32 m
EARTH_RATE = 7.292115146706388e-5  # rad/s, atmosphere of run 6A
ISS_INERTIA = [[1.02e8, -6.96e6, -5.48e6], [-6.96e6, 0.91e8, 5.9e5], [-5.48e6, 5.9e5, 1.64e8]]
HOURS_8 = 28_800.0

TWIST = oo.BodyWrench("base", torque=[10.0, 0, 0], start=1000.0, end=2000.0)
PUSH_AND_TWIST = oo.BodyWrench("base", force=[10.0, 0, 0], torque=[10.0, 0, 0], start=1000.0, end=2000.0)
BURN = oo.BodyWrench("base", force=[0, -29000.0, 0], start=1000.0, end=1048.0)


def iss() -> oo.Model:
    """Return the check-cases' model of the International Space Station."""
    return oo.Model.rigid_body(400_000.0, ISS_INERTIA)


def cylinder() -> oo.Model:
    """Return the check-cases' cylinder, whose long axis is x."""
    return oo.Model.rigid_body(1000.0, np.diag([500.0, 12250.0, 12250.0]))


def sphere() -> oo.Model:
    """Return the check-cases' sphere of 1 kg."""
    return oo.Model.rigid_body(1.0, 0.4 * np.eye(3))


def turning_earth() -> oo.Earth:
    """Return the Earth of run 3A, with TAI-UT1 = 32.469 s.

    The epoch of the run is 0 h UTC with NASA's TAI-UTC, 32 s; the Earth's model uses the correct 33 s.
    """
    return oo.Earth("2007-11-20T00:00:32 TAI", ut1_minus_utc=33.0 - 32.469)


def turning_air() -> oo.Earth:
    """Return the Earth of run 6A, which rotates about the inertial z axis."""
    return oo.Earth(rotation="about_z", rate=EARTH_RATE)


def air() -> list[Any]:
    """Return the environment of run 6A: drag in air of constant density."""
    ball = oo.Cannonball(1.0, drag_coefficient=0.02)
    return [oo.Drag(oo.ConstantAtmosphere(1.4e-12), surfaces=ball)]


TYPICAL = ((-4292653.41, 955168.47, 5139356.57), (109.649663, -7527.726490, 1484.521489))
ELLIPTICAL = ((-4315967.74, 960356.20, 5167269.53), (129.091037, -7491.513855, 1452.515654))


def pitched(orbit: Any, degrees: float) -> Any:
    """Return the rotation ``T`` of a body pitched from the frame ``nadir``, whose z points to the planet."""
    r, v = orbit
    z = -np.array(r) / np.linalg.norm(r)
    y = -np.cross(r, v)
    y /= np.linalg.norm(y)
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[c, 0, -s], [0, 1, 0], [s, 0, c]]) @ np.array([np.cross(y, z), y, z])


@dataclass(frozen=True)
class CheckCase:
    """A check-case: body, orbit, environment, initial pitch (degrees, from ``nadir``) and body rate."""

    title: str
    model: Callable[[], oo.Model]
    orbit: Any
    environment: Callable[[], list[Any]] = list
    earth: Callable[[], oo.Earth | None] = lambda: None
    pitch: float | None = -11.6  # None: the table has a row for time 0
    rate: tuple[float, float, float] = (0.0, -1.134454274550824e-3, 0.0)
    position_gate: float = 1e-4


STILL = (0.0, 0.0, 0.0)

RUNS = {
    "2": CheckCase("the station rotates freely", iss, TYPICAL),
    "3A": CheckCase(
        "gravity of degree 4", iss, TYPICAL,
        lambda: [field("ggm02c", 4)], turning_earth, position_gate=1.5,
    ),
    "6A": CheckCase(
        "drag on a sphere", sphere, ELLIPTICAL, air, turning_air, rate=(0.0, -1.122230030875939e-3, 0.0)
    ),
    "6C": CheckCase(
        "a burn that ends 9860 km from the reference", cylinder, TYPICAL, lambda: [BURN], pitch=0.0
    ),
    "8A": CheckCase("a sphere without rotation", sphere, TYPICAL, rate=STILL),
    "9A": CheckCase("a torque for 1000 s", iss, TYPICAL, lambda: [TWIST], rate=STILL),
    "9C": CheckCase("a torque and a force for 1000 s", iss, TYPICAL, lambda: [PUSH_AND_TWIST], rate=STILL),
    "10A": CheckCase("gravity gradient", cylinder, TYPICAL, lambda: [oo.GravityGradient()], pitch=None),
    "10C": CheckCase(
        "gravity gradient on an ellipse", cylinder, ELLIPTICAL, lambda: [oo.GravityGradient()], pitch=None
    ),
}  # fmt: skip


class Row(NamedTuple):
    """A row of NASA's table: time (s), position (m), velocity (m/s), rate (rad/s) and attitude (T)."""

    time: float
    position: Any
    velocity: Any
    rate: Any
    attitude: Any


def rows(run: str) -> list[Row]:
    """Return the rows of one run in NASA's table, sorted by time."""
    found = []
    for row in table("nasa_states"):
        name, *values = row.values()
        if name == run:
            x = np.array([float(value) for value in values])
            found.append(Row(x[0], x[1:4], x[4:7], x[7:10], x[10:].reshape(3, 3)))
    return found


def simulate(run: str, case: CheckCase | None = None, duration: float = HOURS_8) -> oo.Trace:
    """Simulate a run, or a variant ``case`` of it, for ``duration`` seconds.

    If the pitch of the case is None, the first row of the run defines the initial attitude and rate.
    """
    case = case or RUNS[run]
    rate, attitude = case.rate, pitched(case.orbit, case.pitch or 0.0)
    if case.pitch is None:
        rate, attitude = rows(run)[0].rate, rows(run)[0].attitude
    q = np.concatenate([np.zeros(3), quaternion_from_matrix(attitude.T)])
    return oo.Simulation(
        case.model(), q, np.concatenate([np.zeros(3), rate]),
        orbit=oo.Kepler.from_state(*case.orbit, mu=MU), earth=case.earth(),
        environment=case.environment(), time_step=1.0, record_every=60,
    ).run(duration)  # fmt: skip


def errors(run: str, case: CheckCase | None = None) -> Any:
    """Return the largest errors over the rows (six runs have only a final row): m, m/s, rad/s, degrees."""
    trace = simulate(run, case)
    assert trace.position_eci is not None and trace.velocity_eci is not None
    found = []
    for row in rows(run):
        k = int(np.searchsorted(trace.time, row.time))
        turned = angle_between(trace.q[k, QUATERNION], quaternion_from_matrix(row.attitude.T))
        found.append((
            np.linalg.norm(trace.position_eci[k] - row.position),
            np.linalg.norm(trace.velocity_eci[k] - row.velocity),
            np.abs(trace.v[k, ANGULAR] - row.rate).max(),
            np.degrees(turned),
        ))  # fmt: skip
    return worst(found)


def gates(case: CheckCase) -> tuple[Gate, ...]:
    """Return the gates of a run; the gates of run 3A are the differences between NASA's simulators."""
    velocity = 1e-7 if case.position_gate < 1.0 else 1.5e-3
    return (
        Gate("position", case.position_gate, "m"), Gate("velocity", velocity, "m/s"),
        Gate("rate", 1e-12, "rad/s"), Gate("attitude", 1e-7, "deg"),
    )  # fmt: skip


# rad/s², body axes, after 8 h
GRADIENT = {
    "10A": [0.0, 1.243056784774573e-07, 4.58638231464994e-08],
    "10C": [0.0, 9.285032588060049e-08, 2.393403219339611e-08],
}


def gradient(run: str) -> tuple[float]:
    """Return the largest error of the angular acceleration by the gravity gradient after 8 h, rad/s²."""
    end, q, v = rows(run)[-1], np.zeros(7), np.zeros(6)
    q[3:], v[3:] = quaternion_from_matrix(end.attitude.T), end.rate
    trace = oo.Simulation(
        cylinder(), q, v, orbit=oo.Kepler.from_state(end.position, end.velocity, mu=MU),
        environment=[oo.GravityGradient()], time_step=1.0,
    ).run(1.0)  # fmt: skip
    return (float(np.abs(trace.acceleration[0, 3:] - GRADIENT[run]).max()),)


CASES = (
    *(
        Case("nasa", f"run {run}: {case.title}", SOURCE, gates(case), partial(errors, run))
        for run, case in RUNS.items()
    ),
    *(
        Case(
            "nasa", f"run {run}: gravity-gradient torque after 8 h", SOURCE,
            (Gate("angular acceleration", 3e-20, "rad/s2"),), partial(gradient, run),
        )
        for run in GRADIENT
    ),
)  # fmt: skip
