"""The recording, read back: every entity is there with every step."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from rerun.chunk import RrdReader

import onorbit_rs as oo
from onorbit_rs import viewer
from onorbit_rs.geometry import shapes
from onorbit_rs.scenario import load

STEPS = 51


@pytest.fixture(scope="module")
def reach() -> oo.Run:
    data = load("humanoid_reach").resolved()
    data["simulation"] |= {"duration": 0.1, "time_step": 2e-3}
    return oo.run(data, quiet=True)


def rows_by_entity(path: Path) -> tuple[Counter[str], Counter[str]]:
    """Rows per entity: those over time, and the static ones."""
    moving, static = Counter[str](), Counter[str]()
    for chunk in RrdReader(path).stream().to_chunks():
        (static if chunk.is_static else moving)[chunk.entity_path] += chunk.num_rows
    return moving, static


def test_every_entity_has_every_step(reach: oo.Run, tmp_path: Path) -> None:
    path = viewer.write_recording(
        tmp_path / "run.rrd", reach.trace, reach.model, title="reach", notes="# notes"
    )
    moving, static = rows_by_entity(path)
    links = {reach.model.body_names[0], *(shape.link for shape in shapes(reach.model))}
    expected = {f"/world/robot/{link}" for link in links} | {
        "/world/tool/desired/now", "/world/tool/obtained/now", "/world/frames/lvlh", "/orbit/spacecraft",
        "/plots/joint_torque", "/plots/joint_position", "/plots/joint_rate", "/plots/tool_position_error",
        "/plots/tool_attitude_error", "/plots/linear_momentum", "/plots/angular_momentum", "/plots/energy",
        "/plots/base_position", "/plots/base_attitude",
        "/plots/base_attitude_lvlh", "/exact/position_eci", "/exact/velocity_eci",
    }  # fmt: skip
    assert {entity: moving[entity] for entity in expected} == dict.fromkeys(expected, STEPS)
    assert moving["/world/tool/obtained/trail"] == STEPS - 1
    assert set(moving) == expected | {"/world/tool/obtained/trail"}
    drawn = [entity for entity in static if "/visual_" in entity]
    assert len(drawn) == len(shapes(reach.model)) > 8
    assert {"/world/tool/desired/path", "/world/frames/inertial", "/orbit/planet", "/notes"} <= set(static)


def test_the_recording_holds_the_numbers_of_the_trace(reach: oo.Run, tmp_path: Path) -> None:
    path = viewer.write_recording(tmp_path / "run.rrd", reach.trace, reach.model)
    times, torques, positions = [], [], []
    for chunk in RrdReader(path).stream().to_chunks():
        if chunk.is_static or chunk.entity_path not in ("/plots/joint_torque", "/exact/position_eci"):
            continue
        batch = chunk.to_record_batch()
        scalars = np.array(batch.column("Scalars:scalars").to_pylist())
        if chunk.entity_path == "/plots/joint_torque":
            torques.append(scalars)
            seconds = batch.column(viewer.TIMELINE).cast("int64").to_numpy(zero_copy_only=False) * 1e-9
            times.append(seconds)
        else:
            positions.append(scalars)
    np.testing.assert_allclose(
        np.concatenate(times), reach.trace.time, atol=1e-9
    )  # the file counts nanoseconds
    np.testing.assert_array_equal(np.concatenate(torques), reach.trace.tau)
    np.testing.assert_array_equal(np.concatenate(positions), reach.trace.position_eci)  # f64, not f32


def test_no_wall_clock_and_a_blueprint(reach: oo.Run, tmp_path: Path) -> None:
    path = viewer.write_recording(tmp_path / "run.rrd", reach.trace, reach.model, title="reach")
    reader = RrdReader(path)
    names = {name for chunk in reader.stream().to_chunks() for name in chunk.timeline_names}
    assert names == {viewer.TIMELINE}
    assert len(reader.recordings()) == len(reader.blueprints()) == 1


def test_a_body_without_geometry_is_drawn_as_the_box_of_its_inertia() -> None:
    sides = np.array([0.4, 0.7, 1.1])
    mass = 30.0
    inertia = mass / 12.0 * np.diag(sides @ sides - sides**2)
    (box,) = shapes(oo.Model.rigid_body(mass, inertia))
    assert box.kind == "box" and box.link == "base"
    extent = np.abs(box.pose[:3, :3]) @ np.array(box.size)
    np.testing.assert_allclose(extent, sides, rtol=1e-12)


def test_long_traces_are_thinned_to_their_last_row() -> None:
    for count in (1, 2, 50_000, 50_001, 123_457):
        rows = viewer.recorded_rows(count)
        assert rows[0] == 0 and rows[-1] == count - 1
        assert len(rows) <= 50_001
        assert np.all(np.diff(rows) > 0)
    assert len(viewer.recorded_rows(50_000)) == 50_000


def test_no_recording_no_picture(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match="no such recording"):
        viewer.take_screenshot(tmp_path / "run.rrd", tmp_path / "run.png")
