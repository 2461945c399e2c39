"""Wrenches per body and effect, recorded on request in the trace and in ``trace.npz``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.scenario import Scenario, load


@pytest.fixture(scope="module")
def reach() -> Scenario:
    data = load("humanoid_reach").resolved()
    data["environment"].append({"kind": "body_wrench", "body": "torso", "force": [0.3, 0, 0], "start": 0.2})
    data["simulation"] |= {"duration": 0.4, "record_wrenches": True}
    return Scenario(**data)


def test_the_trace_has_one_array_per_effect(reach: Scenario) -> None:
    trace = oo.run(reach).trace
    assert list(trace.wrenches) == ["gravity_gradient", "body_wrench", "gravity"]
    bodies = oo.robots.load("humanoid_torso").body_names
    for rows in trace.wrenches.values():
        assert rows.shape == (len(trace.time), len(bodies), 6)
        assert not rows.flags.writeable
    push = trace.wrenches["body_wrench"]
    on = trace.time >= 0.2 - 1e-9
    assert not push[~on].any()
    np.testing.assert_allclose(np.linalg.norm(push[on][:-1, 0, :3], axis=1), 0.3, rtol=1e-14)
    assert not push[:, 1:].any()


def test_the_wrenches_explain_the_change_of_momentum(reach: Scenario) -> None:
    trace = oo.run(reach).trace
    force = sum(rows[:, :, :3].sum(axis=1) for rows in trace.wrenches.values())

    def missed(force: Any) -> Any:
        """Returns the change over two steps minus Simpson's rule, away from the switching time."""
        gained = trace.momentum[2:, :3] - trace.momentum[:-2, :3]
        h = 1e-3
        pushed = h / 3 * (force[:-2] + 4 * force[1:-1] + force[2:])
        return np.abs((gained - pushed)[np.abs(trace.time[1:-1] - 0.2) > 0.003]).max()

    assert missed(force) < 1e-13
    assert missed(force - trace.wrenches["gravity"][:, :, :3].sum(axis=1)) > 1e-10, "tides must be visible"


def test_a_run_without_the_option_records_no_wrenches() -> None:
    trace = oo.run(Scenario(robot="humanoid_torso", simulation={"duration": 0.01})).trace
    assert trace.wrenches == {}


def test_the_file_and_a_resumed_run_contain_them(reach: Scenario, tmp_path: Path) -> None:
    run = oo.run(reach, out=tmp_path / "out")
    with np.load(tmp_path / "out" / "trace.npz") as file:
        np.testing.assert_array_equal(file["wrench_gravity"], run.trace.wrenches["gravity"])
        assert file["wrench_body_wrench"].shape == run.trace.wrenches["body_wrench"].shape
