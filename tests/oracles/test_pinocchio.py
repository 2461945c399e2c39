"""Every kernel against Pinocchio, on random trees with branches, skew axes, rotors and all kinds of joints.

The gate is 1e-12 of the largest entry. Observed values are at most 1.1e-14, except for forward dynamics
(2.3e-14), which solves with a matrix of condition 1e3 to 1e4.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.tools.validation.trees import TOOL, State, Tree, build, deviation, random_state, random_tree

pin = pytest.importorskip("pinocchio", reason="the oracle is not installed: pip install pin")
import pin_robot  # noqa: E402

GATE = 1e-12
SEEDS = range(24)
STATES = 4


@pytest.fixture(scope="module")
def worst() -> Iterator[dict[str, float]]:
    """Collects the largest deviation of each kernel and prints it at the end (``pytest -s``)."""
    seen: dict[str, float] = {}
    yield seen
    print("\nlargest deviation from Pinocchio:", {name: f"{value:.1e}" for name, value in seen.items()})


def robots(seed: int) -> tuple[Tree, oo.Model, pin_robot.PinRobot]:
    tree = random_tree(seed)
    model = build(tree)
    return tree, model, pin_robot.PinRobot(pin_robot.build(tree), model.joint_names)


def same_sign(ours: dict[str, Any], theirs: dict[str, Any]) -> None:
    """Chooses the sign of a quaternion, since q and -q are the same attitude."""
    if np.dot(ours["integrate"][3:7], theirs["integrate"][3:7]) < 0:
        theirs["integrate"][3:7] *= -1


@pytest.mark.parametrize("seed", SEEDS)
def test_every_kernel_for_one_state(seed: int, worst: dict[str, float]) -> None:
    _, model, robot = robots(seed)
    rng = np.random.default_rng(1000 + seed)
    for _ in range(STATES):
        state = random_state(model, rng)
        ours = pin_robot.same_kernels(model, state, TOOL)
        theirs = pin_robot.every_kernel(robot, state, TOOL)
        same_sign(ours, theirs)
        for kernel, value in theirs.items():
            off = deviation(ours[kernel], value)
            worst[kernel] = max(worst.get(kernel, 0.0), off)
            assert off < GATE, f"{kernel} is off by {off:.2e} (seed {seed})"


@pytest.mark.parametrize("seed", SEEDS)
def test_every_kernel_for_a_batch(seed: int) -> None:
    _, model, robot = robots(seed)
    rng = np.random.default_rng(2000 + seed)
    count = (1, 3, 8, 13)[seed % 4]  # full groups of SIMD lanes, with and without a remainder
    states = [random_state(model, rng) for _ in range(count)]
    external = states[0].external  # a batch has common wrenches
    q, v, a, tau = (np.array([getattr(state, name) for state in states]) for name in ("q", "v", "a", "tau"))
    batch = pin_robot.same_kernels(model, State(q, v, a, tau, external), TOOL)
    for k, state in enumerate(states):
        ours = {kernel: values[k] for kernel, values in batch.items()}
        theirs = pin_robot.every_kernel(robot, replace(state, external=external), TOOL)
        same_sign(ours, theirs)
        for kernel, value in theirs.items():
            off = deviation(ours[kernel], value)
            assert off < GATE, f"{kernel} of state {k} is off by {off:.2e} (seed {seed})"


@pytest.mark.parametrize("seed", SEEDS)
def test_every_frame_of_a_tree(seed: int) -> None:
    _, model, robot = robots(seed)
    state = random_state(model, np.random.default_rng(3000 + seed))
    for frame in model.frame_names:
        assert deviation(model.frame_pose(state.q, frame), robot.frame_pose(state, frame)) < GATE
        assert (
            deviation(model.frame_velocity(state.q, state.v, frame), robot.frame_velocity(state, frame))
            < GATE
        )
        assert deviation(model.frame_jacobian(state.q, frame), robot.frame_jacobian(state, frame)) < GATE
        ours = model.free_floating(state.q, state.v, frame)
        theirs = robot.free_floating(state, frame, {})
        for name in ("inertia", "bias", "drift"):
            assert deviation(getattr(ours, name), theirs[name]) < GATE, (frame, name)
        # links fixed to the base have a zero Jacobian: an absolute gate, entries are of order one
        np.testing.assert_allclose(ours.jacobian, theirs["jacobian"], atol=GATE, rtol=GATE)
        np.testing.assert_array_equal(ours.external, 0.0)


def test_kinetic_energy_of_pinocchio_itself_without_rotors() -> None:
    tree = random_tree(7, rotors=False)
    model = build(tree)
    robot = pin_robot.PinRobot(pin_robot.build(tree), model.joint_names)
    state = random_state(model, np.random.default_rng(7))
    energy = pin.computeKineticEnergy(robot.model, robot.data, robot.q(state.q), robot.v(state.v))
    assert deviation(model.kinetic_energy(state.q, state.v), energy) < GATE


def test_difference_of_far_and_near_configurations() -> None:
    _, model, robot = robots(3)
    rng = np.random.default_rng(3)
    for _ in range(20):
        state, other = random_state(model, rng), random_state(model, rng)
        theirs = robot.difference(state, other.q)
        assert deviation(model.difference(state.q, other.q), theirs) < GATE
        for size in (1e-3, 1e-6, 1e-9):
            near = model.integrate(state.q, size * state.v)
            # cancellation in a difference of configurations of order one: 1e-16 / size
            assert deviation(model.difference(state.q, near), size * state.v) < 1e-14 / size


# Negative controls: common mistakes, each of which must exceed the gates above.


@pytest.fixture(scope="module")
def one() -> tuple[oo.Model, pin_robot.PinRobot, State]:
    _, model, robot = robots(11)
    return model, robot, random_state(model, np.random.default_rng(11))


def test_control_a_jacobian_in_another_frame_is_rejected(one: tuple[Any, Any, State]) -> None:
    model, robot, state = one
    ours = model.frame_jacobian(state.q, TOOL)
    for axes in (pin.ReferenceFrame.LOCAL, pin.ReferenceFrame.WORLD):
        assert deviation(ours, robot.frame_jacobian(state, TOOL, axes)) > 0.1


def test_control_a_transposed_rotation_is_rejected(one: tuple[Any, Any, State]) -> None:
    model, robot, state = one
    pose = robot.frame_pose(state, TOOL)
    pose[:3, :3] = pose[:3, :3].T.copy()
    assert deviation(model.frame_pose(state.q, TOOL), pose) > 0.1


def test_control_jdot_at_a_random_velocity_is_rejected(one: tuple[Any, Any, State]) -> None:
    model, robot, state = one
    ours = model.free_floating(state.q, state.v, TOOL).drift
    random = replace(state, v=np.random.default_rng(0).uniform(-2.0, 2.0, model.nv))
    right = robot.free_floating(state, TOOL, {})["drift"]
    wrong = right - robot.classical_bias(state, TOOL) + robot.classical_bias(random, TOOL)
    assert deviation(ours, right) < GATE
    assert deviation(ours, wrong) > 0.1


def test_control_a_spatial_acceleration_in_the_drift_is_rejected(one: tuple[Any, Any, State]) -> None:
    model, robot, state = one
    twist = robot.frame_velocity(state, TOOL)
    spatial = robot.free_floating(state, TOOL, {})["drift"]
    spatial[:3] -= np.cross(twist[3:], twist[:3])
    assert deviation(model.free_floating(state.q, state.v, TOOL).drift, spatial) > 0.1


def test_control_the_forgotten_derivative_of_the_coupling_is_rejected(one: tuple[Any, Any, State]) -> None:
    # d = (J̇m - J̇b Mbb⁻¹ Mbm) q̇ leaves out d/dt(Mbb⁻¹ Mbm)
    model, robot, state = one
    arm = np.concatenate([np.zeros(6), state.v[6:]])
    coupling = np.linalg.solve(*np.split(robot.mass_matrix(state)[:6], [6], axis=1))
    state = replace(
        state, v=arm - np.concatenate([coupling @ arm[6:], np.zeros(model.nv - 6)])
    )  # no momentum
    right = robot.free_floating(state, TOOL, {})["drift"]
    assert deviation(model.free_floating(state.q, state.v, TOOL).drift, right) < GATE
    assert deviation(robot.classical_bias(state, TOOL), right) > 0.01


def test_control_a_wrench_left_out_or_in_world_axes_is_rejected(one: tuple[Any, Any, State]) -> None:
    model, robot, state = one
    ours = model.forward_dynamics(state.q, state.v, state.tau, external=state.external)
    name = next(iter(state.external))
    less = {frame: wrench for frame, wrench in state.external.items() if frame != name}
    turn = robot.frame_pose(state, name)[:3, :3]
    turned = state.external[name].reshape(2, 3) @ turn
    for wrong in (less, less | {name: turned.ravel()}):
        assert deviation(ours, robot.forward_dynamics(replace(state, external=wrong))) > 1e-3


def test_control_rotors_left_out_are_noticed(one: tuple[Any, Any, State]) -> None:
    model, robot, state = one
    bare = robot.model.copy()
    bare.armature = np.zeros(bare.nv)
    assert (
        deviation(model.mass_matrix(state.q), pin_robot.PinRobot(bare, model.joint_names).mass_matrix(state))
        > 1e-3
    )
