"""Compares effects of zonal harmonics on orbital elements with results of Curtis and of Qi and others."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

import onorbit_rs as oo
from onorbit_rs.tools.validation.case import Case, Gate

# Curtis, Orbital Mechanics for Engineering Students, example 12.2: 48 h with J2
CURTIS_MU, CURTIS_J2, CURTIS_RADIUS = 398600e9, 1.08263e-3, 6378e3
CURTIS_STATE = (
    np.array([-2384.46, 5729.01, 3050.46]) * 1e3,
    np.array([-7.36138, -2.98997, 1.64354]) * 1e3,
)
NODE, PERIAPSIS = -0.172, 0.282  # deg/h
HOURS = 48.0

# Qi and others, AEAT-03-2015-0092 (2018): largest differences in ten days of inclination and eccentricity
QI_MU, QI_RADIUS = 3.986004418e14, 6378136.6
QI_J2, QI_J3 = 1.0826359e-3, -2.53265648e-6
QI = {
    0.2618: (3.411e-05, 3.549e-05),
    0.7854: (2.751e-05, 9.243e-05),
    1.3090: (7.9e-06, 1.002e-04),
    1.5708: (0.0, 1.704e-04),
}


def elements(r: Any, v: Any, mu: float) -> Any:
    """Return the eccentricity and, in rad, inclination, node and argument of periapsis, (T, 4), of states.

    The states are positions ``r``, m, and velocities ``v``, m/s, (T, 3) each.
    """
    h = np.cross(r, v)
    size = np.linalg.norm(h, axis=-1)
    e = np.cross(v, h) / mu - r / np.linalg.norm(r, axis=-1)[:, None]
    node = np.stack([-h[:, 1], h[:, 0], 0.0 * size], axis=-1)
    across = np.cross(h, node) / size[:, None]
    periapsis = np.arctan2(np.sum(e * across, axis=-1), np.sum(e * node, axis=-1))
    raan = np.arctan2(node[:, 1], node[:, 0])
    return np.stack([np.linalg.norm(e, axis=-1), np.arccos(h[:, 2] / size), raan, periapsis], axis=-1)


def curtis() -> tuple[float, float]:
    """Return the relative errors of the drift rates of the node and the periapsis."""
    field = oo.GravityField.zonal(j=[CURTIS_J2], mu=CURTIS_MU, radius=CURTIS_RADIUS)
    orbit = oo.Numerical(*CURTIS_STATE, environment=[field], mu=CURTIS_MU)
    ends = elements(*orbit.state(np.array([0.0, HOURS * 3600.0])), CURTIS_MU)[:, 2:]
    turned = (np.degrees(ends[1] - ends[0]) + 180.0) % 360.0 - 180.0
    node, periapsis = turned / HOURS
    return abs(node / NODE - 1.0), abs(periapsis / PERIAPSIS - 1.0)


def j3(inclination: float) -> tuple[float, float]:
    """Return the errors of the largest changes of eccentricity and of inclination, rad, by J3 in ten days."""
    kepler = oo.Kepler(
        semi_major_axis=8970.667e3, eccentricity=0.25, inclination=inclination, raan=1.047,
        argument_of_periapsis=1.0, true_anomaly=0.0, mu=QI_MU,
    )  # fmt: skip
    times = np.linspace(0.0, 10 * 86_400.0, 1000)
    both = []
    for j in ([QI_J2], [QI_J2, QI_J3]):
        field = oo.GravityField.zonal(j=j, mu=QI_MU, radius=QI_RADIUS)
        both.append(
            elements(*oo.Numerical.from_orbit(kepler, environment=[field]).state(times), QI_MU)[:, :2]
        )
    e, i = np.abs(both[1] - both[0]).max(axis=0)
    i_expected, e_expected = QI[inclination]
    return abs(e - e_expected), abs(i - i_expected)


def j3_gates(inclination: float) -> tuple[Gate, ...]:
    """Return the gates: 10 % of the published changes, as in poliastro's tests, plus 1e-7 for rounding."""
    i, e = QI[inclination]
    return (Gate("eccentricity", 0.1 * e + 1e-7), Gate("inclination", 0.1 * i + 1e-7, "rad"))


CASES = (
    Case(
        "gravity", "node and periapsis under J2, 48 h", "Curtis, Orbital Mechanics, example 12.2",
        (Gate("rate of the node", 0.01), Gate("rate of the periapsis", 0.01)), curtis,
    ),
    *(
        Case(
            "gravity", f"effect of J3 in ten days, inclination {np.degrees(inclination):.0f} deg",
            "Qi and others, AEAT-03-2015-0092, 2018, to 10 % (poliastro, tests)",
            j3_gates(inclination), partial(j3, inclination),
        )
        for inclination in QI
    ),
)  # fmt: skip
