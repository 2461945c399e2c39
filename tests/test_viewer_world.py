"""Recordings of several systems: one subtree each, one scene, relative motion, and the events."""

from __future__ import annotations

import copy
from pathlib import Path

import numpy as np
import pytest
from recordings import FrameTree, column, rows_by_entity
from world_runs import built, data, pair, ran, trio

import onorbit_rs as oo
from onorbit_rs import viewer
from onorbit_rs.common.frame_motion import MovingFrame, frame_motion
from onorbit_rs.common.rotations import local_orbital_axes
from onorbit_rs.output import summarize_world
from onorbit_rs.viewer.world_rows import WorldRows
from onorbit_rs.viewer.world_series import SHARED, world_series

SINGLE = 1e-6
"""Rounding in 32 bits of positions of a few metres at each of ten frames."""


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    world, trace = pair()
    path = tmp_path_factory.mktemp("pair") / "run.rrd"
    notes = viewer.world_notes(summarize_world(trace, world), world.scenario)
    return viewer.write_world_recording(path, trace, viewer.WorldSetting.of(world), notes=notes)


def test_every_system_has_its_subtree_with_every_row(recording: Path) -> None:
    _, trace = pair()
    moving, static = rows_by_entity(recording)
    steps = len(trace["chaser"])
    assert steps == 51 + 2  # each event has a row before and a row after it
    for name, links in (("chaser", 8), ("target", 1)):
        frames = [entity for entity in moving if entity.startswith(f"/frames/{name}/robot/")]
        assert len(frames) == links
        for entity in (
            *frames,
            f"/plots/{name}/base_rate",
            f"/exact/{name}/position_eci",
            f"/orbit/spacecraft/{name}",
        ):
            assert moving[entity] == steps, entity
        assert any(entity.startswith(f"/world/{name}/robot/") for entity in static)
        assert {f"/world/{name}/axes/base", f"/world/{name}/axes/lvlh"} <= set(static)
    assert {"/world/lvlh/lvlh", "/world/lvlh/inertial", "/orbit/planet", "/notes"} <= set(static)
    assert not [entity for entity in static if entity.startswith(("/world/robot", "/world/axes"))]


def test_all_frames_have_the_poses_of_the_engine(recording: Path) -> None:
    world, trace = pair()
    tree = FrameTree(recording)
    for name, frame_of_grasp in (("chaser", "tool"), ("target", "handle")):
        model = world.systems[name].model
        for frame in (*model.body_names, frame_of_grasp):
            truth = model.frame_pose(trace[name].q, frame)
            np.testing.assert_allclose(tree.pose(f"{name}/robot/{frame}"), truth, atol=SINGLE)
    # the camera on both moves with their centre of mass, in the axes of L
    masses = [world.systems[name].model.mass for name in trace.names]
    places = [trace[name].center_of_mass for name in trace.names]
    center = np.average(places, axis=0, weights=masses)
    follow = tree.pose("follow")
    axes = local_orbital_axes(trace["chaser"].reference_position_eci, trace["chaser"].reference_velocity_eci)
    np.testing.assert_allclose(follow[:, :3, :3], axes, atol=SINGLE)
    np.testing.assert_allclose(follow[:, :3, 3], center, atol=SINGLE)


def test_captured_frames_have_axes_that_coincide_while_connected(recording: Path) -> None:
    _, trace = pair()
    assert column(recording, "/world/chaser/grasp/tool", "CoordinateFrame:frame", static=True) == [
        ["chaser/robot/tool"]
    ]
    assert column(recording, "/world/target/grasp/handle/name", "Points3D:labels", static=True) == [
        ["target/handle"]
    ]
    tree = FrameTree(recording)
    relative = np.linalg.inv(tree.pose("chaser/robot/tool")) @ tree.pose("target/robot/handle")
    time = np.asarray(trace["chaser"].time)
    grasp, let_go = (event.time for event in trace.events)
    held = np.flatnonzero((time > grasp) & (time < let_go))
    np.testing.assert_allclose(
        relative[held], np.broadcast_to(relative[held[0]], (len(held), 4, 4)), atol=2 * SINGLE
    )
    assert np.abs(relative[-1] - relative[held[0]]).max() > 1e-3  # separated by the spring


