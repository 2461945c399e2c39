"""Pictures of the scene: what is visible, where it is, and which options are rejected."""

from __future__ import annotations

import io
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import onorbit_rs as oo
from onorbit_rs.cli import main
from onorbit_rs.pictures import Scene, draw_picture
from onorbit_rs.pictures.camera import Camera
from onorbit_rs.pictures.light import (
    AMBIENT,
    CHANNELS,
    FROM_CAMERA,
    FROM_SUN,
    add_sunlight,
    lit_colors,
)
from onorbit_rs.pictures.normals import corner_normals
from onorbit_rs.pictures.raster import Canvas
from onorbit_rs.pictures.scene import Member
from onorbit_rs.pictures.sky import AIR_HEIGHT, SPACE, Sky
from onorbit_rs.visuals.earth_shape import EARTH_RADIUS_KM
from onorbit_rs.visuals.solids import box_faces, robot_polygons

UP = np.array([0.0, 0.0, 1.0])
BALL = """<robot name="ball"><link name="body"><inertial><mass value="1"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial><visual><geometry><sphere radius="0.5"/>
</geometry><material name="red"><color rgba="1 0 0 1"/></material></visual></link></robot>"""


def camera_at(distance: float, size: int = 200) -> Camera:
    return Camera.looking(np.array([distance, 0.0, 0.0]), np.zeros(3), UP, (size, size))


def pixels(content: bytes) -> np.ndarray:
    return np.asarray(Image.open(io.BytesIO(content)), dtype=float) / 255.0


def test_a_point_is_projected_as_by_the_pinhole_equations() -> None:
    camera = camera_at(10.0)
    x, y, inverse = camera.project(np.array([2.0, 1.0, 0.5]))
    # y of the scene points to the right, and the depth of the point is 8 m
    assert (x, y) == pytest.approx((100.0 + camera.focal / 8.0, 100.0 - camera.focal * 0.5 / 8.0))
    assert inverse == pytest.approx(1.0 / 8.0)
    assert camera.project(np.array([11.0, 0.0, 0.0]))[2] == 0.0  # behind the camera


def test_the_nearer_of_two_crossing_triangles_is_visible_in_each_pixel() -> None:
    """Two inclined triangles cross in the plane y = 0: a sort by mean depth would show only one of them."""
    camera = camera_at(10.0)
    left = np.array([[-1.0, -2.0, -2.0], [1.0, 2.0, -2.0], [0.0, 0.0, 3.0]])
    both = np.stack([left, left * [-1.0, 1.0, 1.0]])
    for order in ([0, 1], [1, 0]):
        canvas = Canvas(camera)
        canvas.add_triangles(both[order], np.eye(3)[order])
        row = canvas.color[120]
        assert row[90] == pytest.approx([0.0, 1.0, 0.0])  # at y < 0, the mirrored triangle is nearer
        assert row[110] == pytest.approx([1.0, 0.0, 0.0])
    area = (canvas.inverse_depth > 0.0).sum()
    corners = camera.project(left)[:, :2]
    half = abs(np.linalg.det(corners[1:] - corners[0])) / 2.0
    assert half < area < 2.0 * half


def test_a_ball_has_the_size_of_its_silhouette() -> None:
    model = oo.Model.from_urdf_string(BALL)
    trace = oo.Simulation(model, model.neutral(), np.zeros(6), time_step=0.1).run(0.2)
    eye = np.array([4.0, 0.0, 0.0])
    image = pixels(draw_picture(Scene([Member(model, trace)], 0.1), (400, 400), eye=eye))
    is_red = image[..., 0] > image[..., 2] + 0.1
    # a sphere appears as a disc with the tangent of asin(r / d)
    radius = camera_at(4.0, 400).focal * np.tan(np.arcsin(0.5 / 4.0))
    assert is_red[:300].sum() == pytest.approx(np.pi * radius**2, rel=0.01)
    assert image[0, 200] == pytest.approx(np.array([28, 31, 38]) / 255.0, abs=1e-6)  # no orbit: no stars
    apart = pixels(draw_picture(Scene([Member(model, trace)], 0.1), (400, 400), eye=2.0 * eye))
    assert (apart[..., 0] > apart[..., 2] + 0.1)[:300].sum() < 0.3 * is_red.sum()


