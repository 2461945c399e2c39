"""A low orbit under EGM96 2×2, Sun and Moon, against GMAT.

Source: ssmichael1/satkit, ``tests/gmat/cases/leo_iss_j2.json`` at 482e601: GMAT R2026A, EarthICRF, DE440.
Its own integration is good to 3 cm there, satkit's gate is 0.1 m over 7 days.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo

EPOCH = "2023-05-16T20:00:00 UTC"
START = (
    [-2103.715480048485, 3643.742096113128, 5308.456731666616],
    [-6.647330004445162, -3.833624329580398, 0.004603821856452621],
)
POSITIONS = {
    3600.0: [5961.751559867882, 489.7145394186537, -3201.141734168868],
    28_800.0: [-6269.500008059543, -1435.129407012806, 2160.714693192816],
    86_400.0: [3561.075822361122, -2775.245017796639, -5070.861126310758],
    172_800.0: [-4886.431468822935, 1860.531613483262, 4312.704276029334],
}
# EGM96, NASA/TP-1998-206861; C20 tide-free
C = np.zeros((3, 3))
S = np.zeros((3, 3))
C[0, 0], C[2] = 1.0, [-0.484165371736e-3, -0.186987635955e-9, 0.243914352398e-5]
S[2] = [0.0, 0.119528012031e-8, -0.140016683654e-5]
FIELD = oo.GravityField.from_coefficients(C, S, mu=398_600.4415e9, radius=6_378_136.3)
BODIES = [oo.ThirdBody("sun"), oo.ThirdBody("moon")]


def off(environment: list[Any]) -> Any:
    """Largest distance from GMAT's positions, m; UT1 and the pole as the IERS has them for these days."""
    earth = oo.Earth(EPOCH, ut1_minus_utc=-0.0446, polar_motion=np.array([0.0463, 0.4939]) * np.pi / 648_000)
    r, v = (np.array(x) * 1e3 for x in START)
    orbit = oo.Numerical(r, v, environment=environment, earth=earth)
    ours, _ = orbit.state(np.array(list(POSITIONS)))
    return np.linalg.norm(ours - np.array(list(POSITIONS.values())) * 1e3, axis=1)


def test_two_days_agree_with_gmat() -> None:
    distance = off([FIELD, *BODIES])
    assert distance.max() < 0.2, distance  # 0.14 m; 6.5 m without the pole


@pytest.mark.parametrize("left", BODIES, ids=repr)
def test_leaving_one_out_is_noticed(left: oo.ThirdBody) -> None:
    others = [body for body in BODIES if body is not left]
    assert off([FIELD, *others]).max() > 2.0
