"""Draws a scene as a picture: surfaces lit by the Sun, paths of tools, stars, the Earth, and axes."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

import numpy as np
from PIL import Image

from onorbit_rs.pictures.camera import Camera
from onorbit_rs.pictures.light import CHANNELS, add_sunlight, lit_colors
from onorbit_rs.pictures.raster import Canvas
from onorbit_rs.pictures.sky import Sky
from onorbit_rs.pictures.triad import add_triads
from onorbit_rs.visuals.earth_shape import EARTH_RADIUS_KM

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs.pictures.scene import Scene

    Floats = NDArray[np.float64]

SIZE = (1920, 1080)
"""Default size of a picture, pixels."""

TO_EYE = np.array([0.5, -0.8, 0.34])
"""Default direction from a robot to the camera, in base axes: front, right and a little above."""

BACKGROUND = np.array([28, 31, 38]) / 255.0
"""Background of a scene without an orbit."""

_FINER = 2
"""Number of samples per pixel in each direction."""

_LIGHT = np.array([-0.45, 0.65, 0.6])
"""Direction to the light in axes of the camera, if the Sun's position is unknown or the Earth hides it."""

_PATHS = {"desired": (0.94, 0.94, 0.94), "obtained": (1.0, 0.38, 0.25)}
_WIRE = (0.35, 0.88, 0.80)
_MOST_POINTS = 2000
_HORIZON_BELOW_DEG = 9.0
"""Angle from the horizon of the Earth up to the line of sight, degrees."""


def draw_picture(
    scene: Scene,
    size: tuple[int, int] = SIZE,
    *,
    eye: Floats | None = None,
    look_at: Floats | None = None,
    has_collisions: bool = False,
) -> bytes:
    """Return a picture of a scene as PNG.

    Parameters
    ----------
    scene : Scene
        Robots at one time.
    size : tuple of int
        Width and height, pixels.
    eye : (3,) array, optional
        Position of the camera relative to the base of the first robot, m, in axes of the scene; default: a
        position from which all robots near the first one are visible.
    look_at : (3,) array, optional
        Point in the middle of the picture, relative to the same origin and in the same axes, m; default: the
        middle of the first robot and the robots near it.
    has_collisions : bool
        Draw the edges of collision shapes.

    Returns
    -------
    bytes
        Content of a PNG file.
    """
    camera = _camera(scene, size, eye, look_at)
    sun, image = _background(scene, camera)
    finer = camera.enlarged(_FINER)
    canvas = Canvas(finer, CHANNELS)
    faces, colors = scene.surfaces()
    triangles = np.concatenate([faces[:, [0, 1, 2]], faces[:, [0, 2, 3]]])
    lit = lit_colors(faces, colors, camera, sun)
    canvas.add_triangles(triangles, np.concatenate([lit[:, [0, 1, 2]], lit[:, [0, 2, 3]]]))
    add_sunlight(canvas, finer, sun, triangles)
    width = _FINER * max(1.0, size[1] / 540.0)
    for name, points in scene.paths():
        if len(points) > 1:
            rows = np.unique(np.linspace(0, len(points) - 1, _MOST_POINTS).astype(int))
            canvas.add_line(points[rows], _unlit(_PATHS[name]), width)
    if has_collisions:
        faces = scene.collision_faces()
        ends = faces[:, [1, 2, 3, 0]]
        canvas.add_segments(faces.reshape(-1, 3), ends.reshape(-1, 3), _unlit(_WIRE), 0.6 * width)
    image = _merged(image, canvas)
    triads = [("B", camera.axes @ scene.rot_sb)]
    triads.append(("L", camera.axes) if scene.is_local else ("W", camera.axes))
    add_triads(image, triads)
    return _png(image)


def _camera(scene: Scene, size: tuple[int, int], eye: Floats | None, look_at: Floats | None) -> Camera:
    """Return the camera at ``eye``, or at a position from which the robots fill the picture."""
    corners = scene.corners()
    up = (
        np.array([1.0, 0.0, 0.0]) if scene.is_local else scene.rot_sb[:, 2]
    )  # x of L points away from the Earth
    if eye is not None:
        middle = (corners.min(axis=0) + corners.max(axis=0)) / 2.0 if look_at is None else look_at
        return Camera.looking(eye, middle, up, size)
    direction = scene.rot_sb @ TO_EYE
    if scene.is_local:
        aside = direction - direction @ up * up
        if np.linalg.norm(aside) < 0.1:  # the default direction is nearly vertical
            aside = np.array([0.0, 0.6, -0.8])
        above = np.radians(_elevation_deg(scene))
        direction = np.cos(above) * aside / np.linalg.norm(aside) + np.sin(above) * up
    camera = Camera.around(corners, direction, up, size)
    return camera if look_at is None else Camera.looking(camera.position, look_at, up, size)


def _elevation_deg(scene: Scene) -> float:
    """Return the elevation of the camera, degrees; 20 unless the horizon of the Earth is in the picture."""
    if not scene.about_earth:
        return 20.0
    ratio = 1e3 * EARTH_RADIUS_KM / float(np.linalg.norm(scene.place_eci))
    return float(np.clip(np.degrees(np.arccos(min(ratio, 1.0))) - _HORIZON_BELOW_DEG, 8.0, 72.0))


def _background(scene: Scene, camera: Camera) -> tuple[Floats, Floats]:
    """Return the unit vector to the light, in axes of the scene, and the picture of the surroundings."""
    light = _LIGHT @ camera.axes / np.linalg.norm(_LIGHT)
    if not scene.has_orbit:
        return light, np.broadcast_to(BACKGROUND, (camera.height, camera.width, 3)).copy()
    sun_i, rot_ei = scene.rot_ws @ light, None
    if scene.about_earth and scene.earth is not None:
        rot_ei = np.asarray(scene.earth.rotation(scene.time))
        if scene.earth.epoch is not None:  # otherwise the position of the Sun is unknown
            sun_i = np.asarray(scene.earth.sun(scene.time))
        sun_i = sun_i / np.linalg.norm(sun_i)
    sky = Sky(scene.rot_ws, scene.place_eci if scene.about_earth else None, rot_ei, sun_i)
    return light if sky.is_eclipsed() else scene.rot_ws.T @ sun_i, sky.paint(camera)


def _unlit(color: tuple[float, ...]) -> Floats:
    """Return the components of a colour on a canvas that the Sun does not change."""
    return np.array([*color, *[0.0] * (CHANNELS - 3)])


def _merged(image: Floats, canvas: Canvas) -> Floats:
    """Return the background with the mean of the samples of each pixel of the canvas drawn over it."""
    shape = (image.shape[0], _FINER, image.shape[1], _FINER)
    is_drawn = (canvas.inverse_depth > 0.0).reshape(shape)
    drawn = canvas.color[..., :3].clip(0.0, 1.0).reshape(*shape, 3).sum(axis=(1, 3)) / _FINER**2
    merged: Floats = drawn + (1.0 - is_drawn.mean(axis=(1, 3)))[..., None] * image
    return merged


def _png(image: Floats) -> bytes:
    """Return an image with components from 0 to 1 as PNG."""
    stream = io.BytesIO()
    pixels = (255.0 * image.clip(0.0, 1.0) + 0.5).astype(np.uint8)
    Image.fromarray(pixels).save(stream, "png")
    return stream.getvalue()
