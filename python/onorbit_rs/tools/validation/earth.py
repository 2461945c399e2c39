"""Compares the rotation from celestial to terrestrial axes with IAU SOFA."""

from __future__ import annotations

import numpy as np

import onorbit_rs as oo
from onorbit_rs.tools.validation.case import Case, Gate

ARCSECOND = np.pi / 648_000.0
EPOCH, UT1_MINUS_UTC = "2007-04-05T12:00:00 UTC", -0.072073685
POLE = (0.0349282 * ARCSECOND, 0.4833163 * ARCSECOND)
# celestial to terrestrial, IAU 2006/2000A by the CIO; includes dX = 0.175, dY = -0.226 mas, neglected here
SOFA = np.array(
    [
        [+0.973104317697536, +0.230363826239128, -0.000703163481769],
        [-0.230363800456036, +0.973104570632801, +0.000118545368117],
        [+0.000711560162594, +0.000046626402444, +0.999999745754024],
    ]
)


def orientation() -> tuple[float]:
    """Return the angle between the computed and the published orientation, arcseconds."""
    earth = oo.Earth(EPOCH, ut1_minus_utc=UT1_MINUS_UTC, polar_motion=POLE)
    off = earth.rotation(0.0) @ SOFA.T
    axis = np.array([off[2, 1] - off[1, 2], off[0, 2] - off[2, 0], off[1, 0] - off[0, 1]]) / 2.0
    return (float(np.linalg.norm(axis)) / ARCSECOND,)


CASES = (
    Case(
        "earth", "celestial to terrestrial axes, 2007-04-05",
        "IAU SOFA, Tools for Earth Attitude, IAU 2006/2000A",
        (Gate("orientation", 5e-3, "arcsec"),), orientation,
    ),
)  # fmt: skip
