"""NASA's orbital check-cases: one rigid body, 8 h at 1 s, through ``Simulation``.

Numbers of NASA/TM-2015-218675 (values of JEOD's SIM_dyncomp verification logs), in ``nasa_states.csv``:
position and velocity of the centre of mass in inertial axes; ``T`` takes inertial to body components;
rates in body axes. An independent DOP853 integration reaches 5e-6 m, 6e-8 m/s, 1.4e-13 rad/s, 2e-9 degrees.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple

import numpy as np

import onorbit_rs as oo
from onorbit_rs.rotations import angle_between, quaternion_from_matrix
from onorbit_rs.validation.case import Case, Gate, table, worst
from onorbit_rs.validation.fields import field

SOURCE = "NASA/TM-2015-218675 (JEOD)"
MU = 3.986004415e14  # GGM02C; with 3.986004418e14 run 2 is off by 0.32 m
EARTH_RATE = 7.292115146706388e-5  # rad/s, of the air in 6A
ISS_INERTIA = [[1.02e8, -6.96e6, -5.48e6], [-6.96e6, 0.91e8, 5.9e5], [-5.48e6, 5.9e5, 1.64e8]]
HOURS_8 = 28_800.0

TWIST = oo.BodyWrench("base", torque=[10.0, 0, 0], start=1000.0, end=2000.0)
PUSH_AND_TWIST = oo.BodyWrench("base", force=[10.0, 0, 0], torque=[10.0, 0, 0], start=1000.0, end=2000.0)
BURN = oo.BodyWrench("base", force=[0, -29000.0, 0], start=1000.0, end=1048.0)


def iss() -> oo.Model:
    """The station."""
    return oo.Model.rigid_body(400_000.0, ISS_INERTIA)


def cylinder() -> oo.Model:
    """Its long axis is x."""
    return oo.Model.rigid_body(1000.0, np.diag([500.0, 12250.0, 12250.0]))


def sphere() -> oo.Model:
    """Of one kilogram."""
    return oo.Model.rigid_body(1.0, 0.4 * np.eye(3))


def turning_earth() -> oo.Earth:
    """That of 3A: TAI-UTC is forced to 32 s, TAI-UT1 to 32.469 s."""
    return oo.Earth("2007-11-20T00:00:32 TAI", ut1_minus_utc=33.0 - 32.469)


def turning_air() -> oo.Earth:
    """That of 6A: about the inertial z."""
    return oo.Earth(rotation="about_z", rate=EARTH_RATE)


def air() -> list[Any]:
    """That of 6A: of constant density."""
    ball = oo.Cannonball(1.0, drag_coefficient=0.02)
    return [oo.Drag(oo.ConstantAtmosphere(1.4e-12), surfaces=ball)]


TYPICAL = ((-4292653.41, 955168.47, 5139356.57), (109.649663, -7527.726490, 1484.521489))
ELLIPTICAL = ((-4315967.74, 960356.20, 5167269.53), (129.091037, -7491.513855, 1452.515654))


def pitched(orbit: Any, degrees: float) -> Any:
    """T of a body pitched from the frame with z down and y against the angular momentum."""
    r, v = orbit
    z = -np.array(r) / np.linalg.norm(r)
    y = -np.cross(r, v)
    y /= np.linalg.norm(y)
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[c, 0, -s], [0, 1, 0], [s, 0, c]]) @ np.array([np.cross(y, z), y, z])


@dataclass(frozen=True)
class Flown:
    """Who flies where, in what: pitch in degrees from the frame that points down, rate in body axes."""

    what: str
    model: Callable[[], oo.Model]
    orbit: Any
    environment: Callable[[], list[Any]] = list
    earth: Callable[[], oo.Earth | None] = lambda: None
    pitch: float | None = -11.6  # None: the table has a row of time 0
    rate: tuple[float, float, float] = (0.0, -1.134454274550824e-3, 0.0)
    position_gate: float = 1e-4


STILL = (0.0, 0.0, 0.0)

RUNS = {
    "2": Flown("the station turns freely", iss, TYPICAL),
    "3A": Flown(
        "gravity of degree 4", iss, TYPICAL,
        lambda: [field("ggm02c", 4)], turning_earth, position_gate=1.5,
    ),
    "6A": Flown(
        "drag on a sphere", sphere, ELLIPTICAL, air, turning_air, rate=(0.0, -1.122230030875939e-3, 0.0)
    ),
    "6C": Flown(
        "a burn that ends 9860 km from the reference", cylinder, TYPICAL, lambda: [BURN], pitch=0.0
    ),
    "8A": Flown("a sphere that does not turn", sphere, TYPICAL, rate=STILL),
    "9A": Flown("a torque for 1000 s", iss, TYPICAL, lambda: [TWIST], rate=STILL),
    "9C": Flown("a torque and a force for 1000 s", iss, TYPICAL, lambda: [PUSH_AND_TWIST], rate=STILL),
    "10A": Flown("gravity gradient", cylinder, TYPICAL, lambda: [oo.GravityGradient()], pitch=None),
    "10C": Flown(
        "gravity gradient on an ellipse", cylinder, ELLIPTICAL, lambda: [oo.GravityGradient()], pitch=None
    ),
}  # fmt: skip


class Row(NamedTuple):
    """What NASA has: s, m, m/s, rad/s, T."""

    time: float
    position: Any
    velocity: Any
    rate: Any
    attitude: Any


def rows(run: str) -> list[Row]:
    """Of one run, by time."""
    found = []
    for row in table("nasa_states"):
        name, *values = row.values()
        if name == run:
            x = np.array([float(value) for value in values])
            found.append(Row(x[0], x[1:4], x[4:7], x[7:10], x[10:].reshape(3, 3)))
    return found


def simulate(run: str, flown: Flown | None = None, duration: float = HOURS_8) -> oo.Trace:
    """A run, or ``flown`` with its start where the table has one."""
    flown = flown or RUNS[run]
    rate, attitude = flown.rate, pitched(flown.orbit, flown.pitch or 0.0)
    if flown.pitch is None:
        rate, attitude = rows(run)[0].rate, rows(run)[0].attitude
    q = np.concatenate([np.zeros(3), quaternion_from_matrix(attitude.T)])
    return oo.Simulation(
        flown.model(), q, np.concatenate([np.zeros(3), rate]),
        orbit=oo.Kepler.from_state(*flown.orbit, mu=MU), earth=flown.earth(),
        environment=flown.environment(), time_step=1.0, record_every=60,
    ).run(duration)  # fmt: skip


def off(run: str, flown: Flown | None = None) -> Any:
    """Largest errors over the rows, of six runs the end alone: m, m/s, rad/s by component, degrees."""
    trace = simulate(run, flown)
    assert trace.position_eci is not None and trace.velocity_eci is not None
    errors = []
    for row in rows(run):
        k = int(np.searchsorted(trace.time, row.time))
        turned = angle_between(trace.q[k, 3:7], quaternion_from_matrix(row.attitude.T))
        errors.append((
            np.linalg.norm(trace.position_eci[k] - row.position),
            np.linalg.norm(trace.velocity_eci[k] - row.velocity),
            np.abs(trace.v[k, 3:6] - row.rate).max(),
            np.degrees(turned),
        ))  # fmt: skip
    return worst(errors)


def gates(flown: Flown) -> tuple[Gate, ...]:
    """Those of the project's validation data; 3A's are what NASA's own simulators differ by."""
    velocity = 1e-7 if flown.position_gate < 1.0 else 1.5e-3
    return (
        Gate("position", flown.position_gate, "m"), Gate("velocity", velocity, "m/s"),
        Gate("rate", 1e-12, "rad/s"), Gate("attitude", 1e-7, "deg"),
    )  # fmt: skip


