"""Batches of looped robots agree with single runs."""

from __future__ import annotations

import numpy as np
import pytest

import onorbit_rs as oo

PINS = [
    oo.Loop(f"{side}_linkage", "revolute", f"{side}_pin", f"{side}_rod_tip", project=True)
    for side in ("left", "right")
]


@pytest.mark.parametrize(("robot", "loops"), [("parallel_gripper", []), ("four_bar_gripper", PINS)])
def test_a_batch_agrees_with_single_runs(robot: str, loops: list[oo.Loop]) -> None:
    model = oo.robots.load(robot).with_loops(loops)
    q = model.neutral()
    q[7] = 0.01
    q = model.closed_configuration(q)
    rates = np.zeros((5, model.nv))
    rates[:, 3:6], rates[:, 6] = [0.1, 0.2, 0.3], 0.01 * np.arange(1, 6)
    v = np.array([model.closed_velocity(q, each) for each in rates])
    final = oo.rollout(model, np.tile(q, (5, 1)), v, steps=300)[0]
    assert np.abs(model.loop_errors(final)).max() < 1e-15
    assert np.ptp(final[:, 7]) > 1e-4
    for start, end in zip(v, final, strict=True):
        # a simulation closes its start again, which changes last digits
        np.testing.assert_allclose(oo.Simulation(model, q, start).run(0.3).q[-1], end, rtol=0, atol=1e-15)
        alone = oo.rollout(model, q[None], start[None], steps=300, threads=1)[0][0]
        np.testing.assert_array_equal(alone, end)
