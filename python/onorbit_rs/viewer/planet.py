"""View of the orbit in km: the planet with day and night, the orbit and the spacecraft."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import rerun as rr

from onorbit_rs.common.decimate import evenly_spaced
from onorbit_rs.common.rotations import quaternion_from_matrix
from onorbit_rs.exceptions import OrbitError
from onorbit_rs.viewer.colors import ROBOT
from onorbit_rs.viewer.frames import ORIGIN, fix_frame, put_in, send_frame
from onorbit_rs.viewer.scene import send_trail
from onorbit_rs.viewer.trace_rows import TIMELINE
from onorbit_rs.visuals.earth_shape import EARTH_FLATTENING, EARTH_RADIUS_KM, is_earth
from onorbit_rs.visuals.land import world_map

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Earth, Orbit
    from onorbit_rs.viewer.setting import Setting
    from onorbit_rs.viewer.trace_rows import TraceRows

    Floats = NDArray[np.float64]

INERTIAL, EARTH, SUN = "I", "earth", "sun"
SUN_PLACE, SUN_ARROW = "sun_place", "sun_arrow"
MEAN_DENSITY = 5.0e3
"""Assumed mean density of a planet other than the Earth, kg/m³, from which its radius is computed."""

MOST_TURNS = 2000
"""Largest number of rows at which the Earth's attitude is recorded."""

_ABOVE = 1.35
"""Distance of the Sun's arrow from the planet's centre on the screen, in radii of the orbit."""

_GRAVITATION = 6.6743e-11
_MOST_PATH_POINTS = 20_000
_PATH, _RING = (255, 96, 64), (150, 155, 165)


def log_planet(recording: rr.RecordingStream, rows: TraceRows, setting: Setting) -> None:
    """Log the static entities: the planet, one revolution of the reference orbit, and the Sun's arrow."""
    orbit = setting.orbit
    put_in(recording, "orbit", INERTIAL)
    if orbit is None or orbit.mu is None:
        return
    about_earth = is_earth(orbit.mu)
    turns = about_earth and setting.earth is not None
    radius = EARTH_RADIUS_KM if about_earth else _radius_km(orbit.mu, rows)
    flat = np.array([1.0, 1.0, 1.0 - EARTH_FLATTENING if about_earth else 1.0])
    put_in(recording, "orbit/planet", EARTH if turns else INERTIAL)
    recording.log("orbit/planet", _globe(radius * flat, has_land=turns), static=True, strict=True)
    if shows_sun(setting):
        for index, (depth, height) in enumerate(((-0.05, 1.004), (0.0, 1.006), (0.05, 1.008))):
            path = f"orbit/night/{index}"
            put_in(recording, path, SUN)
            recording.log(path, _night(radius * height * flat, depth), static=True, strict=True)
        put_in(recording, "orbit/sun", SUN_ARROW)
        far = max(radius, float(np.linalg.norm(rows["position_eci"], axis=1).max()) / 1e3)
        place, eye = np.eye(4), to_eye(rows, setting)
        up = np.array([0.0, 0.0, 1.0]) - eye[2] * eye
        place[:3, 3] = _ABOVE * far * up / np.linalg.norm(up)
        fix_frame(recording, INERTIAL, SUN_PLACE, place)
        arrow = rr.Arrows3D(
            vectors=[[0.5 * far, 0.0, 0.0]], origins=[[-0.25 * far, 0.0, 0.0]], radii=[far / 70.0],
            colors=[(255, 225, 90)],
        )  # fmt: skip
        recording.log("orbit/sun", arrow, static=True, strict=True)
    ring = path_around_planet(orbit)
    if ring is not None:
        line = rr.LineStrips3D([ring / 1e3], colors=[_RING], radii=rr.Radius.ui_points(1.0))
        recording.log("orbit/reference", line, static=True, strict=True)
        put_in(recording, "orbit/reference", INERTIAL)


