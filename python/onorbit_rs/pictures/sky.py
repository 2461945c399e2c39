"""Background of a picture: stars, and the Earth with its day and night side."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs.visuals.earth_shape import EARTH_FLATTENING, EARTH_RADIUS_KM
from onorbit_rs.visuals.land import ice_fraction, land_fraction

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs.pictures.camera import Camera

    Floats = NDArray[np.float64]

SPACE = np.array([5.0, 6.0, 11.0]) / 255.0
STARS = 4000
"""Number of stars on the whole sphere. Their directions are random and fixed; they are not a catalogue."""

_SEA, _LAND, _ICE = (np.array(rgb) / 255.0 for rgb in ((24, 62, 118), (92, 112, 72), (225, 231, 236)))
_AIR = np.array([125.0, 175.0, 240.0]) / 255.0
_NIGHT = np.array([6.0, 10.0, 22.0]) / 255.0
AIR_HEIGHT = 0.0035
"""Height over which the brightness of the air falls by a factor of e, in radii of the Earth."""
_ROWS = 64


@dataclass(frozen=True)
class Sky:
    """Surroundings of a robot on an orbit.

    Attributes
    ----------
    rot_is : (3, 3) array
        Rotation from axes of the scene to inertial axes.
    place : (3,) array or None
        Position of the scene's origin relative to the Earth's centre, inertial axes, m; None without Earth.
    rot_ei : (3, 3) array or None
        Rotation from inertial to Earth-fixed axes; None draws no continents.
    sun : (3,) array
        Unit vector to the Sun, inertial axes.
    """

    rot_is: Floats
    place: Floats | None
    rot_ei: Floats | None
    sun: Floats

    def paint(self, camera: Camera) -> Floats:
        """Return the colours (height, width, 3), 0 to 1, of the background."""
        image = np.broadcast_to(SPACE, (camera.height, camera.width, 3)).copy()
        _add_stars(image, camera, self.rot_is)
        if self.place is not None:
            for start in range(0, camera.height, _ROWS):
                rows = np.arange(start, min(start + _ROWS, camera.height))
                self._add_earth(image[rows[0] : rows[-1] + 1], camera, rows)
        return image

    def is_eclipsed(self) -> bool:
        """Return True if the scene is in the shadow of the Earth, which is taken as a cylinder."""
        if self.place is None:
            return False
        height = float(self.place @ self.sun)
        return height < 0.0 and float(np.linalg.norm(self.place - height * self.sun)) < 1e3 * EARTH_RADIUS_KM

    def _add_earth(self, image: Floats, camera: Camera, rows: NDArray[np.int64]) -> None:
        """Draw the Earth and its air into some rows of the picture."""
        assert self.place is not None
        to_sphere = np.array([1.0, 1.0, 1.0 / (1.0 - EARTH_FLATTENING)]) / (1e3 * EARTH_RADIUS_KM)
        eye = (self.place + self.rot_is @ camera.position) * to_sphere
        ray = (camera.rays(rows) @ self.rot_is.T) * to_sphere
        # |eye + s ray|² = 1 on the ground
        a, b = np.einsum("...i,...i->...", ray, ray), ray @ eye
        nearest = np.sqrt(np.maximum(eye @ eye - b**2 / a, 0.0))
        is_ahead = b < 0.0
        is_ground = is_ahead & (nearest < 1.0)
        s = (-b - np.sqrt(np.maximum(b**2 - a * (eye @ eye - 1.0), 0.0))) / a
        point = eye + np.where(is_ground, s, -b / a)[..., None] * ray
        normal = point / np.linalg.norm(point, axis=-1, keepdims=True)
        day = _smooth((normal @ self.sun + 0.12) / 0.3)[..., None]
        slant = 1.0 - np.abs(np.einsum("...i,...i->...", normal, ray)) / np.sqrt(a)
        haze = (0.15 + 0.85 * slant**4)[..., None] * day
        ground = self._ground(normal) * (0.25 + 0.75 * (normal @ self.sun).clip(0.0, 1.0))[..., None]
        surface = (1.0 - day) * _NIGHT + day * ground
        surface += 0.75 * haze * (_AIR - surface)
        image[is_ground] = surface[is_ground]
        is_air = is_ahead & ~is_ground
        glow = np.exp(-np.maximum(nearest - 1.0, 0.0) / AIR_HEIGHT)[..., None] * (0.04 + 0.96 * day)
        image[is_air] += (0.75 * glow * (_AIR - image))[is_air]

    def _ground(self, normal: Floats) -> Floats:
        """Return the colour of sea, land and ice at unit vectors (..., 3) in inertial axes."""
        if self.rot_ei is None:
            return np.broadcast_to(_SEA, normal.shape)
        x, y, z = np.moveaxis(normal @ self.rot_ei.T, -1, 0)
        latitude, longitude = np.degrees(np.arcsin(z.clip(-1.0, 1.0))), np.degrees(np.arctan2(y, x))
        share = _smooth((land_fraction(latitude, longitude) - 0.42) / 0.16)[..., None]
        sea, land = (
            color + _smooth(ice_fraction(latitude, longitude, is_land=is_land))[..., None] * (_ICE - color)
            for color, is_land in ((_SEA, False), (_LAND, True))
        )
        return (1.0 - share) * sea + share * land


def _smooth(x: Floats) -> Floats:
    """Return a smooth step from 0 at ``x = 0`` to 1 at ``x = 1``."""
    x = x.clip(0.0, 1.0)
    step: Floats = x * x * (3.0 - 2.0 * x)
    return step


@cache
def _stars() -> tuple[Floats, Floats]:
    """Return the directions (n, 3), inertial axes, and brightnesses (n,), up to 1, of the stars."""
    random = np.random.default_rng(1)
    direction = random.normal(size=(STARS, 3))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    # the number of stars that are brighter than b is proportional to b^-1.5
    brightness = 0.12 * (1.0 - random.random(STARS)) ** (-1.0 / 1.5)
    return direction, brightness.clip(0.0, 1.0)


def _add_stars(image: Floats, camera: Camera, rot_is: Floats) -> None:
    """Draw stars as spots of Gaussian brightness; brighter stars are larger, up to five by five pixels."""
    direction, brightness = _stars()
    # stars have no parallax: the camera is moved to the origin
    pixels = camera.project(camera.position + direction @ rot_is)
    seen = (pixels[:, 2] > 0.0) & (pixels[:, :2] > 3.0).all(axis=1)
    seen &= (pixels[:, 0] < camera.width - 4) & (pixels[:, 1] < camera.height - 4)
    for (x, y, _), light in zip(pixels[seen], brightness[seen], strict=True):
        column, row = int(x), int(y)
        apart = np.hypot(
            np.arange(row - 2, row + 3)[:, None] + 0.5 - y, np.arange(column - 2, column + 3) + 0.5 - x
        )
        spot = (light * np.exp(-((apart / (0.5 + 0.6 * light)) ** 2)))[..., None]
        part = image[row - 2 : row + 3, column - 2 : column + 3]
        part += spot * (1.0 - part)
