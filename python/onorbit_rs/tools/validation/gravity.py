"""Compares the gravity field, the Sun and the Moon over one or two days with GMAT and MONTE."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

import onorbit_rs as oo
from onorbit_rs.tools.validation.case import Case, Gate
from onorbit_rs.tools.validation.fields import MU, RADIUS, field

ARCSECOND = np.pi / 648_000.0
DAY = 86_400.0

# GMAT and MONTE, one day from 2000-01-01T12:00:00 TAI, quoted by nyx's tests; UT1 and pole: IERS EOP C04
LEO = (np.array([-2436.45, -2436.45, 6891.037]) * 1e3, np.array([5.088611, -5.088611, 0.0]) * 1e3)
GMAT_12 = np.array([-5751.935197673059, 4719.330857046409, 2048.776230999391]) * 1e3
GMAT_J2 = np.array([-5751.473991327555, 4721.214035135832, 2045.947768608806]) * 1e3
MONTE_J2 = np.array([-5751.472565170783, 4721.183256208691, 2046.020865167045]) * 1e3
MONTE_MU, MONTE_C20 = 3.986004328969392e14, -0.000484169325971
NYX = "via nyx-space/nyx, tests"


def earth_2000() -> oo.Earth:
    """Return the Earth with the epoch, UT1 and pole of the cases that last one day."""
    pole = (0.0433 * ARCSECOND, 0.3778 * ARCSECOND)
    return oo.Earth("2000-01-01T12:00:00 TAI", ut1_minus_utc=0.3554, polar_motion=pole)


def after_a_day(field: oo.GravityField, earth: oo.Earth, mu: float = MU) -> Any:
    """Return the inertial position (3,) after one day, m."""
    return oo.Numerical(*LEO, environment=[field], earth=earth, mu=mu).state(DAY)[0]


def gmat_jgm3(degree: int, order: int, expected: Any) -> tuple[float]:
    """Return the distance from GMAT's position, m; its cause is GMAT's nutation model of 1980."""
    return (float(np.linalg.norm(after_a_day(field("jgm3", degree, order), earth_2000()) - expected)),)


def monte_j2() -> tuple[float]:
    """Return the distance from MONTE's position, m, with the pole of J2000.

    The source does not state the radius of the Earth; :data:`RADIUS` is used.
    """
    zonal = oo.GravityField.zonal(j=[-MONTE_C20 * np.sqrt(5.0)], mu=MONTE_MU, radius=RADIUS)
    reached = after_a_day(zonal, oo.Earth(rotation="about_z"), MONTE_MU)
    return (float(np.linalg.norm(reached - MONTE_J2)),)


# GMAT R2026A, EarthICRF, DE440: ssmichael1/satkit, tests/gmat/cases/leo_iss_j2.json at 482e601; km, km/s
ISS_EPOCH = "2023-05-16T20:00:00 UTC"
ISS_START = (
    [-2103.715480048485, 3643.742096113128, 5308.456731666616],
    [-6.647330004445162, -3.833624329580398, 0.004603821856452621],
)
ISS_POSITIONS = {
    3600.0: [5961.751559867882, 489.7145394186537, -3201.141734168868],
    28_800.0: [-6269.500008059543, -1435.129407012806, 2160.714693192816],
    86_400.0: [3561.075822361122, -2775.245017796639, -5070.861126310758],
    172_800.0: [-4886.431468822935, 1860.531613483262, 4312.704276029334],
}
# EGM96, NASA/TP-1998-206861; C20 tide-free
EGM96_C2 = [-0.484165371736e-3, -0.186987635955e-9, 0.243914352398e-5]
EGM96_S2 = [0.0, 0.119528012031e-8, -0.140016683654e-5]


def egm96() -> oo.GravityField:
    """Return the gravity field EGM96 up to degree and order 2."""
    c, s = np.zeros((3, 3)), np.zeros((3, 3))
    c[2], s[2] = EGM96_C2, EGM96_S2
    return oo.GravityField.from_coefficients(c, s, mu=MU, radius=RADIUS)


def sun_and_moon(bodies: tuple[str, ...] = ("sun", "moon")) -> tuple[float]:
    """Return the largest distance from GMAT's positions, m, with UT1 and polar motion of the IERS."""
    pole = np.array([0.0463, 0.4939]) * ARCSECOND
    earth = oo.Earth(ISS_EPOCH, ut1_minus_utc=-0.0446, polar_motion=pole)
    r, v = (np.array(x) * 1e3 for x in ISS_START)
    environment = [egm96(), *(oo.ThirdBody(body) for body in bodies)]  # type: ignore[arg-type]
    ours, _ = oo.Numerical(r, v, environment=environment, earth=earth).state(np.array(list(ISS_POSITIONS)))
    return (float(np.linalg.norm(ours - np.array(list(ISS_POSITIONS.values())) * 1e3, axis=1).max()),)


CASES = (
    Case(
        "gravity", "JGM-3 of degree 12, one day", f"GMAT, {NYX} (nyx agrees to 4 m)",
        (Gate("position", 0.5, "m"),), partial(gmat_jgm3, 12, 12, GMAT_12),
    ),
    Case(
        "gravity", "J2 of JGM-3 about the pole of date, one day", f"GMAT, {NYX}",
        (Gate("position", 0.5, "m"),), partial(gmat_jgm3, 2, 0, GMAT_J2),
    ),
    Case(
        "gravity", "J2 about the pole of J2000, one day", f"MONTE, {NYX} (to 20 m; the radius is not stated)",
        (Gate("position", 20.0, "m"),), monte_j2,
    ),
    Case(
        "gravity", "EGM96 of degree 2, Sun and Moon, two days", "GMAT R2026A, via satkit, tests",
        (Gate("position", 0.2, "m"),), sun_and_moon,
    ),
)  # fmt: skip
