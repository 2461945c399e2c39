"""Figures of several systems: captured frames, exchange of momentum and energy, formations."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from world_runs import built, data, pair, ran, trio

import onorbit_rs as oo
from onorbit_rs import figures
from onorbit_rs.common.frame_motion import MovingFrame, frame_motion, rotation_vector
from onorbit_rs.common.group_momentum import shared_rows
from onorbit_rs.common.rotations import matrix_from_quaternion
from onorbit_rs.figures.world_motion import paths_of_systems
from onorbit_rs.output import summarize_world
from onorbit_rs.scenario.build_world import BuiltWorld
from onorbit_rs.scenario.connections import Connection, connected_groups, connections


def subject(world: BuiltWorld, trace: oo.WorldTrace) -> figures.WorldSubject:
    models = {name: alone.model for name, alone in world.systems.items()}
    events = figures.marks_of(summarize_world(trace, world))
    return figures.WorldSubject(trace, models, events, connections(world.scenario))


def drawn(world: BuiltWorld, trace: oo.WorldTrace) -> dict[str, Any]:
    return {drawing.name: drawing.draw() for drawing in figures.world_drawings(subject(world, trace))}


def test_a_pair_has_the_figures_of_its_capture_and_of_the_exchange() -> None:
    assert set(drawn(*pair())) == {"world_capture_grasp", "world_momentum", "world_energy"}
    assert set(drawn(*trio())) == {"world_capture_grasp", "world_momentum", "world_energy", "world_motion"}


def test_the_motion_of_the_captured_frame_is_relative_to_the_capturing_one() -> None:
    world, trace = pair()
    position, attitude, velocity, rate = drawn(world, trace)["world_capture_grasp"].axes
    chaser, target = (world.systems[name].model for name in ("chaser", "target"))
    tool = chaser.frame_pose(trace["chaser"].q, "tool")
    handle = target.frame_pose(trace["target"].q, "handle")
    relative = np.linalg.inv(tool) @ handle
    lines = {line.get_label(): np.asarray(line.get_ydata()) for line in position.lines}
    assert position.get_ylabel() == "position [mm]"
    for axis, name in enumerate("xyz"):
        np.testing.assert_allclose(lines[name], 1e3 * relative[:, axis, 3], atol=1e-9)
    assert "latch: 50 mm" in [text.get_text() for text in position.texts]  # far above the distances
    limits = {line.get_label(): np.asarray(line.get_ydata()) for line in velocity.lines}
    np.testing.assert_allclose(limits["latch"], 150.0)  # mm/s
    turned = {line.get_label(): np.asarray(line.get_ydata()) for line in attitude.lines}
    trace_of = np.trace(relative[:, :3, :3], axis1=1, axis2=2)
    np.testing.assert_allclose(
        turned["magnitude"], np.degrees(np.arccos(np.clip((trace_of - 1) / 2, -1, 1))), atol=1e-5
    )
    held = (trace.time > trace.events[0].time) & (trace.time < trace.events[1].time)
    for axes in (velocity, rate):
        speed = next(np.asarray(line.get_ydata()) for line in axes.lines if line.get_label() == "magnitude")
        assert speed[held].max() < 1e-9 < speed[~held].max()


def test_the_velocity_is_the_derivative_of_the_relative_position() -> None:
    """A tumbling pair, in which the term with the rate of the first frame matters."""
    model = oo.robots.load("servicer")
    rng = np.random.default_rng(7)
    q, v, dt = [], [], 1e-5
    for _ in range(2):
        start = model.neutral()
        start[:3], start[7:] = rng.normal(size=3), rng.normal(size=7)
        speed = rng.normal(size=model.nv)
        q.append(np.array([model.integrate(start, speed * t) for t in (-dt, 0.0, dt)]))
        v.append(np.tile(speed, (3, 1)))
    motion = frame_motion(*(MovingFrame(model, "tool", q[i], v[i]) for i in (0, 1)))
    slope = (motion.position[2] - motion.position[0]) / (2 * dt)
    np.testing.assert_allclose(motion.velocity[1], slope, atol=1e-8)
    rot = matrix_from_quaternion([quaternion(vector) for vector in motion.rotation])
    spin = (rot[2] - rot[0]) / (2 * dt) @ rot[1].T
    np.testing.assert_allclose(motion.rate[1], [spin[2, 1], spin[0, 2], spin[1, 0]], atol=1e-8)


def quaternion(vector: Any) -> Any:
    angle = np.linalg.norm(vector)
    return np.append(np.sin(angle / 2) * vector / angle, np.cos(angle / 2))


def test_rotation_vectors_are_inverse_to_quaternions() -> None:
    vectors = np.array([[0.3, -0.2, 0.1], [0.0, 3.1, 0.0], [1e-9, 0, 0]])
    found = rotation_vector([quaternion(vector) for vector in vectors])
    np.testing.assert_allclose(found, vectors, rtol=1e-12, atol=1e-15)
    np.testing.assert_array_equal(rotation_vector([0, 0, 0, -1.0]), np.zeros(3))


def test_the_sum_of_the_momenta_is_that_of_the_world() -> None:
    world, trace = pair()
    axes = drawn(world, trace)["world_momentum"].axes
    for column, part in ((0, trace.momentum[:, :3]), (1, trace.momentum[:, 3:])):
        for row in range(3):
            panel = axes[2 * row + column]
            lines = {line.get_label(): np.asarray(line.get_ydata()) for line in panel.lines}
            scale = 1e3 if "[mN" in panel.get_ylabel() else 1.0
            np.testing.assert_allclose(
                lines["sum"], scale * part[:, row], atol=1e-10 * scale * np.abs(part).max()
            )
            np.testing.assert_allclose(lines["chaser"] + lines["target"], lines["sum"], atol=1e-9 * scale)
            marks = [line.get_xdata()[0] for line in panel.lines if line.get_label().startswith("_child")]
            np.testing.assert_allclose(marks, [event.time for event in trace.events])


def test_every_event_has_a_bar_with_its_energy() -> None:
    world, trace = pair()
    left, right = drawn(world, trace)["world_energy"].axes
    lines = {line.get_label(): np.asarray(line.get_ydata()) for line in left.lines}
    assert left.get_ylabel() == "kinetic energy [mJ]"
    np.testing.assert_allclose(lines["sum"], 1e3 * trace.kinetic_energy, rtol=1e-12)
    bars = [bar.get_width() for bar in right.patches]
    np.testing.assert_allclose(bars, [1e3 * event.energy_lost for event in trace.events])
    assert [label.get_text() for label in right.get_yticklabels()] == ["grasp", "let_go"]
    assert [text.get_text().split()[-1] for text in right.texts] == ["lost", "added"]


def test_the_paths_of_a_formation_are_hills_ellipses() -> None:
    world = built("formation")
    trace = ran(world)
    figure = drawn(world, trace)["world_motion"]
    plane, across, apart = figure.axes
    for path in paths_of_systems(trace):
        radial, along, normal = np.ptp(path, axis=0)
        assert along / radial == pytest.approx(2.0, rel=1e-2)
        assert normal / radial == pytest.approx(np.sqrt(3.0), rel=1e-2)
    assert [line.get_label() for line in plane.lines if not line.get_label().startswith("_")] == [
        "first", "second", "third", "start", "end", "reference",
    ]  # fmt: skip
    assert (plane.get_aspect(), across.get_aspect()) == (1.0, 1.0)
    distances = np.array([line.get_ydata() for line in apart.lines])
    assert len(distances) == 3 and np.abs(distances - 200.0 * np.sqrt(3.0)).max() < 0.1


def test_names_of_events_that_would_cover_each_other_are_joined() -> None:
    systems = ("chaser", "target")
    events = [figures.EventMark(name, "capture", t, systems, 0.0)
              for name, t in (("one", 10.0), ("two", 10.5), ("three", 90.0))]  # fmt: skip
    _, trace = pair()
    figure = figures.energy_exchange(trace, systems, events)
    names = [text.get_text() for text in figure.axes[0].texts]
    assert names == ["one, two", "three"]


def test_a_robot_that_cannot_be_read_omits_only_the_figures_that_need_it() -> None:
    world, trace = pair()
    whole = subject(world, trace)
    part = figures.WorldSubject(trace, {"chaser": whole.models["chaser"]}, whole.events, whole.connections)
    assert [drawing.name for drawing in figures.world_drawings(part)] == ["world_energy"]


def test_systems_without_events_have_no_figures_of_an_exchange() -> None:
    world = built(data(events=[]))
    assert drawn(world, ran(world)) == {}


def test_connections_and_groups_come_from_the_events() -> None:
    world, _ = pair()
    (found,) = connections(world.scenario)
    assert found.frames == ("chaser/tool", "target/handle") and found.releases == ("let_go",)
    assert found.latch is not None and found.latch.within == [0.05, np.radians(2.0)]

    def between(a: str, b: str) -> Connection:
        return Connection("x", (a, "f"), (b, "f"))

    names = ["a", "b", "c", "d", "e"]
    assert connected_groups(names, [between("e", "b"), between("a", "c"), between("c", "e")]) == [
        ["a", "b", "c", "e"]
    ]
    assert connected_groups(names, [between("d", "c"), between("b", "a")]) == [["a", "b"], ["c", "d"]]
    assert connected_groups(names, []) == []


def test_rows_are_shared_at_common_times() -> None:
    same = np.array([0.0, 1.0, 1.0, 2.0])
    first, second = shared_rows([same, same])
    assert first.tolist() == second.tolist() == [0, 1, 2, 3]  # also both rows of an event
    first, second = shared_rows([same, np.array([0.0, 1.0, 1.5, 2.0])])
    assert (first.tolist(), second.tolist()) == ([0, 2, 3], [0, 1, 3])