def to_eye(rows: TraceRows, setting: Setting) -> Floats:
    """Return the unit vector from the centre of the planet to the camera.

    The camera is above the side of the planet on which the run starts. If the direction to the Sun is known,
    most of the component in that direction is removed, so that about half of the visible disc is lit. A
    camera near a pole is moved to 60° latitude, because north could not be up on the screen.
    """
    start = rows["position_eci"][0] / np.linalg.norm(rows["position_eci"][0])
    towards: Floats = start + [0.0, 0.0, 0.5] + 0.6 * np.cross([0.0, 0.0, 1.0], start)
    if setting.earth is not None and has_sun(setting.earth):
        sun = np.asarray(setting.earth.sun(0.0)).reshape(3)
        towards -= 0.9 * (towards @ sun) / (sun @ sun) * sun
    towards /= np.linalg.norm(towards)
    over_pole = abs(towards[2]) > 0.98  # here north is not up on the screen
    return np.array([0.5, 0.0, math.copysign(math.sqrt(0.75), towards[2])]) if over_pole else towards


def shows_sun(setting: Setting) -> bool:
    """Return True if the night side and the arrow to the Sun are shown."""
    orbit = setting.orbit
    return orbit is not None and orbit.mu is not None and is_earth(orbit.mu) and has_sun(setting.earth)


def has_sun(earth: Earth | None) -> bool:
    """Return True if the position of the Sun is known."""
    return earth is not None and earth.epoch is not None


def send_planet(recording: rr.RecordingStream, rows: TraceRows, setting: Setting) -> None:
    """Send the rotation of the Earth and of its night side; do nothing without an Earth or a planet."""
    earth = setting.earth
    if earth is None or setting.orbit is None or setting.orbit.mu is None:
        return
    t = rows["time"]
    t = t[evenly_spaced(len(t), MOST_TURNS)]
    rot_fi = np.asarray(earth.rotation(t)).reshape(-1, 3, 3)
    quat_if = quaternion_from_matrix(np.swapaxes(rot_fi, 1, 2))
    times = rr.TimeColumn(TIMELINE, duration=t)
    send_frame(recording, times, INERTIAL, EARTH, ORIGIN, quat_if)
    if shows_sun(setting):
        quat_is = quaternion_from_matrix(_axes_towards(np.asarray(earth.sun(t)).reshape(-1, 3)))
        send_frame(recording, times, INERTIAL, SUN, ORIGIN, quat_is)
        send_frame(recording, times, SUN_PLACE, SUN_ARROW, ORIGIN, quat_is)


def send_orbit_trail(recording: rr.RecordingStream, rows: TraceRows, setting: Setting, most: int) -> None:
    """Send the path of the robot up to the current time in the view of the orbit."""
    path = setting.orbit_entity("trail")
    send_trail(recording, path, INERTIAL, rows, rows["position_eci"] / 1e3, most, _PATH)


def log_path_flown(recording: rr.RecordingStream, rows: TraceRows, setting: Setting) -> None:
    """Log the path of the robot over the whole run in the view of the orbit."""
    position = rows["position_eci"]
    points = position[evenly_spaced(len(position), _MOST_PATH_POINTS)] / 1e3
    path = rr.LineStrips3D([points], colors=[_PATH], radii=rr.Radius.ui_points(2.0))
    entity = setting.orbit_entity("path")
    put_in(recording, entity, INERTIAL)
    recording.log(entity, path, static=True, strict=True)


def send_spacecraft(
    recording: rr.RecordingStream, rows: TraceRows, setting: Setting, label: str | None = None
) -> None:
    """Send the positions of the robot; the label is by default its name, and omitted if empty."""
    path = setting.orbit_entity("spacecraft")
    put_in(recording, path, INERTIAL)
    label = setting.label if label is None else label
    style = rr.Points3D.from_fields(
        colors=[ROBOT], radii=rr.Radius.ui_points(7.0), labels=[label], show_labels=bool(label)
    )
    recording.log(path, style, static=True, strict=True)
    place = rr.Points3D.columns(positions=rows["position_eci"] / 1e3)
    recording.send_columns(path, [rows.times], place, strict=True)


