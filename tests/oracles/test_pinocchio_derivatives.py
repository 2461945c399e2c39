"""Derivatives of the dynamics against Pinocchio's analytic derivatives, on random trees with all joint kinds.

The gate is 1e-10 of the largest entry (observed: 8e-14), since forward dynamics solves with matrices of
condition 1e3 to 1e4.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.tools.validation.trees import TOOL, State, build, deviation, random_state, random_tree

pin = pytest.importorskip("pinocchio", reason="the oracle is not installed: pip install pin")
import pin_robot  # noqa: E402

GATE = 1e-10
SEEDS = range(16)


@pytest.fixture(scope="module")
def worst() -> Iterator[dict[str, float]]:
    """Collects the largest deviation of each derivative and prints it at the end (``pytest -s``)."""
    seen: dict[str, float] = {}
    yield seen
    print("\nlargest deviation from Pinocchio:", {name: f"{value:.1e}" for name, value in seen.items()})


def robots(seed: int) -> tuple[oo.Model, pin_robot.PinRobot]:
    tree = random_tree(seed)
    model = build(tree)
    return model, pin_robot.PinRobot(pin_robot.build(tree), model.joint_names)


def ours(model: oo.Model, state: State) -> dict[str, Any]:
    q, v, external = state.q, state.v, state.external
    inverse = model.inverse_dynamics_derivatives(q, v, state.a, external=external)
    forward = model.forward_dynamics_derivatives(q, v, state.tau, external=external)
    joints = np.ascontiguousarray(state.a[..., 6:])
    reduced = model.free_floating_derivatives(q, v, joints, TOOL, external=external)
    names = ("torque_dq", "torque_dv", "acceleration_dq", "acceleration_dv", "velocity_dq")
    return (
        dict(zip(("inverse.dq", "inverse.dv", "inverse.da"), inverse, strict=True))
        | dict(zip(("forward.dq", "forward.dv", "forward.dtau"), forward, strict=True))
        | {f"reduced.{name}": getattr(reduced, name) for name in names}
    )


@pytest.mark.parametrize("seed", SEEDS)
def test_every_derivative_of_one_state(seed: int, worst: dict[str, float]) -> None:
    model, robot = robots(seed)
    state = random_state(model, np.random.default_rng(4000 + seed))
    found = ours(model, state)
    for name, value in pin_robot.derivatives(robot, state, TOOL).items():
        off = deviation(found[name], value)
        worst[name] = max(worst.get(name, 0.0), off)
        assert off < GATE, f"{name} is off by {off:.2e} (seed {seed})"


@pytest.mark.parametrize("seed", SEEDS[::4])
def test_every_derivative_of_a_batch(seed: int) -> None:
    model, robot = robots(seed)
    rng = np.random.default_rng(5000 + seed)
    states = [random_state(model, rng) for _ in range(11)]
    external = states[0].external
    q, v, a, tau = (np.array([getattr(state, name) for state in states]) for name in ("q", "v", "a", "tau"))
    found = ours(model, State(q, v, a, tau, external))
    for k, state in enumerate(states):
        for name, value in pin_robot.derivatives(robot, replace(state, external=external), TOOL).items():
            assert deviation(found[name][k], value) < GATE, (name, k)


# Negative controls


def test_control_omitted_terms_and_other_states_are_detected() -> None:
    model, robot = robots(11)
    state = random_state(model, np.random.default_rng(11))
    found, right = ours(model, state), pin_robot.derivatives(robot, state, TOOL)
    less = {frame: wrench for frame, wrench in state.external.items() if frame != TOOL}
    rng = np.random.default_rng(0)
    wrong = {
        "without a wrench": replace(state, external=less),
        "at another velocity": replace(state, v=rng.uniform(-2.0, 2.0, model.nv)),
        "at other efforts": replace(state, a=0 * state.a, tau=0 * state.tau),
    }
    assert all(deviation(found[key], right[key]) < GATE for key in right)
    for what, other in wrong.items():
        theirs = pin_robot.derivatives(robot, other, TOOL)
        for key in ("inverse.dq", "forward.dq", "reduced.torque_dq", "reduced.acceleration_dq"):
            assert deviation(found[key], theirs[key]) > 1e-3, (what, key)


def test_control_a_wrench_fixed_in_w_has_another_derivative() -> None:
    # the same wrench, but constant in W axes while the base and the joints rotate
    model, _ = robots(11)
    state = random_state(model, np.random.default_rng(12))
    wrench = state.external[TOOL]
    axes = model.frame_pose(state.q, TOOL)[:3, :3]
    in_w = wrench.reshape(2, 3) @ axes.T

    def acceleration(step: Any, fixed_in_w: bool) -> Any:
        q = model.integrate(state.q, step)
        held = (in_w @ model.frame_pose(q, TOOL)[:3, :3]).ravel() if fixed_in_w else wrench
        return model.forward_dynamics(q, state.v, state.tau, external={TOOL: held})

    exact = model.forward_dynamics_derivatives(state.q, state.v, state.tau, external={TOOL: wrench})[0]
    for fixed_in_w in (False, True):
        h = 1e-5  # truncation and rounding both about 1e-9
        steps = h * np.eye(model.nv)
        rates = [(acceleration(s, fixed_in_w) - acceleration(-s, fixed_in_w)) / (2 * h) for s in steps]
        off = deviation(np.array(rates).T, exact)
        assert off > 1e-3 if fixed_in_w else off < 1e-6, (fixed_in_w, off)