# rad/s², body axes, after 8 h
GRADIENT = {
    "10A": [0.0, 1.243056784774573e-07, 4.58638231464994e-08],
    "10C": [0.0, 9.285032588060049e-08, 2.393403219339611e-08],
}


def gradient(run: str) -> tuple[float]:
    """Largest error of the angular acceleration by gravity's gradient in NASA's state after 8 h, rad/s²."""
    end, q, v = rows(run)[-1], np.zeros(7), np.zeros(6)
    q[3:], v[3:] = quaternion_from_matrix(end.attitude.T), end.rate
    trace = oo.Simulation(
        cylinder(), q, v, orbit=oo.Kepler.from_state(end.position, end.velocity, mu=MU),
        environment=[oo.GravityGradient()], time_step=1.0,
    ).run(1.0)  # fmt: skip
    return (float(np.abs(trace.acceleration[0, 3:] - GRADIENT[run]).max()),)


CASES = (
    *(
        Case("nasa", f"run {run}: {flown.what}", SOURCE, gates(flown), partial(off, run))
        for run, flown in RUNS.items()
    ),
    *(
        Case(
            "nasa", f"run {run}: the torque of the gradient after 8 h", SOURCE,
            (Gate("angular acceleration", 3e-20, "rad/s2"),), partial(gradient, run),
        )
        for run in GRADIENT
    ),
)  # fmt: skip
