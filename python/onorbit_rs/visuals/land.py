"""Map of land on a grid of half a degree, and a texture of the Earth made from this map.

``land_half_degree.bin`` contains one bit per cell, row by row, compressed with zlib. It is computed with
PyPI's `global-land-mask` 1.0.0 from the 30 arc second GLOBE elevation model (NOAA, 1999, public domain): a
cell is land if more than half of its 3600 points are land.
"""

from __future__ import annotations

import zlib
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

_CELLS = (360, 720)
_FILE = Path(__file__).with_name("land_half_degree.bin")
_SEA, _LAND, _ICE = (np.array(rgb) for rgb in ((38, 86, 140), (86, 128, 82), (226, 232, 236)))


@cache
def land() -> NDArray[np.bool_]:
    """Return cells (360, 720), True on land, from north to south and from -180° of longitude eastwards."""
    bits = np.frombuffer(zlib.decompress(_FILE.read_bytes()), np.uint8)
    return np.unpackbits(bits).reshape(_CELLS).astype(bool)


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
    ice = ((np.abs(latitude[:, None]) > 72.0) | (latitude[:, None] < -60.0))[..., None]
    colors = np.where(is_land[..., None], np.where(ice, _ICE, _LAND), _SEA)
    step = 180.0 / _CELLS[0]
    lines = [np.abs((degrees + 1e-9) % grid_deg) < step for degrees in (latitude, longitude)]
    on_line = lines[0][:, None] | lines[1][None, :]
    colors[on_line] = (0.75 * colors[on_line] + 0.25 * np.array([200, 210, 220])).astype(int)
    return colors.astype(np.uint8)
