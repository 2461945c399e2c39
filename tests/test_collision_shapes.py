"""Collision shapes that Python or a scenario adds to links: motion, distance, errors with their lines."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from collision_robots import CUBE, CUBE_FACES, obj_file
from contact_worlds import HARD, ball, moving, run
from world_runs import built, check_line_of_error, data

import onorbit_rs as oo
from onorbit_rs.exceptions import FrameError, InputError, ModelError
from onorbit_rs.visuals.shapes import shapes

TEXT = """\
systems:
  a:
    robot: {rigid_body: {mass: 4, inertia: [0.1, 0.1, 0.1]}}
    initial: {linear_velocity: [20 cm/s, 0, 0]}
    collision:
      - link: base
        shape: {kind: cone, radius: 5 cm, height: 8 cm}
        pose: {attitude: {roll_pitch_yaw: [0, 90 deg, 0]}}
      - link: base
        shape: {kind: torus, major_radius: 10 cm, minor_radius: 2 cm}
        pose: {position: [-20 cm, 0, 0]}
  b: {robot: ball, initial: {position: [16 cm, 0, 0]}}
contacts:
  - {name: touch, between: [a/base, b/*], normal: {kind: hunt_crossley, stiffness: 1e6}}
simulation: {duration: 0.2 s, time_step: 2 ms}
"""


def at(x: float, y: float = 0.0, z: float = 0.0) -> np.ndarray[Any, Any]:
    pose = np.eye(4)
    pose[:3, 3] = x, y, z
    return pose


@pytest.mark.parametrize(
    ("shape", "surface"),
    [
        (oo.Shape.sphere(0.3), 0.3), (oo.Shape.box(0.2, 0.3, 0.6), 0.3), (oo.Shape.cylinder(0.1, 0.6), 0.3),
        (oo.Shape.capsule(0.1, 0.4), 0.3), (oo.Shape.cone(0.2, 0.6), 0.3), (oo.Shape.half_space(), 0.0),
    ],
)  # fmt: skip
def test_the_distance_along_the_axis_is_that_of_the_surface(shape: oo.Shape, surface: float) -> None:
    body = oo.Model.rigid_body(1.0, np.eye(3))
    one = body.with_collision("base", shape, pose=at(1.0))
    world = oo.World([oo.System("a", one, one.neutral(), np.zeros(6)), moving("b", [1, 0, 2], [0, 0, 0])])
    q = {"a": one.neutral(), "b": np.array([1.0, 0, 2, 0, 0, 0, 1])}
    assert oo.distance(world, q, "a/base", "b/body").distance == pytest.approx(2.0 - 0.1 - surface, abs=1e-12)
    assert pickle.loads(pickle.dumps(one)).collisions[0].kind == shape.kind


def test_a_ball_passes_through_a_torus_and_rests_on_its_tube() -> None:
    ring = oo.Model.rigid_body(1.0, np.eye(3)).with_collision("base", oo.Shape.torus(0.3, 0.05))
    world = oo.World(
        [oo.System("ring", ring, ring.neutral(), np.zeros(6)), moving("b", [0, 0, 9], [0, 0, 0])]
    )
    for place, gap in (([0, 0, 0], 0.15), ([0.3, 0, 0.2], 0.05)):
        q = {"ring": ring.neutral(), "b": np.array([*place, 0, 0, 0, 1])}
        assert oo.distance(world, q, "ring/base", "b/body").distance == pytest.approx(gap, abs=1e-12)


def test_the_shape_changes_the_collision_alone() -> None:
    plain, more = ball(), ball().with_collision("body", oo.Shape.box(1.0, 1.0, 1.0))
    assert [shape.kind for shape in more.collisions] == ["sphere", "box"]
    np.testing.assert_array_equal(more.mass_matrix(more.neutral()), plain.mass_matrix(plain.neutral()))
    assert len(plain.collisions) == 1


def test_a_ball_rebounds_from_a_half_space_of_a_heavy_body() -> None:
    wall = oo.Model.rigid_body(4.0, np.eye(3)).with_collision("base", oo.Shape.half_space())
    systems = [
        oo.System("wall", wall, wall.neutral(), np.zeros(6)),
        moving("b", [0.3, 0, 0.12], [0, 0, -0.2]),
    ]
    contact = oo.Contact("wall/base", "b/body", normal=HARD, name="touch")
    trace = run(oo.World(systems, contacts=[contact]), 0.3)
    assert trace.contacts["touch"].force.max() > 1.0
    np.testing.assert_allclose(
        trace.momentum, np.broadcast_to(trace.momentum[0], trace.momentum.shape), atol=1e-13
    )
    assert all(passed for _, _, _, passed in trace.certificate())


def test_the_shapes_of_a_scenario_touch() -> None:
    world = built(data(TEXT))
    model = world.systems["a"].model
    assert [shape.kind for shape in model.collisions] == ["cone", "torus"]
    found: Any = oo.run(data(TEXT), quiet=True)
    touch = found.trace.contacts["touch"]
    assert touch.gap[0] == pytest.approx(0.02, abs=1e-12)  # apex at 4 cm, surface of the ball at 6 cm
    assert touch.force.max() > 1.0 and found.summary["certificate_passed"]
    parts = {shape.kind: shape for shape in shapes(model)}
    (low, high) = parts["mesh"].mesh.bounds
    np.testing.assert_allclose(high - low, [0.24, 0.24, 0.04], atol=1e-3)


@pytest.mark.parametrize(
    ("old", "new", "line", "words"),
    [
        ("height: 8 cm", "height: -8 cm", 7, "above zero"),
        ("minor_radius: 2 cm", "minor_radius: 12 cm", 10, "less than the major_radius"),
        ("- link: base", "- link: bas", 6, "did you mean 'base'"),
        ("kind: cone", "kind: pyramid", 7, "cone, torus"),
        ("kind: cone, radius: 5 cm, height: 8 cm", "kind: mesh, file: gone.stl", 6, "no such file"),
        ("height: 8 cm", "height: .nan", 7, "height"),
    ],
)
def test_errors_name_the_line(tmp_path: Path, old: str, new: str, line: int, words: str) -> None:
    check_line_of_error(built, (TEXT, old, new), line, words, tmp_path)


@pytest.mark.parametrize(
    ("faces", "words"), [(CUBE_FACES[1:], "is open"), ([face[::-1] for face in CUBE_FACES], "is inside out")]
)
def test_a_mesh_with_a_defect_causes_one_warning_with_its_line(
    tmp_path: Path, faces: list[tuple[int, int, int]], words: str
) -> None:
    obj_file(tmp_path / "cube.obj", CUBE, faces)
    file = tmp_path / "mine.yaml"
    mesh = "shape: {kind: mesh, file: cube.obj, scale: [0.1, 0.1, 0.1]}"
    file.write_text(TEXT.replace("shape: {kind: cone, radius: 5 cm, height: 8 cm}", mesh))
    with pytest.warns(UserWarning) as caught:
        world = built(file)
    (message,) = [str(one.message) for one in caught]
    assert message.startswith(f"{file}:6: systems.a.collision[0]: ") and words in message
    assert any(words in one for one in world.warnings)  # onorbit info prints these


@pytest.mark.parametrize("beside", [1e-4, 1e-3, 1e-2])
def test_the_energy_of_a_ball_on_a_torus_is_kept_near_its_axis(beside: float) -> None:
    """The nearest point moves fast along the circle, so that some steps have to be repeated."""
    ring = oo.Model.rigid_body(20.0, 0.4 * np.eye(3)).with_collision("base", oo.Shape.torus(0.09, 0.01))
    systems = [
        oo.System("ring", ring, ring.neutral(), np.zeros(6)),
        moving("b", [beside, 0, 0.08], [0, 0, -0.2]),
    ]
    law = oo.HuntCrossley(1e6, restitution=0.6, speed=0.2)
    trace = run(oo.World(systems, contacts=[oo.Contact("ring/base", "b/body", normal=law, name="t")]), 0.3)
    touch = trace.contacts["t"]
    assert touch.touches[-1] >= 1 and touch.elastic.max() > 1e-3
    energy = trace.kinetic_energy + touch.elastic + touch.dissipated
    assert np.abs(energy - energy[0]).max() < 1e-8 * touch.elastic.max()


def ring_of_capsules(count: int, major_radius: float, minor_radius: float) -> oo.Model:
    """Returns a body of 1.5 kg with ``count`` capsules along a circle about z; radii in m."""
    model = oo.Model.rigid_body(1.5, np.diag([0.01, 0.01, 0.02]))
    for angle in 2 * np.pi * np.arange(count) / count:
        radial = np.array([np.cos(angle), np.sin(angle), 0.0])
        along = np.array([-np.sin(angle), np.cos(angle), 0.0])
        pose = at(*major_radius * radial)
        pose[:3, :3] = np.stack([radial, np.cross(along, radial), along], axis=1)
        model = model.with_collision(
            "base", oo.Shape.capsule(minor_radius, 2 * major_radius * np.tan(np.pi / count)), pose=pose
        )
    return model


@pytest.mark.parametrize(
    ("shape", "height"), [(oo.Shape.cone(0.3, 0.3), 0.075), (oo.Shape.box(1.0, 1.0, 0.2), 0.112)]
)
def test_a_ring_of_capsules_rebounds_without_turning_where_it_touches_all_around(
    shape: oo.Shape, height: float
) -> None:
    base = oo.Model.rigid_body(20.0, 0.4 * np.eye(3)).with_collision("base", shape)
    ring = ring_of_capsules(12, 0.1, 0.01)
    systems = [
        oo.System("plate", base, base.neutral(), np.zeros(6)),
        oo.System("ring", ring, [0, 0, height, 0, 0, 0, 1], [0, 0, -0.2, 0, 0, 0]),
    ]
    law = oo.HuntCrossley(1e6 / 12, 1.0, restitution=0.5, speed=0.2)
    trace = run(
        oo.World(systems, contacts=[oo.Contact("plate/base", "ring/base", normal=law, name="t")]), 0.1
    )
    touch = trace.contacts["t"]
    assert touch.touches[-1] == 1 and touch.gap[-1] > 0.0
    assert np.abs(trace["ring"].v[-1, [0, 1, 3, 4, 5]]).max() < 1e-12
    energy = trace.kinetic_energy + touch.elastic + touch.dissipated
    assert np.abs(energy - energy[0]).max() < 2e-8 * touch.elastic.max()
    if shape.kind == "box":  # all normals are parallel to the motion
        rebound = trace["ring"].v[-1, 2] - trace["plate"].v[-1, 2]
        assert rebound == pytest.approx(0.5 * 0.2, rel=1e-6)


def test_errors_in_python_give_the_value() -> None:
    for make, words in (
        (lambda: oo.Shape.cone(0.1, -1.0), "height of a cone is -1 m; it must be positive"),
        (lambda: oo.Shape.box(1.0, float("nan"), 1.0), "the y of a box is NaN m"),
        (lambda: oo.Shape.torus(0.1, 0.2), "minor_radius of a torus is 0.2 m; it must be less"),
    ):
        with pytest.raises(InputError, match=words):
            make()
    with pytest.raises(FrameError, match="did you mean 'body'"):
        ball().with_collision("bdy", oo.Shape.sphere(0.1))
    with pytest.raises(ModelError, match="no such file"):
        oo.Shape.mesh("gone.stl")