def test_events_are_logged_marked_and_change_the_state_of_the_connection(recording: Path) -> None:
    texts = [text[0] for text in column(recording, "/events", "TextLog:text")]
    assert [text.split(",")[0] for text in texts] == ["grasp: capture", "let_go: release"]
    assert all("momentum errors" in text and "target/handle by chaser/tool" in text for text in texts)
    assert "lost" in texts[0] and "added" in texts[1] and "impulse 2 N s" in texts[1]
    states = [state[0] for state in column(recording, "/connections/grasp", "StateChange:state")]
    assert states == ["free", "connected", "free"]
    energy = f"/{SHARED}kinetic_energy"
    marks = np.ravel(column(recording, f"{energy}/events", "Scalars:scalars"))
    plotted = np.array(column(recording, energy, "Scalars:scalars"))[:, -1]
    assert len(marks) == 2 and set(marks) <= set(plotted)
    ((label,),) = column(recording, "/world/lvlh/events/grasp", "Points3D:labels")[:1]
    assert label.startswith("grasp: capture") and label.endswith("lost")
    ((arrow,), *_) = column(recording, "/world/chaser/events/let_go", "Arrows3D:vectors")
    direction = np.array(arrow) / np.linalg.norm(arrow)
    np.testing.assert_allclose(direction, [0, 0, 1], atol=1e-6)  # of the spring, in axes of the tool
    ((notes,),) = column(recording, "/notes", "TextDocument:text", static=True)
    assert "grasp (capture)" in notes.replace("\\", "") and "## chaser" in notes


def test_plots_of_all_systems_have_the_numbers_of_the_traces() -> None:
    world, trace = pair()
    rows = WorldRows.of_trace(trace, viewer.WorldSetting.of(world))
    plots = {series.path.removeprefix(SHARED): series for _, series in world_series(rows, is_live=True)}
    # the sums of the systems are the momentum of the world, which the engine computes
    for part, first in (("linear", 0), ("angular", 3)):
        for axis in range(3):
            series = plots[f"{part}_momentum_{'xyz'[axis]}"]
            assert series.names == ("chaser", "target", "sum")
            scale = np.abs(trace.momentum[:, first : first + 3]).max()
            np.testing.assert_allclose(
                series.values[:, -1], trace.momentum[:, first + axis], atol=1e-11 * scale
            )
    alone = trace["chaser"].momentum[:, 3:] + trace["target"].momentum[:, 3:]
    assert np.abs(alone - trace.momentum[:, 3:]).max() > 1.0  # each about the centre of mass of the system
    np.testing.assert_allclose(plots["kinetic_energy"].values[:, -1], trace.kinetic_energy, rtol=1e-12)
    moving = [MovingFrame(world.systems[name].model, frame, trace[name].q, trace[name].v)
              for name, frame in (("chaser", "tool"), ("target", "handle"))]  # fmt: skip
    np.testing.assert_array_equal(plots["connections/grasp/position"].values, frame_motion(*moving).position)
    assert "distance" in plots and "radial" in plots


def test_systems_with_rows_at_different_times_are_recorded(tmp_path: Path) -> None:
    world, trace = trio()
    assert len(trace["third"]) < len(trace["chaser"])
    path = viewer.write_world_recording(tmp_path / "run.rrd", trace, viewer.WorldSetting.of(world))
    moving, _ = rows_by_entity(path)
    for name in trace.names:
        assert moving[f"/plots/{name}/base_rate"] == len(trace[name])
    assert moving["/frames/L"] == len(np.unique(trace["chaser"].time))
    assert moving[f"/{SHARED}distance"] == len(np.unique(trace["third"].time))
    assert moving["/world/third/flight/base/trail"] > 0  # 40 m apart: their relative flight is shown
    assert column(path, "/world/third/flight/base", "Points3D:labels", static=True) == [["third"]]


