"""Recordings contain every entity with every step."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rerun as rr
from recordings import FrameTree, column, rows_by_entity
from rerun.chunk import RrdReader

import onorbit_rs as oo
from onorbit_rs import viewer
from onorbit_rs.exceptions import ViewerError
from onorbit_rs.scenario import Scenario, load
from onorbit_rs.scenario.build import Built, build
from onorbit_rs.viewer.encoded import Encoded
from onorbit_rs.viewer.series import series_of
from onorbit_rs.viewer.trace_rows import TraceRows
from onorbit_rs.visuals.shapes import shapes

STEPS = 51
SINGLE = 1e-6
"""Rounding in 32 bits of a robot of two metres: 2e-7 m at each of ten frames."""


def built_reach(record_every: int = 20) -> Built:
    data = load("humanoid_reach").resolved()
    del data["epoch"]  # a rotating Earth has separate rows, tested in test_viewer_scene.py
    data["simulation"] |= {"time_step": 2e-3, "record_every": record_every}
    return build(Scenario(**data))


@pytest.fixture(scope="module")
def reach() -> tuple[Built, oo.Trace]:
    built = built_reach()
    return built, built.simulation.run(2.0)


@pytest.fixture(scope="module")
def recording(reach: tuple[Built, oo.Trace], tmp_path_factory: pytest.TempPathFactory) -> Path:
    built, trace = reach
    path = tmp_path_factory.mktemp("reach") / "run.rrd"
    return viewer.write_recording(path, trace, viewer.Setting.of(built), notes="# notes")


def test_every_entity_has_every_step(reach: tuple[Built, oo.Trace], recording: Path) -> None:
    moving, static = rows_by_entity(recording)
    frames = {f"/frames/{name}" for name in ("L", "follow", "compass", "base_axes", "desired")}
    plots = {
        "joint_torque", "joint_position", "joint_rate", "tool_position_error", "tool_attitude_error",
        "linear_momentum", "angular_momentum", "energy", "base_position", "base_rate", "base_attitude",
        "base_attitude_lvlh",
    }  # fmt: skip
    expected = (
        frames
        | {f"/frames/robot/{link}" for link in reach[0].model.body_names}
        | {f"/plots/{name}" for name in plots}
        | {"/orbit/spacecraft", "/exact/position_eci", "/exact/velocity_eci"}
    )
    assert {entity: moving[entity] for entity in expected} == dict.fromkeys(expected, STEPS)
    assert moving["/world/tool/obtained/trail"] == STEPS - 1
    assert set(moving) == expected | {"/world/tool/obtained/trail"}
    drawn = [entity for entity in static if "/visual_" in entity]
    assert len(drawn) == len(shapes(reach[0].model)) > 8
    assert {
        "/world/tool/desired/path", "/world/tool/desired/goal", "/world/axes/base", "/world/axes/tool",
        "/world/axes/lvlh", "/world/axes/inertial", "/orbit/planet", "/orbit/reference", "/orbit/path",
        "/notes", "/frames/robot/tool",
    } <= set(static)  # fmt: skip


def test_the_frames_give_every_link_the_pose_of_the_engine(
    reach: tuple[Built, oo.Trace], recording: Path
) -> None:
    built, trace = reach
    tree = FrameTree(recording)
    chain = ["robot/tool"]
    while chain[-1] != "W":
        chain.append(tree.parents[chain[-1]])
    links = [f"robot/arm_link_{index}" for index in range(7, 0, -1)]
    assert chain == ["robot/tool", *links, "robot/torso", "follow", "L", "W"]
    for link in (*built.model.body_names, "tool"):
        truth = built.model.frame_pose(trace.q, link)
        np.testing.assert_allclose(tree.pose(f"robot/{link}"), truth, atol=SINGLE)
    np.testing.assert_allclose(tree.pose("robot/tool"), trace.tool_pose, atol=SINGLE)
    np.testing.assert_allclose(tree.pose("desired"), trace.reference_pose, atol=SINGLE)
    # the eye moves with the base, in the axes of L
    follow = tree.pose("follow")
    np.testing.assert_allclose(follow[:, :3, 3], trace.q[:, :3], atol=SINGLE)
    np.testing.assert_allclose(follow[:, :3, 0], unit(trace.position_eci), atol=SINGLE)
    inertial = tree.pose("compass")[:, :3, :3]
    np.testing.assert_allclose(inertial, np.tile(np.eye(3), (STEPS, 1, 1)), atol=SINGLE)
    # frames of sibling links are not nested
    assert np.abs(tree.pose("robot/arm_link_2") - tree.pose("robot/arm_link_1")).max() > 0.1


def unit(vectors: Any) -> Any:
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def test_prismatic_joints_move_along_their_axes(tmp_path: Path) -> None:
    links = "".join(
        f'<link name="{name}"><inertial><mass value="2"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" '
        'iyz="0"/></inertial></link>'
        for name in ("a", "b", "c")
    )
    text = (
        f'<robot name="slider">{links}<joint name="s" type="prismatic"><parent link="a"/><child link="b"/>'
        '<origin xyz="0.1 0.2 0.3" rpy="0.3 0.2 0.1"/><axis xyz="1 2 2"/>'
        '<limit lower="-1" upper="1" effort="1" velocity="1"/></joint><joint name="r" type="continuous">'
        '<parent link="b"/><child link="c"/><origin xyz="0 0 1" rpy="1 0 0"/><axis xyz="0 1 1"/></joint>'
        "</robot>"
    )
    model = oo.Model.from_urdf_string(text)
    rates = np.array([0, 0, 0, 0.1, 0.2, 0.3, 0.4, 0.5])
    trace = oo.Simulation(model, model.neutral(), rates, time_step=0.1).run(1.0)
    plots = {plot.path: plot.unit for plot in series_of(TraceRows.of_trace(trace), viewer.Setting(model))}
    units = [plots[f"plots/joint_{name}"] for name in ("torque", "position", "rate")]
    assert units == ["N m", "rad", "rad/s"]
    units = [plots[f"plots/slide_{name}"] for name in ("force", "position", "rate")]
    assert units == ["N", "m", "m/s"]
    tree = FrameTree(viewer.write_recording(tmp_path / "run.rrd", trace, viewer.Setting(model)))
    for link in model.body_names:
        np.testing.assert_allclose(tree.pose(f"robot/{link}"), model.frame_pose(trace.q, link), atol=SINGLE)


def test_the_recording_holds_the_numbers_of_the_trace(reach: tuple[Built, oo.Trace], recording: Path) -> None:
    trace = reach[1]
    np.testing.assert_array_equal(column(recording, "/plots/joint_torque", "Scalars:scalars"), trace.tau)
    positions = column(recording, "/exact/position_eci", "Scalars:scalars")
    np.testing.assert_array_equal(positions, trace.position_eci)  # f64, not f32
    (trail,) = {
        len(strip[0]) for strip in column(recording, "/world/tool/obtained/trail", "LineStrips3D:strips")
    }
    assert trail == 2


def test_plots_show_minimum_and_maximum_of_the_values_at_a_pixel(recording: Path) -> None:
    """The mean of a torque that chatters between ±100 N m would be almost zero."""
    (policy,) = column(recording, "/plots/joint_torque", "SeriesLines:aggregation_policy", static=True)
    assert policy == [rr.components.AggregationPolicy.MinMax.value]


def test_no_wall_clock_and_a_blueprint(recording: Path) -> None:
    reader = RrdReader(recording)
    names = {name for chunk in reader.stream().to_chunks() for name in chunk.timeline_names}
    assert names == {viewer.TIMELINE}
    assert len(reader.recordings()) == len(reader.blueprints()) == 1


def test_a_hundred_thousand_steps_are_recorded(tmp_path: Path) -> None:
    built = built_reach(1)
    trace = built.simulation.run(200.0)
    assert len(trace) == 100_001
    path = viewer.write_recording(tmp_path / "run.rrd", trace, viewer.Setting.of(built))
    moving, _ = rows_by_entity(path)
    assert moving.pop("/world/tool/obtained/trail") == 1000
    assert set(moving.values()) == {100_001}


on_linux = pytest.mark.skipif(not hasattr(os, "memfd_create"), reason="only Linux has files in memory")


@on_linux
def test_without_files_in_memory_the_recording_is_the_same(
    reach: tuple[Built, oo.Trace], recording: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delattr("os.memfd_create")
    path = viewer.write_recording(
        tmp_path / "run.rrd", reach[1], viewer.Setting.of(reach[0]), notes="# notes"
    )
    assert rows_by_entity(path) == rows_by_entity(recording)


@on_linux
def test_a_truncated_recording_is_an_error(
    reach: tuple[Built, oo.Trace], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    flush = rr.RecordingStream.flush

    def flush_and_cut(self: rr.RecordingStream, **options: float) -> None:
        flush(self, **options)
        self.disconnect()
        for entry in Path("/proc/self/fd").iterdir():
            if "run.rrd" in str(entry.resolve()):
                os.truncate(entry, 1000)

    monkeypatch.setattr(rr.RecordingStream, "flush", flush_and_cut)
    with pytest.raises(ViewerError, match="did not encode the recording: it is truncated"):
        viewer.write_recording(tmp_path / "run.rrd", reach[1], viewer.Setting.of(reach[0]))


@on_linux
def test_an_encoder_that_does_not_answer_raises_a_viewer_error_without_a_leak(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def silent(self: rr.RecordingStream, **options: float) -> None:
        raise RuntimeError("no answer")

    def in_memory() -> int:
        return sum("run.rrd" in str(entry.resolve()) for entry in Path("/proc/self/fd").iterdir())

    recording = rr.RecordingStream("onorbit", send_properties=False)
    encoded = Encoded(recording)
    both = in_memory()  # the package's and rerun's
    monkeypatch.setattr(rr.RecordingStream, "flush", silent)
    with pytest.raises(ViewerError, match="did not encode the recording: no answer"):
        encoded.write_to(tmp_path / "run.rrd")
    assert in_memory() < both


def test_long_traces_are_decimated_including_the_last_row_with_a_note(
    reach: tuple[Built, oo.Trace], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for count in (1, 2, 500_000, 500_001, 1_234_567):
        rows = viewer.recorded_rows(count)
        assert rows[0] == 0 and rows[-1] == count - 1
        assert len(rows) <= 500_001
        assert np.all(np.diff(rows) > 0)
    assert len(viewer.recorded_rows(500_000)) == 500_000
    monkeypatch.setattr("onorbit_rs.viewer.recording.MOST_STEPS", 20)
    path = viewer.write_recording(
        tmp_path / "run.rrd", reach[1], viewer.Setting.of(reach[0]), notes="# notes"
    )
    assert rows_by_entity(path)[0]["/frames/robot/torso"] == 18  # every third of 51, and the last
    ((text,),) = column(path, "/notes", "TextDocument:text", static=True)
    assert "18 of the 51 rows" in text


def test_a_body_without_geometry_is_drawn_as_the_box_of_its_inertia() -> None:
    sides = np.array([0.4, 0.7, 1.1])
    mass = 30.0
    inertia = mass / 12.0 * np.diag(sides @ sides - sides**2)
    (box,) = shapes(oo.Model.rigid_body(mass, inertia))
    assert box.kind == "box" and box.link == "base"
    extent = np.abs(box.pose[:3, :3]) @ np.array(box.size)
    np.testing.assert_allclose(extent, sides, rtol=1e-12)