def quad(center: tuple[float, float, float], side: float) -> np.ndarray:
    """Returns a square that is normal to z."""
    corners = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]]
    return np.array(center) + 0.5 * side * np.array(corners)


def test_a_shadow_is_where_geometry_puts_it() -> None:
    """A square of 1 m is 1 m above a plane; the Sun is inclined by 45 degrees, so the shadow is 1 m aside."""
    faces = np.stack([quad((0.0, 0.0, 0.0), 6.0), quad((0.0, 0.0, 1.0), 1.0)])
    sun = np.array([1.0, 0.0, 1.0]) / np.sqrt(2.0)
    above = Camera.looking(np.array([0.0, 0.0, 20.0]), np.zeros(3), np.array([0.0, 1.0, 0.0]), (400, 400))

    def drawn(shown: np.ndarray) -> Canvas:
        canvas = Canvas(above, CHANNELS)
        triangles = np.concatenate([shown[:, [0, 1, 2]], shown[:, [0, 2, 3]]])
        lit = lit_colors(shown, np.ones((len(shown), 3)), above, sun)
        canvas.add_triangles(triangles, np.concatenate([lit[:, [0, 1, 2]], lit[:, [0, 2, 3]]]))
        add_sunlight(canvas, above, sun, triangles)
        return canvas

    plane, both = drawn(faces[:1]), drawn(faces)
    brightest = float(plane.color[200, 200, 0])
    assert brightest == pytest.approx(AMBIENT + FROM_CAMERA + FROM_SUN / np.sqrt(2.0), abs=5e-3)
    on_plane = both.inverse_depth < 1.01 / 20.0
    is_dark = on_plane & (both.inverse_depth > 0.0) & (both.color[..., 0] < brightest - 0.2)
    rows, columns = np.nonzero(is_dark)
    scale = above.focal / 20.0  # pixels per metre on the plane
    hidden = 0.5 / 0.95 * scale  # the square hides this half-width of the plane
    assert 200.0 - columns.min() == pytest.approx(1.5 * scale, abs=1.5)
    assert 200.0 - columns.max() == pytest.approx(hidden, abs=1.5)
    assert np.ptp(rows) + 1 == pytest.approx(scale, abs=2.0)
    assert (
        plane.color[on_plane & (plane.inverse_depth > 0.0), 0] > brightest - 0.01
    ).all()  # no shadow on itself


def test_round_bodies_are_smooth_and_edges_are_sharp() -> None:
    model = oo.Model.from_urdf_string(BALL)
    (faces, _), *_ = robot_polygons(model, model.neutral()[None], None, 72)
    radial = faces / np.linalg.norm(faces, axis=-1, keepdims=True)
    angles = np.arccos(np.abs(np.einsum("nki,nki->nk", corner_normals(faces), radial)).clip(0.0, 1.0))
    # the normals of the faces are inclined to the radii at their corners by 4.3 degrees or more
    assert np.degrees(angles.mean()) < 0.6 and np.degrees(angles.max()) < 2.5
    box = box_faces(np.array([1.0, 2.0, 3.0]))
    flat = np.cross(box[:, 2] - box[:, 0], box[:, 3] - box[:, 1])
    flat /= np.linalg.norm(flat, axis=1, keepdims=True)
    assert corner_normals(box) == pytest.approx(np.repeat(flat[:, None], 4, axis=1))
    assert corner_normals(np.empty((0, 4, 3))).shape == (0, 4, 3)


def test_the_sun_does_not_shine_through_the_earth() -> None:
    radius = 1e3 * EARTH_RADIUS_KM
    sun = np.array([1.0, 0.0, 0.0])
    for place, is_dark in (
        ([-1.05 * radius, 0.0, 0.0], True),
        ([1.05 * radius, 0.0, 0.0], False),
        ([-6.6 * radius, 0.9 * radius, 0.0], True),
        ([-6.6 * radius, 1.1 * radius, 0.0], False),
    ):
        assert Sky(np.eye(3), np.array(place), None, sun).is_eclipsed() == is_dark
    assert not Sky(np.eye(3), None, None, sun).is_eclipsed()


