"""What pictures know of the planet: whether it is the Earth, and the Earth's figure."""

from __future__ import annotations

from onorbit_rs._core import MU_EARTH

EARTH_RADIUS_KM, EARTH_FLATTENING = 6378.137, 1.0 / 298.257
"""Equatorial radius and flattening, WGS84 (to what a picture shows)."""


def is_earth(mu: float | None) -> bool:
    """Whether a planet of this ``mu``, m³/s², is the Earth: to 1 %, as a rounded 4e14 and in the engine."""
    return mu is not None and abs(mu / MU_EARTH - 1.0) < 1e-2
