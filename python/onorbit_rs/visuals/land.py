"""Map of land on a grid of half a degree, and a texture of the Earth made from this map.

``land_half_degree.bin`` contains one bit per cell, row by row, compressed with zlib. It is computed with
PyPI's `global-land-mask` 1.0.0 from the 30 arc second GLOBE elevation model (NOAA, 1999, public domain): a
cell is land if more than half of its 3600 points are land.
"""

from __future__ import annotations

import zlib
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

_CELLS = (360, 720)
_FILE = Path(__file__).with_name("land_half_degree.bin")
_SEA, _LAND, _ICE = (np.array(rgb) for rgb in ((38, 86, 140), (86, 128, 82), (226, 232, 236)))

_CASPIAN = (
    (36.6, 51.0, 53.9), (37.6, 49.1, 53.9), (39.0, 48.9, 53.3), (40.2, 49.8, 53.4), (41.5, 49.0, 52.8),
    (42.5, 48.0, 52.5), (43.5, 47.5, 51.0), (44.6, 47.2, 51.1), (45.3, 47.4, 53.0), (46.9, 50.0, 53.0),
)  # fmt: skip
"""Latitudes, and longitudes of the western and the eastern shore, degrees."""
_LAKES = (
    (47.6, -87.7, 0.9, 4.0), (43.8, -87.0, 2.1, 0.8), (44.7, -82.3, 1.3, 1.4), (42.2, -81.2, 0.5, 2.0),
    (43.6, -77.9, 0.4, 1.6), (-1.0, 33.0, 1.5, 1.3), (-6.2, 29.6, 2.5, 0.35), (60.8, 31.5, 0.9, 0.9),
)  # fmt: skip
"""Ellipses for the largest lakes: latitude and longitude of the centre, half of the extents, degrees."""
_GREENLAND = (
    (59.8, -45.0, -43.0), (63.0, -50.5, -41.5), (66.0, -52.0, -36.0), (69.0, -51.0, -25.0),
    (72.0, -54.5, -24.0), (76.0, -67.0, -20.5), (79.0, -66.0, -18.5), (82.5, -50.0, -24.0),
    (83.6, -38.0, -30.0),
)  # fmt: skip
"""Latitudes, and longitudes of the western and the eastern coast, degrees."""


@cache
def land() -> NDArray[np.bool_]:
    """Return cells (360, 720), True on land, from north to south and from -180° of longitude eastwards."""
    bits = np.frombuffer(zlib.decompress(_FILE.read_bytes()), np.uint8)
    return np.unpackbits(bits).reshape(_CELLS).astype(bool) & ~_lakes()


def _lakes() -> NDArray[np.bool_]:
    """Return cells (360, 720), True in the largest lakes, which are land in the elevation model."""
    latitude, longitude = (degrees[np.newaxis] for degrees in centers())
    is_lake = _between(latitude.T, longitude, _CASPIAN) > 0.0
    for north, east, half_height, half_width in _LAKES:
        is_lake |= ((latitude.T - north) / half_height) ** 2 + ((longitude - east) / half_width) ** 2 < 1.0
    return is_lake


def _between(latitude_deg: Floats, longitude_deg: Floats, shores: Any) -> Floats:
    """Return the distance, degrees of longitude, from the nearer of two shores; negative outside of them."""
    rows, west, east = np.array(shores).T
    inside = np.minimum(
        longitude_deg - np.interp(latitude_deg, rows, west),
        np.interp(latitude_deg, rows, east) - longitude_deg,
    )
    distance: Floats = np.where((latitude_deg > rows[0]) & (latitude_deg < rows[-1]), inside, -np.inf)
    return distance


def ice_fraction(latitude_deg: Floats, longitude_deg: Floats, *, is_land: bool) -> Floats:
    """Return how much ice covers land or sea at points, 0 to 1: ice sheets, the high Arctic, ice shelves."""
    antarctic, arctic = (60.0, 80.0) if is_land else (74.0, 80.0)
    polar = np.maximum((-latitude_deg - antarctic) / 3.0, (latitude_deg - arctic) / 4.0 + 0.5)
    if is_land:
        polar = np.maximum(polar, _between(latitude_deg, longitude_deg, _GREENLAND) / 4.0)
    covered: Floats = polar.clip(0.0, 1.0)
    return covered


def centers() -> tuple[Floats, Floats]:
    """Return the latitudes (360,) and the longitudes (720,) of the centres of the cells, degrees."""
    rows, columns = _CELLS
    return 90.0 - 180.0 * (np.arange(rows) + 0.5) / rows, -180.0 + 360.0 * (
        np.arange(columns) + 0.5
    ) / columns


@cache
def smooth_land() -> Floats:
    """Return the mean of the land in each cell and the eight cells around it, (360, 720), 0 to 1."""
    cells = np.pad(
        np.pad(land().astype(np.float64), ((1, 1), (0, 0)), mode="edge"), ((0, 0), (1, 1)), mode="wrap"
    )
    rows, columns = _CELLS
    parts = [cells[i : i + rows, j : j + columns] for i in range(3) for j in range(3)]
    fraction: Floats = np.mean(parts, axis=0)
    return fraction


def land_fraction(latitude_deg: Floats, longitude_deg: Floats) -> Floats:
    """Return the fraction of land around points, 0 to 1, interpolated between cells; 0.5 is the coast."""
    rows, columns = _CELLS
    y = ((90.0 - latitude_deg) * rows / 180.0 - 0.5).clip(0.0, rows - 1.0)
    x = (longitude_deg + 180.0) * columns / 360.0 - 0.5
    i, j = np.minimum(y.astype(int), rows - 2), np.floor(x).astype(int)
    down, right = y - i, x - j
    west, east = j % columns, (j + 1) % columns
    share = smooth_land()
    north = (1.0 - right) * share[i, west] + right * share[i, east]
    south = (1.0 - right) * share[i + 1, west] + right * share[i + 1, east]
    found: Floats = (1.0 - down) * north + down * south
    return found


def world_map(has_land: bool, grid_deg: float = 30.0) -> NDArray[np.uint8]:
    """Return an RGB texture (360, 720, 3) of the Earth with grid lines every ``grid_deg`` degrees.

    Without ``has_land``, the whole surface is sea.
    """
    latitude, longitude = centers()
    is_land = land() if has_land else np.zeros(_CELLS, dtype=bool)
    colors = np.where(is_land[..., None], _LAND, _SEA).astype(np.float64)
    if has_land:
        parts = [ice_fraction(latitude[:, None], longitude[None], is_land=kind) for kind in (False, True)]
        colors += np.where(is_land, parts[1], parts[0])[..., None] * (_ICE - colors)
    step = 180.0 / _CELLS[0]
    lines = [np.abs((degrees + 1e-9) % grid_deg) < step for degrees in (latitude, longitude)]
    on_line = lines[0][:, None] | lines[1][None, :]
    colors[on_line] = 0.75 * colors[on_line] + 0.25 * np.array([200, 210, 220])
    return colors.astype(np.uint8)