def test_the_flight_of_a_formation_is_in_l_of_the_reference(tmp_path: Path) -> None:
    world = built("formation")
    trace = ran(world)
    path = viewer.write_world_recording(tmp_path / "run.rrd", trace, viewer.WorldSetting.of(world))
    ((strip,),) = column(path, "/world/second/flight/base/whole", "LineStrips3D:strips", static=True)
    rot_wl, _ = world.orbit.lvlh(trace.time)
    np.testing.assert_allclose(strip, np.einsum("tji,tj->ti", rot_wl, trace["second"].q[:, :3]), atol=1e-4)
    (labels,) = {
        tuple(row) for row in column(path, "/orbit/spacecraft/first", "Points3D:labels", static=True)
    }
    assert labels == ("first, second, third",)  # 350 m apart, on an orbit of 6778 km


def test_a_world_without_an_orbit_is_recorded(tmp_path: Path) -> None:
    values = data(environment=[])
    values.pop("orbit")
    world = built(values)
    trace = ran(world)
    path = viewer.write_world_recording(tmp_path / "run.rrd", trace, viewer.WorldSetting.of(world))
    tree = FrameTree(path)
    assert tree.parents["chaser/follow"] == tree.parents["follow"] == "W"
    truth = world.systems["target"].model.frame_pose(trace["target"].q, "handle")
    np.testing.assert_allclose(tree.pose("target/robot/handle"), truth, atol=SINGLE)


def test_a_recording_of_a_world_made_in_python_needs_no_scenario(tmp_path: Path) -> None:
    model = oo.Model.rigid_body(10.0, np.eye(3))
    q = model.neutral()
    q[1] = 3.0
    systems = [oo.System("a", model, model.neutral(), np.zeros(6)), oo.System("b", model, q, np.full(6, 0.1))]
    trace = oo.Simulation(oo.World(systems), time_step=0.1).run(1.0)
    setting = viewer.WorldSetting({name: viewer.Setting(model, system=name) for name in ("a", "b")})
    moving, _ = rows_by_entity(viewer.write_world_recording(tmp_path / "run.rrd", trace, setting))
    assert moving["/frames/a/robot/base"] == moving["/frames/b/robot/base"] == 11


def test_a_run_that_was_stopped_at_its_start_is_recorded(tmp_path: Path) -> None:
    world, _ = pair()
    trace = world.simulation.start(duration=1.0).finish()
    path = viewer.write_world_recording(tmp_path / "run.rrd", trace, viewer.WorldSetting.of(world))
    moving, _ = rows_by_entity(path)
    assert moving["/plots/chaser/base_rate"] == 1 and moving["/connections/grasp"] == 1


def test_spacecraft_have_the_colours_of_their_lines(tmp_path: Path) -> None:
    world = built("formation")
    path = viewer.write_world_recording(tmp_path / "run.rrd", ran(world), viewer.WorldSetting.of(world))
    (lines,) = column(path, f"/{SHARED}radial", "SeriesLines:colors", static=True)
    for name, color in zip(world.systems, lines, strict=True):
        assert column(path, f"/world/{name}/flight/base", "Points3D:colors", static=True) == [[color]]


def test_a_plot_marks_only_the_events_of_its_systems(tmp_path: Path) -> None:
    """Two pairs that never meet, each with its capture."""
    values = data()
    systems = values["systems"]
    for name, other in (("tug", "chaser"), ("barge", "target")):
        systems[name] = copy.deepcopy(systems[other])
    systems["tug"]["initial"]["position"] = [0, 30.0, 0]
    systems["barge"]["initial"]["frame"] = "tug/tool"
    dock = {"name": "dock", "when": {"at": 0.2}, "do": {"capture": ["tug/tool", "barge/handle"]}}
    values["events"].append(dock)
    world = built(values)
    path = viewer.write_world_recording(tmp_path / "run.rrd", ran(world), viewer.WorldSetting.of(world))
    moving, _ = rows_by_entity(path)
    counts = {"groups/chaser/kinetic_energy": 2, "groups/tug/kinetic_energy": 1,
              "connections/grasp/position": 2, "connections/dock/position": 1}  # fmt: skip
    assert {plot: moving[f"/{SHARED}{plot}/events"] for plot in counts} == counts
    assert moving[f"/{SHARED}distance/events"] == moving["/events"] == 3