def path_around_planet(orbit: Orbit | None, points: int = 361) -> Floats | None:
    """Return positions (k, 3), m, along one revolution of an orbit or along a custom path, in inertial axes.

    Returns None for an orbit without a period or a planet, or that decays in its first revolution.
    """
    if orbit is None or orbit.mu is None:
        return None
    period = getattr(orbit, "period", None)
    start, end = getattr(orbit, "span", (0.0, period))
    if end is None or not np.isfinite(end):
        return None
    try:
        return np.asarray(orbit.state(np.linspace(start, end, points))[0])
    except OrbitError:  # the orbit decays within its first revolution
        return None


def _radius_km(mu: float, rows: TraceRows) -> float:
    """Return the radius, km, of a sphere of the assumed density, limited to keep the path above it."""
    radius = (3.0 * mu / (4.0 * math.pi * _GRAVITATION * MEAN_DENSITY)) ** (1.0 / 3.0)
    lowest = float(np.linalg.norm(rows["position_eci"], axis=1).min())
    return float(min(radius, 0.95 * lowest)) / 1e3


def _globe(radii: Floats, *, has_land: bool, bands: int = 60, sectors: int = 120) -> rr.Mesh3D:
    """Return the mesh of an ellipsoid with a map of the Earth; longitude zero is on the x axis."""
    v, u = (np.linspace(0.0, 1.0, count + 1) for count in (bands, sectors))
    colatitude, longitude = np.pi * v[:, None], 2.0 * np.pi * u[None, :] - np.pi
    unit = _directions(colatitude, longitude)
    return rr.Mesh3D(
        vertex_positions=(unit * radii).reshape(-1, 3),
        vertex_normals=np.zeros((unit.shape[0] * unit.shape[1], 3)),  # disables shading by the viewer's light
        vertex_texcoords=np.stack(np.broadcast_arrays(u[None, :], v[:, None]), axis=-1).reshape(-1, 2),
        triangle_indices=_triangles(bands, sectors),
        albedo_texture=world_map(has_land),
    )


def _night(radii: Floats, depth: float, bands: int = 24, sectors: int = 72) -> rr.Mesh3D:
    """Return a dark surface where the Sun, in direction x, is at least ``depth`` rad below the horizon."""
    away, around = np.meshgrid(
        np.linspace(np.pi / 2 + depth, np.pi, bands + 1),
        np.linspace(0.0, 2.0 * np.pi, sectors + 1),
        indexing="ij",
    )
    unit = np.stack([np.cos(away), np.sin(away) * np.cos(around), np.sin(away) * np.sin(around)], axis=-1)
    positions = (unit * radii).reshape(-1, 3)
    return rr.Mesh3D(
        vertex_positions=positions,
        vertex_normals=np.zeros_like(positions),
        triangle_indices=_triangles(bands, sectors),
        albedo_factor=(4, 8, 20, 105),
    )


def _triangles(bands: int, sectors: int) -> NDArray[np.int64]:
    """Return the corners (2 bands sectors, 3) of the triangles of a grid, band by band."""
    corner = (np.arange(bands)[:, None] * (sectors + 1) + np.arange(sectors)).reshape(-1)
    below = corner + sectors + 1
    return np.concatenate(
        [np.stack([corner, below, below + 1], axis=1), np.stack([corner, below + 1, corner + 1], axis=1)]
    )


def _directions(colatitude: Floats, longitude: Floats) -> Floats:
    """Return unit vectors (bands, sectors, 3), given colatitude and longitude, rad."""
    parts = np.broadcast_arrays(
        np.sin(colatitude) * np.cos(longitude), np.sin(colatitude) * np.sin(longitude), np.cos(colatitude)
    )
    return np.stack(parts, axis=-1)


def _axes_towards(directions: Floats) -> Floats:
    """Return axes (T, 3, 3) whose x points along the directions (T, 3), with y in the equatorial plane."""
    x = directions / np.linalg.norm(directions, axis=1, keepdims=True)
    y = np.cross([0.0, 0.0, 1.0], x)
    y /= np.linalg.norm(y, axis=1, keepdims=True)
    return np.stack([x, y, np.cross(x, y)], axis=-1)
