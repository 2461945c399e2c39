"""Gravity fields from the fully normalised coefficients in ``.csv`` files of this folder."""

from __future__ import annotations

import numpy as np

import onorbit_rs as oo
from onorbit_rs.tools.validation.case import table

MU, RADIUS = 3.986004415e14, 6_378_136.3
"""Gravitational parameter, m³/s², and radius, m, which are the same for GGM02C, JGM-3 and EGM96."""


def field(name: str, degree: int, order: int | None = None) -> oo.GravityField:
    """Return a gravity field up to a degree and an order.

    ``ggm02c`` (Center for Space Research, University of Texas, 2004): degree 8, zero-tide. ``jgm3`` (Tapley
    and others, 1996): degree 12, tide-free as in GMAT. The bundled field from ICGEM includes the permanent
    tide: its C20 differs by 4.17e-9.
    """
    c, s = np.zeros((degree + 1, degree + 1)), np.zeros((degree + 1, degree + 1))
    for row in table(name):
        n, m = int(row["n"]), int(row["m"])
        if n <= degree and m <= (degree if order is None else order):
            c[n, m], s[n, m] = float(row["C"]), float(row["S"])
    return oo.GravityField.from_coefficients(c, s, mu=MU, radius=RADIUS)
