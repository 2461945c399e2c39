"""Compares two-body motion with textbooks and GMAT, in the units of the sources, km and km/s."""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

import numpy as np

import onorbit_rs as oo
from onorbit_rs.tools.validation.case import Case, Gate


class Flight(NamedTuple):
    """Motion from ``r0, v0`` to ``r, v`` in ``dt``; km, km/s, s, ``mu`` in km³/s²; precision in m and m/s."""

    source: str
    mu: float
    dt: float
    r0: tuple[float, ...]
    v0: tuple[float, ...]
    r: tuple[float, ...]
    v: tuple[float, ...]
    within_m: float
    within_m_s: float


# fmt: off
FLIGHTS = {
    "an ellipse, 40 min": Flight(
        "Vallado, Fundamentals of Astrodynamics, example 2-4, printed to 1e-4 km",
        398600.4418, 2400.0, (1131.340, -2282.343, 6672.423), (-5.64305, 4.30333, 2.42879),
        (-4219.7527, 4363.0292, -3958.7666), (3.689866, -1.916735, -6.112511), 0.1, 1e-3,
    ),
    "an ellipse, 2 min": Flight(
        "CelesTrak/fundamentals-of-astrodynamics, tests in Python",
        398600.4415, 120.0, (-6518.1083, -2403.8479, -22.1722), (2.604057, -7.105717, -0.263218),
        (-6150.8180772417, -3233.5647020192746, -53.47890911642744),
        (3.5085906394995146, -6.703227854017405, -0.2578170063354219), 1e-6, 1e-8,
    ),
    "an ellipse, one hour": Flight(
        "Curtis, Orbital Mechanics, example 3.7, recomputed to seven digits",
        398600.0, 3600.0, (7000.0, -12124.0, 0.0), (2.6679, 4.6210, 0.0),
        (-3297.7686, 7413.3966, 0.0), (-8.2976030, -0.9640449, 0.0), 0.1, 1e-3,
    ),
    "a low orbit, one day": Flight(
        "GMAT, via nyx-space/nyx; 4e-9 km from the exact solution",
        398600.4415, 86400.0, (-2436.45, -2436.45, 6891.037), (5.088611, -5.088611, 0.0),
        (-5971.194191670676, 3945.506653225158, 2864.6366184134445),
        (0.04909695762999346, -4.185093318475795, 5.848940867748944), 1e-5, 1e-7,
    ),
}
# fmt: on


def fly(name: str) -> tuple[float, float]:
    """Return the largest components of the error in position and velocity, m and m/s."""
    flight = FLIGHTS[name]
    r0, v0 = np.array(flight.r0) * 1e3, np.array(flight.v0) * 1e3
    r, v = oo.Kepler.from_state(r0, v0, mu=flight.mu * 1e9).state(flight.dt)
    return np.abs(r - np.array(flight.r) * 1e3).max(), np.abs(v - np.array(flight.v) * 1e3).max()


HYPERBOLA_MU = 3.986e14  # m³/s², Curtis


def hyperbola() -> tuple[float, float]:
    """Return the relative errors of distance and speed long after periapsis."""
    orbit = oo.Kepler.from_state([6678137.0, 0, 0], [0, 15000.0, 0], mu=HYPERBOLA_MU)
    r, v = orbit.state(14941.0)
    return abs(float(np.linalg.norm(r)) / 163180e3 - 1.0), abs(float(np.linalg.norm(v)) / 10.51e3 - 1.0)


def hyperbola_by_elements() -> tuple[float, float]:
    """Return the errors of the state computed from orbital elements, m and m/s."""
    # h = 80000 km²/s, e = 1.4: p = h²/μ
    orbit = oo.Kepler(
        semi_latus_rectum=(80000e6) ** 2 / HYPERBOLA_MU, eccentricity=1.4, inclination=np.radians(30),
        raan=np.radians(40), argument_of_periapsis=np.radians(60), true_anomaly=np.radians(30),
        mu=HYPERBOLA_MU,
    )  # fmt: skip
    r, v = orbit.state(0.0)
    r_off = r - np.array([-4039.8959232, 4814.5604802, 3628.6247022]) * 1e3
    v_off = v - np.array([-10.3859876, -4.7719216, 1.7438750]) * 1e3
    return np.abs(r_off).max(), np.abs(v_off).max()


CASES = (
    *(
        Case(
            "kepler", name, flight.source,
            (Gate("position", flight.within_m, "m"), Gate("velocity", flight.within_m_s, "m/s")),
            partial(fly, name),
        )
        for name, flight in FLIGHTS.items()
    ),
    Case(
        "kepler", "a hyperbola, 4 h", "Curtis, Orbital Mechanics, example 3.5",
        (Gate("distance", 1e-4), Gate("speed", 1e-3)), hyperbola,
    ),
    Case(
        "kepler", "a hyperbola by its elements",
        "Curtis, Orbital Mechanics, example 4.7, recomputed to eight digits",
        (Gate("position", 1e-4, "m"), Gate("velocity", 1e-4, "m/s")), hyperbola_by_elements,
    ),
)  # fmt: skip
