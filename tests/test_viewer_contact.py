"""Contacts in recordings: points and forces while they act, one scale, held marks, collision shapes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from recordings import chunks, column, rows_by_entity
from world_runs import built, ran

import onorbit_rs as oo
from onorbit_rs import viewer
from onorbit_rs.viewer.blueprint import playback_speed
from onorbit_rs.viewer.contact_marks import COLOR, HELD, HELD_FOR, marks_of
from onorbit_rs.visuals.convex_hull import PRECISION, convex_hull


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Any]:
    world = built("two_spheres")
    trace = ran(world)
    path = tmp_path_factory.mktemp("spheres") / "run.rrd"
    return viewer.write_world_recording(path, trace, viewer.WorldSetting.of(world)), trace


def times_of(path: Path, entity: str) -> np.ndarray:
    found = [chunk.to_record_batch().column("simulation_time").cast("int64").to_pylist()
             for chunk in chunks(path) if chunk.entity_path == entity and not chunk.is_static]  # fmt: skip
    return np.sort(np.concatenate(found)) * 1e-9


def test_a_mark_exists_from_touch_down_until_it_was_seen(recorded: tuple[Path, Any]) -> None:
    path, trace = recorded
    down, up = (event.time for event in trace.events)
    held_s = HELD_FOR * playback_speed(float(trace.time[-1]))
    assert up - down < held_s  # otherwise this test would not cover the held mark
    times = times_of(path, "/world/contacts/impact/force")
    vectors = column(path, "/world/contacts/impact/force", "Arrows3D:vectors")
    counts = np.array([len(row) for row in vectors])
    assert down - 1e-9 <= times[1] < down + 1e-4  # the first row of the run has no mark
    assert counts[0] == counts[-1] == 0 and (counts[1:-1] == 1).all()
    assert abs(times[-1] - (down + held_s)) < 0.011  # one row of the trace
    # without the held mark, nothing would be shown after lift-off
    colors = column(path, "/world/contacts/impact/point", "Points3D:colors")
    red = [(row[0] >> 24, row[0] >> 16 & 255, row[0] >> 8 & 255) for row in colors if row]
    assert {color for color, t in zip(red, times[1:], strict=False) if t < up - 1e-6} == {COLOR}
    assert {color for color, t in zip(red, times[1:], strict=False) if t > up} == {HELD}


def test_points_and_forces_are_those_of_the_trace_on_the_stated_scale(recorded: tuple[Path, Any]) -> None:
    path, trace = recorded
    touch, time = trace.contacts["impact"], np.asarray(trace["still"].time)
    ((text, *_),) = column(path, "/world/lvlh/contacts", "Points3D:labels")
    assert text.startswith("contact forces on the second side: 1 m = ") and text.endswith(" N")
    scale = float(text.split()[-2])
    acts = np.flatnonzero(np.any(np.asarray(touch.force) != 0.0, axis=1))
    vectors = column(path, "/world/contacts/impact/force", "Arrows3D:vectors")
    points = column(path, "/world/contacts/impact/point", "Points3D:positions")
    for number, row in enumerate(acts, 1):
        np.testing.assert_allclose(np.array(vectors[number][0]) * scale, touch.force[row], atol=1e-4)
        np.testing.assert_allclose(points[number][0], touch.point[row], atol=1e-6)
    largest = acts[np.argmax(np.linalg.norm(np.asarray(touch.force)[acts], axis=1))]
    np.testing.assert_allclose(np.array(vectors[len(acts) + 1][0]) * scale, touch.force[largest], rtol=1e-5)
    assert time[acts[-1]] < trace.events[1].time
    shown = times_of(path, "/world/contacts/impact/force")[1 : len(acts) + 1]
    np.testing.assert_allclose(shown, time[acts], atol=1e-9)


def test_held_marks_end_at_the_next_touch_and_move_with_the_center() -> None:
    time = np.arange(10.0)
    force, point, center = np.zeros((10, 3)), np.zeros((10, 3)), np.zeros((10, 3))
    force[[2, 3, 5], 0] = [4.0, 3.0, 1.0]
    center[:, 1] = time
    marks = marks_of(time, force, point, center, held_s=3.5)
    assert marks.times.tolist() == [0, 2, 3, 4, 5, 6, 7, 8, 9]
    assert marks.is_shown.tolist() == [False] + [True] * 7 + [False]
    assert marks.is_held.tolist() == [False, False, False, True, False, True, True, True, False]
    assert marks.forces[1:8, 0].tolist() == [4, 3, 4, 1, 1, 1, 1]
    assert marks.points[3, 1] == 2.0 and marks.points[7, 1] == 3.0
    now = marks_of(time, force, point, center, held_s=0.0)
    assert not now.is_held.any() and now.times[now.is_shown].tolist() == [2, 3, 5]


def test_collision_shapes_are_recorded_in_the_frames_of_their_links(recorded: tuple[Path, Any]) -> None:
    path, _ = recorded
    _, static = rows_by_entity(path)
    entity = "/world/still/collision/body/collision_0"
    assert entity in static
    assert column(path, entity, "CoordinateFrame:frame", static=True) == [["still/robot/body"]]
    assert column(path, entity, "Ellipsoids3D:half_sizes", static=True)[0][0] == pytest.approx([0.1] * 3)


def test_a_run_without_contacts_has_no_marks(tmp_path: Path) -> None:
    world = built("formation")
    path = viewer.write_world_recording(tmp_path / "run.rrd", ran(world), viewer.WorldSetting.of(world))
    moving, static = rows_by_entity(path)
    assert not [entity for entity in (*moving, *static) if "contacts" in entity]


def test_the_hull_contains_all_points_and_is_closed() -> None:
    random = np.random.default_rng(5)
    points = random.normal(size=(400, 3))
    vertices, faces = convex_hull(points)
    a, b, c = np.moveaxis(vertices[faces], 1, 0)
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    outside = (normal @ points.T - np.einsum("fi,fi->f", normal, a)[:, None]).max()
    assert outside <= PRECISION * np.linalg.norm(np.ptp(points, axis=0))
    assert len(vertices) - 3 * len(faces) // 2 + len(faces) == 2  # Euler
    cube = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    vertices, faces = convex_hull(np.vstack([cube, random.uniform(size=(50, 3))]))
    assert len(vertices) == 8 and len(faces) == 12
    flat, none = convex_hull(cube[cube[:, 2] == 0.0])
    assert len(flat) == len(none) == 0


def test_collision_shapes_are_primitives_and_hulls_of_meshes(tmp_path: Path) -> None:
    setting = viewer.Setting(oo.robots.load("pusher"))
    assert {shape.kind for shape in setting.collisions} == {"box", "capsule", "sphere"}
    corners = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    lines = [f"v {x} {y} {z}" for x, y, z in [*corners, (0.5, 0.5, 0.5)]]  # the last one is inside
    lines += [f"f {a} {b} 9" for a, b in ((1, 2), (3, 4), (5, 6), (7, 8))]
    (tmp_path / "star.obj").write_text("\n".join(lines))
    inertial = (
        '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
    )
    shape = '<collision><geometry><mesh filename="star.obj"/></geometry></collision>'
    (tmp_path / "star.urdf").write_text(
        f'<robot name="star"><link name="body">{inertial}{shape}</link></robot>'
    )
    (hull,) = viewer.Setting(oo.Model.from_urdf(tmp_path / "star.urdf")).collisions
    assert hull.mesh is not None
    (part,) = hull.mesh.parts
    assert sorted(map(tuple, part.vertices.tolist())) == corners and len(part.faces) == 12
