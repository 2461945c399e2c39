"""The motion relative to the reference orbit has a separate view if it is visible."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from recordings import FrameTree, column, rows_by_entity

from onorbit_rs import viewer
from onorbit_rs.scenario import Scenario, load
from onorbit_rs.scenario.build import Built, build


def recorded(folder: Path, name: str, change: Any = None, **simulation: Any) -> tuple[Path, Built, Any]:
    data = load(name).resolved()
    data["simulation"] |= simulation
    if change:
        change(data)
    built = build(Scenario(**data))
    trace = built.simulation.run(built.scenario.simulation.duration)
    return viewer.write_recording(folder / "run.rrd", trace, viewer.Setting.of(built)), built, trace


@pytest.fixture(scope="module")
def hill(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Built, Any]:
    return recorded(tmp_path_factory.mktemp("hill"), "hill_relative", record_every=20)


def test_hills_ellipse_is_drawn_in_the_axes_of_the_reference(hill: tuple[Path, Built, Any]) -> None:
    path, built, trace = hill
    ((strip,),) = column(path, "/world/flight/base/whole", "LineStrips3D:strips", static=True)
    points = np.array(strip)
    assert built.orbit is not None
    rot_wl, _ = built.orbit.lvlh(trace.time)
    np.testing.assert_allclose(points, np.einsum("tji,tj->ti", rot_wl, trace.q[:, :3]), atol=1e-4)  # 32 bits
    high, wide, _ = np.ptp(points, axis=0)
    assert wide / high == pytest.approx(2.0, rel=0.03)  # Hill's ellipse, which would look different in W
    in_w = np.ptp(trace.q[:, :3], axis=0)
    assert abs(in_w[1] / in_w[0] - 2.0) > 0.3
    pieces = [strips[0] for strips in column(path, "/world/flight/base/trail", "LineStrips3D:strips")]
    assert len(pieces) == min(1000, len(trace) - 1)
    np.testing.assert_allclose(pieces[-1][1], points[-1], atol=1e-4)


def test_the_marker_of_the_base_moves_along_the_path(hill: tuple[Path, Built, Any]) -> None:
    path, _, trace = hill
    assert column(path, "/world/flight/base", "CoordinateFrame:frame", static=True) == [["follow"]]
    np.testing.assert_allclose(FrameTree(path).pose("follow")[:, :3, 3], trace.q[:, :3], atol=1e-3)
    assert column(path, "/world/flight/base", "Points3D:labels", static=True) == [["humanoid_torso"]]


def test_a_robot_that_stays_at_the_reference_has_no_such_view(tmp_path: Path) -> None:
    path, _, _ = recorded(tmp_path, "humanoid_reach", duration=0.1)
    moving, static = rows_by_entity(path)
    assert not [entity for entity in {*moving, *static} if entity.startswith("/world/flight")]


def test_a_distant_target_is_in_the_view(tmp_path: Path) -> None:
    def far(data: dict[str, Any]) -> None:
        motion = data["reference"]["frame"]["target"]
        motion |= {"position": [50.0, 0.0, 0.0], "velocity": [-1.0, 0.0, 0.0]}
        data["reference"] |= {"kind": "hold"}
        data["reference"].pop("goal"), data["reference"].pop("duration")

    path, built, trace = recorded(tmp_path, "approach_target", far, duration=0.2)
    assert column(path, "/world/flight/target_0", "Points3D:labels", static=True) == [["target"]]
    ((strip,),) = column(path, "/world/flight/target_0/whole", "LineStrips3D:strips", static=True)
    assert built.orbit is not None
    rot_wl, _ = built.orbit.lvlh(trace.time)
    place = np.array([50.0, 0.0, 0.0]) - np.outer(trace.time, [1.0, 0.0, 0.0])
    np.testing.assert_allclose(strip, np.einsum("tji,tj->ti", rot_wl, place), atol=1e-5)


def test_the_bundled_target_is_a_box_in_front_of_the_tool(tmp_path: Path) -> None:
    path, _, trace = recorded(tmp_path, "approach_target", time_step=0.01)
    half = np.array(column(path, "/world/target/0", "Boxes3D:half_sizes", static=True)[0][0])
    np.testing.assert_allclose(half, [0.15, 0.2, 0.15])
    pose = np.linalg.inv(FrameTree(path).pose("target/0")) @ trace.tool_pose
    np.testing.assert_allclose(pose[-1, :3, 3], [-0.2, 0.0, 0.0], atol=1e-4)
    outside = np.maximum(np.abs(pose[:, :3, 3]) - half, 0.0).max(axis=1)
    assert outside.min() > 0.04, "the tool goes through the satellite"