def test_the_horizon_is_where_geometry_puts_it() -> None:
    radius = 1e3 * EARTH_RADIUS_KM
    place = np.array([radius + 400e3, 0.0, 0.0])
    pitch = np.radians(15.0)  # the camera looks along y and 15° down, and x points up
    forward = np.array([-np.sin(pitch), np.cos(pitch), 0.0])
    camera = Camera.looking(np.zeros(3), forward, np.array([1.0, 0.0, 0.0]), (64, 720))
    sky = Sky(np.eye(3), place, None, np.array([1.0, 0.0, 0.0]))
    column = np.median(sky.paint(camera)[:, 28:37], axis=1)  # without stars
    dip = np.arccos(radius / place[0])
    edge = 360.0 + camera.focal * np.tan(dip - pitch)
    is_blue = column[:, 2] > 0.25
    # a ray that passes above the ground at the scale height of the air is brightened by 1 / e
    highest = np.arccos(radius * (1.0 + 1.1 * AIR_HEIGHT) / place[0])
    air = 360.0 + camera.focal * np.tan(highest - pitch)
    assert air < edge and np.flatnonzero(is_blue)[0] == pytest.approx(air, abs=3)
    assert is_blue[int(edge) + 1 :].all()
    night = replace(sky, sun=np.array([-1.0, 0.0, 0.0])).paint(camera)[:, 32]
    assert night[int(edge) + 20 :].max() < 0.1  # the same place, with the Sun below it
    empty = replace(sky, place=None).paint(camera)
    assert np.median(empty, axis=(0, 1)) == pytest.approx(SPACE) and empty.max() > 0.15  # stars only


def show(*words: object) -> int | str | None:
    """Returns the exit code of ``onorbit show``."""
    with pytest.raises(SystemExit) as end:
        main(["show", *map(str, words)])
    return end.value.code


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("pictures") / "out"
    changes = {"simulation.duration": "0.05 s"}
    oo.run("humanoid_reach", out, quiet=True, figures=False, recording=False, changes=changes)
    return out


def test_a_run_without_a_recording_is_drawn(folder: Path) -> None:
    file = folder.parent / "run.png"
    assert not show(folder, "--picture", file, "--size", "320x180", "--collision")
    image = pixels(file.read_bytes())
    assert image.shape == (180, 320, 3)
    assert image[:30].mean() < 0.1 and image[-10:, 200:].mean() > 0.15  # space above, the Earth below
    assert image[60:120, 100:220].max() > 0.6  # the white robot in the middle
    again = folder.parent / "again.png"
    assert not show(folder, "--picture", again, "--size", "320x180", "--collision")
    assert again.read_bytes() == file.read_bytes()


@pytest.mark.parametrize(
    ("options", "text"),
    [
        (["--size", "0x10"], "is not valid; write WIDTHxHEIGHT in pixels, each from 1 to 8192"),
        (["--size", "wide"], "is not valid"),
        (["--eye", "1,2"], "is not a point; write three finite numbers in m, such as --eye=3,-4,2.5"),
        (["--eye", "1,2,nan"], "is not a point"),
        (["--look-at", "a,b,c"], "--look-at 'a,b,c' is not a point"),
        (["--eye", "1,1,1", "--look-at", "1,1,1"], "give two different points"),
        (["--at", "7"], "--at 7 is outside the run; give a time from 0 to 0.05"),
    ],
)
def test_an_invalid_view_is_an_error(
    options: list[str], text: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = folder.parent / "none.png"
    assert show(folder, "--picture", file, *options)
    assert text in " ".join(capsys.readouterr().err.split())
    assert not file.exists()


@pytest.mark.parametrize("option", [["--size", "9x9"], ["--eye", "1,2,3"], ["--at", "0"], ["--collision"]])
def test_options_of_a_picture_require_a_picture(
    option: list[str], folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert show(folder, *option)
    assert f"{option[0]} applies only to a picture; add --picture FILE.png" in capsys.readouterr().err
