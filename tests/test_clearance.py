"""Keep-out zones and least distances on the rows of a trace, against closed forms."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from contact_worlds import ball, moving

import onorbit_rs as oo
from onorbit_rs.exceptions import FrameError, InputError

SPEED = 0.5


def at(x: float) -> np.ndarray[Any, Any]:
    pose = np.eye(4)
    pose[0, 3] = x
    return pose


def flight(**settings: Any) -> oo.Trace:
    """Returns the trace of a ball of 0.1 m that moves along x for 4 s."""
    trace = oo.Simulation(
        ball(), [0, 0, 0, 0, 0, 0, 1], [SPEED, 0, 0, 0, 0, 0], time_step=0.01, **settings
    ).run(4.0)
    assert isinstance(trace, oo.Trace)
    return trace


def test_a_zone_reports_entry_exit_and_depth() -> None:
    zone = oo.KeepOut("box", oo.Shape.box(0.4, 1, 1), "body", pose=at(1.013))
    found = oo.clearances(ball(), flight(), [zone])["box"]
    # the face at 0.813 m and the ball of 0.1 m meet at x = 0.713 m
    (violation,) = found.violations
    assert violation.entry == pytest.approx(0.713 / SPEED, abs=1e-12)
    assert violation.exit == pytest.approx(1.313 / SPEED, abs=1e-12)
    assert violation.depth == pytest.approx(0.3, abs=5e-3) and violation.links == ("box", "body")
    assert found.gap[0] == pytest.approx(0.713, abs=1e-12)
    np.testing.assert_allclose(found.point_a + found.gap[:, None] * found.normal, found.point_b, atol=1e-9)


def test_a_zone_beside_the_path_is_not_violated() -> None:
    beside = at(1.0)
    beside[1, 3] = 0.7
    zone = oo.KeepOut("box", oo.Shape.box(0.4, 1, 1), "b*", pose=beside)
    found = oo.clearances(ball(), flight(), [zone])["box"]
    assert found.violations == [] and found.gap.min() == pytest.approx(0.1, abs=1e-12)
    assert found.time[found.nearest] == pytest.approx(2.0, abs=0.41)


def test_a_violation_at_the_start_or_the_end_has_no_entry_or_exit() -> None:
    start = oo.KeepOut("start", oo.Shape.sphere(0.5), "body")
    beyond = np.array([[0, 0, -1, 1.5], [0, 1, 0, 0], [1, 0, 0, 0], [0, 0, 0, 1]])
    end = oo.KeepOut("end", oo.Shape.half_space(), "body", pose=beyond)
    found = oo.clearances(ball(), flight(), [start, end])
    (first,), (last,) = found["start"].violations, found["end"].violations
    assert first.entry is None and first.exit == pytest.approx(0.6 / SPEED)
    assert last.exit is None and last.entry == pytest.approx(1.4 / SPEED) and last.time == 4.0


def test_a_zone_turns_with_the_reference_orbit() -> None:
    orbit = oo.Kepler(semi_major_axis=6778e3)
    trace = flight(orbit=orbit)
    zone = oo.KeepOut("ahead", oo.Shape.sphere(0.2), "body", fixed_to="lvlh", pose=at(3.0))
    found = oo.clearances(ball(), trace, [zone])["ahead"]
    # L: x radial, z along the angular momentum
    r, v = np.asarray(trace.reference_position_eci), np.asarray(trace.reference_velocity_eci)
    radial = r / np.linalg.norm(r, axis=1)[:, None]
    np.testing.assert_allclose(
        found.gap, np.linalg.norm(trace.q[:, :3] - 3 * radial, axis=1) - 0.3, atol=1e-12
    )
    assert np.linalg.norm(radial[-1] - radial[0]) > 1e-3 and v.shape == r.shape
    with pytest.raises(InputError, match="requires a reference orbit"):
        oo.clearances(ball(), flight(), [zone])


def test_a_zone_moves_with_a_link_of_another_system() -> None:
    world = oo.World([moving("a", [0, 0, 0], [SPEED, 0, 0]), moving("b", [2, 0, 0], [-SPEED, 0, 0])])
    trace = oo.Simulation(world, time_step=0.01).run(3.0)
    models = {"a": ball(), "b": ball()}
    zone = oo.KeepOut("around_b", oo.Shape.sphere(0.5), "a/*", fixed_to="b/body")
    pair = oo.MinimumDistance("pair", "a/*", "b/*")
    found = oo.clearances(models, trace, [zone, pair])
    (inside,), (overlap,) = found["around_b"].violations, found["pair"].violations
    assert inside.entry == pytest.approx(1.4, abs=1e-9) and inside.links == ("around_b", "a/body")
    assert overlap.entry == pytest.approx(1.8, abs=1e-9) and overlap.links == ("a/body", "b/body")
    assert overlap.depth == pytest.approx(0.2, abs=1e-9) and overlap.time == pytest.approx(2.0)


def test_neighbours_are_not_compared_within_a_robot() -> None:
    robot = oo.robots.load("servicer")
    q = robot.neutral()
    trace = oo.Simulation(robot, q, np.zeros(robot.nv), time_step=0.1).run(0.1)
    found = oo.clearances(robot, trace, [oo.MinimumDistance("self", "*", "*")])["self"]
    neighbours = {frozenset((joint.parent, joint.child)) for joint in robot.joints}
    bodies = {frame.name: frame.body for frame in robot.frames}
    for a, b in found.links:
        pair = frozenset((bodies[a], bodies[b]))
        assert len(pair) == 2 and pair not in neighbours
        assert found.gap[0] == pytest.approx(oo.distance(robot, q, a, b).distance, abs=1e-12)
    solid = {shape.link for shape in robot.collisions}
    every = [
        oo.distance(robot, q, a, b).distance for a in solid for b in solid
        if bodies[a] != bodies[b] and frozenset((bodies[a], bodies[b])) not in neighbours
    ]  # fmt: skip
    assert found.gap[0] == min(every)


def test_bad_watches_say_what_is_wrong() -> None:
    trace = flight()
    for watches, error, words in (
        (
            [oo.KeepOut("z", oo.Shape.sphere(1), "bdy")],
            FrameError,
            "no link matches 'bdy'; did you mean 'body'",
        ),
        (
            [oo.KeepOut("z", oo.Shape.sphere(1), "body", fixed_to="bdy")],
            FrameError,
            r"it must be .* or a frame .*; did you mean 'body'",
        ),
        ([oo.MinimumDistance("d", "body", "body")], InputError, "compares no two links"),
        ([oo.KeepOut("z", oo.Shape.sphere(1), "body")] * 2, InputError, "entries of 'watches' are named 'z'"),
    ):
        with pytest.raises(error, match=words):
            oo.clearances(ball(), trace, watches)
    with pytest.raises(FrameError, match=r"no link that matches .base. has a collision shape"):
        bare = oo.Model.rigid_body(1.0, np.eye(3))
        rest = oo.Simulation(bare, bare.neutral(), np.zeros(6), time_step=0.1).run(0.1)
        oo.clearances(bare, rest, [oo.KeepOut("z", oo.Shape.sphere(1), "base")])
    with pytest.raises(InputError, match="is not a rotation"):
        oo.KeepOut("z", oo.Shape.sphere(1), "body", pose=2 * np.eye(4))


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"links": 5}, "links is 5; expected the name of a link"),
        ({"links": ["body", 5]}, "expected the name of a link"),
        ({"pose": "here"}, r"pose of the zone 'z' is 'here'; expected a \(4, 4\) array"),
        ({"pose": [[1, 2], [3]]}, r"expected a \(4, 4\) array"),
        ({"pose": np.diag([1.0, 1.0, -1.0, 1.0])}, "is not a rotation; .* determinant 1"),
        ({"pose": at(1.0).T}, r"the last row .* is \(1, 0, 0, 1\), not \(0, 0, 0, 1\)"),
    ],
)
def test_bad_arguments_of_a_zone_are_input_errors(given: dict[str, Any], words: str) -> None:
    with pytest.raises(InputError, match=words):
        oo.KeepOut(**({"name": "z", "shape": oo.Shape.sphere(1), "links": "body"} | given))
