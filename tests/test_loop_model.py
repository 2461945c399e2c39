"""Reduced model of robots with closed loops."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from looped_robots import closing, linkage, start

import onorbit_rs as oo
from onorbit_rs.exceptions import FrameError, InputError, ModelError, ShapeError


def gripper() -> oo.Model:
    """Return a gripper with two four-bar linkages and a mimic joint, which has one independent joint."""
    loops = [
        oo.Loop(f"{side}_linkage", "revolute", f"{side}_pin", f"{side}_rod_tip") for side in ("left", "right")
    ]
    return oo.robots.load("four_bar_gripper").with_loops(loops)


def four_bar() -> oo.Model:
    return linkage().build().with_loops([closing()])


def state(model: oo.Model, seed: int) -> tuple[Any, Any, Any]:
    """Return a configuration and a velocity that the loops permit, and joint torques."""
    rng = np.random.default_rng(seed)
    q = start(model) if model.nv == 9 else model.neutral()
    q[7:] += 0.1 * rng.standard_normal(model.nq - 7)
    q = model.closed_configuration(q)
    v = model.closed_velocity(q, rng.standard_normal(model.nv))
    return q, v, np.r_[np.zeros(6), rng.standard_normal(model.nv - 6)]


@pytest.mark.parametrize(("robot", "count"), [(gripper, 1), (four_bar, 1)])
def test_torques_give_the_constrained_acceleration(robot: Any, count: int) -> None:
    model = robot()
    frame = model.frame_names[-1]
    wrench = {frame: [1.0, -2.0, 0.5, 0.1, 0.2, -0.3]}
    for seed in range(5):
        q, v, tau = state(model, seed)
        reduced = model.constrained_free_floating(q, v, frame, external=wrench)
        effort = reduced.joint_map.T @ tau[6:]
        y = np.linalg.solve(reduced.inertia, effort + reduced.external - reduced.bias)
        found = reduced.joint_map @ y + reduced.joint_drift
        expected, _ = model.constrained_forward_dynamics(q, v, tau, external=wrench)
        assert len(reduced.independent) == count
        assert np.abs(found - expected[6:]).max() < 1e-10 * max(1.0, np.abs(expected).max())
        # the negative control is the reduced model of the tree without its loops
        tree = model.free_floating(q, v, frame, external=wrench)
        opened = np.linalg.solve(tree.inertia, tau[6:] + tree.external - tree.bias)
        assert np.abs(opened - expected[6:]).max() > 1e-2
        # the frame has the acceleration of the constrained motion, by differences of its velocity
        task = reduced.jacobian @ y + reduced.drift
        step = 1e-5
        ends = [model.frame_velocity(*moved(model, q, v, expected, h), frame) for h in (step, -step)]
        assert np.abs((ends[0] - ends[1]) / (2.0 * step) - task).max() < 1e-6


def moved(model: oo.Model, q: Any, v: Any, a: Any, h: float) -> tuple[Any, Any]:
    """Return the state after the time h, to second order."""
    return model.integrate(q, h * v + 0.5 * h * h * a), v + h * a


def test_the_independent_joints_can_be_chosen() -> None:
    model = four_bar()
    q, v, _ = state(model, 1)
    for joint in ("left", "knee", "right"):
        reduced = model.constrained_free_floating(q, v, "coupler", independent=[joint])
        assert reduced.independent == [joint]
        rate = v[6 + list(model.joint_names).index(joint)]
        assert np.abs(reduced.joint_map[:, 0] * rate - v[6:]).max() < 1e-12
    leaders = gripper()
    q, v, _ = state(leaders, 2)
    mimics = [joint.name for joint in leaders.joints if joint.mimic is not None]
    assert not set(mimics) & set(leaders.constrained_free_floating(q, v, "bus").independent)


def test_a_robot_without_loops_has_its_reduced_model() -> None:
    model = linkage().build()
    q, v = start(model), np.linspace(-1.0, 1.0, model.nv)
    reduced, tree = model.constrained_free_floating(q, v, "coupler"), model.free_floating(q, v, "coupler")
    assert reduced.independent == list(model.joint_names)
    for name in ("inertia", "bias", "external", "jacobian", "drift"):
        # free_floating may use fused instructions, so last digits differ
        np.testing.assert_allclose(getattr(reduced, name), getattr(tree, name), rtol=0, atol=1e-14)


def test_invalid_arguments_are_refused() -> None:
    model = four_bar()
    q, v, _ = state(model, 3)
    for joints, problem in [
        (["left", "right"], "the other joints determine .* in this configuration; a valid choice is"),
        ([], "do not determine the motion of"),
    ]:
        with pytest.raises(ModelError, match=problem):
            model.constrained_free_floating(q, v, "coupler", independent=joints)
    with pytest.raises(FrameError, match="no joint 'elbow'"):
        model.constrained_free_floating(q, v, "coupler", independent=["elbow"])
    with pytest.raises(FrameError):
        model.constrained_free_floating(q, v, "couple")
    with pytest.raises(ShapeError, match="v has shape"):
        model.constrained_free_floating(q, v[:-1], "coupler")
    with pytest.raises(InputError):
        model.constrained_free_floating(q * np.nan, v, "coupler")
