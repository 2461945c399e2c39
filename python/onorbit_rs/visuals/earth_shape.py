"""Shape of the Earth in figures and the viewer."""

from __future__ import annotations

from onorbit_rs._core import MU_EARTH

EARTH_RADIUS_KM, EARTH_FLATTENING = 6378.137, 1.0 / 298.257
"""Equatorial radius, km, and flattening of WGS84, rounded to the accuracy of a picture."""


def is_earth(mu: float | None) -> bool:
    """Return True if ``mu``, m³/s², equals the Earth's within 1 %, so that rounded values also count."""
    return mu is not None and abs(mu / MU_EARTH - 1.0) < 1e-2
