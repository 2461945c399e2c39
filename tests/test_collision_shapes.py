"""Collision shapes that Python or a scenario adds to links: motion, distance, errors with their lines."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
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
