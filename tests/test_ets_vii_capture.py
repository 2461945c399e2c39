"""The bundled capture by the arm of ETS-VII: its events, and the target docked at the port."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo

pytestmark = pytest.mark.filterwarnings("ignore:the inertia of link 'link_5'")  # as published


@pytest.fixture(scope="module")
def run() -> oo.Run:
    return oo.run("ets_vii_capture", quiet=True)


def world(run: oo.Run) -> oo.WorldTrace:
    assert isinstance(run.trace, oo.WorldTrace)
    return run.trace


def relative(run: oo.Run, by: str, of: str) -> Any:
    """Returns the poses (T, 4, 4) of a frame of the target in a frame of the chaser."""
    one = run.models["chaser"].frame_pose(world(run)["chaser"].q, by)
    other = run.models["target"].frame_pose(world(run)["target"].q, of)
    return np.linalg.solve(one, other)


def angle(poses: Any) -> Any:
    trace = np.trace(np.asarray(poses)[..., :3, :3], axis1=-2, axis2=-1)
    return np.degrees(np.arccos(np.clip((trace - 1.0) / 2.0, -1.0, 1.0)))


def test_the_target_is_grasped_released_and_docked(run: oo.Run) -> None:
    assert run.summary["certificate_passed"], run.summary["certificate_failures"]
    grasp, let_go, docked = world(run).events
    assert [event.kind for event in (grasp, let_go, docked)] == ["capture", "release", "capture"]
    assert 15.0 < grasp.time < 25.0 and (let_go.time, docked.time) == (140.0, 141.0)
    # the target of 410 kg drifts at 1 mm/s, and the arm yields
    assert 0.01 < np.linalg.norm(grasp.impulse[:3]) < 0.41
    assert 0.0 < docked.energy_lost < 1e-8  # J: gravity has moved it for a second


def test_the_target_moves_into_the_port_along_its_axis(run: oo.Run) -> None:
    docking, time = relative(run, "docking_port", "docking_fixture"), world(run).time
    assert docking[0, 2, 3] == pytest.approx(0.32, abs=1e-9)
    near = (docking[:, 2, 3] < 0.05) & (time < 140.0)
    assert np.linalg.norm(docking[near, :2, 3], axis=1).max() < 5e-3 and angle(docking[near]).max() < 0.2
    assert docking[:, 2, 3].min() > -1e-9  # it does not enter the port
    assert docking[time < 140.0, 2, 3][-1] == pytest.approx(0.02, abs=1e-3)
    held = docking[time > 151.0]  # seated
    assert np.abs(held - np.eye(4)).max() < 1e-9


def test_the_grasp_is_rigid_and_the_arm_retreats(run: oo.Run) -> None:
    grasp, let_go, _ = world(run).events
    handle, time = relative(run, "tool", "handle"), world(run).time
    caught = handle[np.flatnonzero(time == grasp.time)[-1]]
    assert 1e-5 < np.linalg.norm(caught[:3, 3]) < 0.01
    held = handle[(time > grasp.time + 5.0) & (time < let_go.time)]  # seated
    assert np.abs(held - np.eye(4)).max() < 1e-9
    assert handle[-1, 0, 3] == pytest.approx(0.3, abs=2e-3)
    chaser = world(run)["chaser"]
    limits = [joint.velocity for joint in run.models["chaser"].joints]
    assert np.all(np.abs(chaser.v[:, 6:]).max(axis=0) < limits)
    assert np.degrees(np.abs(chaser.v[-1, 3:6])).max() < 0.01  # the base is at rest as well
