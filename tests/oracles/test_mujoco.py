"""Accelerations of free-floating robots against MuJoCo.

MuJoCo shares neither code nor conventions with this package: its quaternions are wxyz, the base's linear
velocity is in W axes and its angular velocity in body axes. Accelerations are compared instead of
trajectories because MuJoCo's integrators do not conserve momentum. The gate is 1e-11 of the largest entry;
the largest value observed is 3e-13.
"""

from __future__ import annotations

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.tools.validation.against_mujoco import GATE, MujocoRobot, compare, tree_of
from onorbit_rs.tools.validation.trees import Tree, build, deviation, random_state, random_tree

pytest.importorskip("mujoco", reason="the oracle is not installed: pip install mujoco-core")


@pytest.mark.parametrize("name", ["humanoid_torso", "humanoid_dual_arm"])
def test_the_free_reaction_of_the_humanoid(name: str) -> None:
    model, tree = oo.robots.load(name), tree_of(oo.robots.path(name))
    compared(model, tree, 1)


@pytest.mark.parametrize("seed", range(200, 220))
def test_accelerations_of_random_trees(seed: int) -> None:
    tree = random_tree(seed)
    compared(build(tree), tree, seed)


def compared(model: oo.Model, tree: Tree, seed: int) -> None:
    whole, arm = compare(model, tree, seed)
    print(f"{model.name}, seed {seed}: largest deviations from MuJoCo {whole:.1e}, {arm:.1e}")
    assert whole < GATE and arm < GATE
    # inverse dynamics of MuJoCo's acceleration must return the torques given to MuJoCo
    state = random_state(model, np.random.default_rng(seed), frames=1)
    theirs = MujocoRobot(tree, model.joint_names).acceleration(state.q, state.v, state.tau)
    assert deviation(model.inverse_dynamics(state.q, state.v, theirs), state.tau) < GATE * 100


def test_control_a_forgotten_transport_term_is_rejected() -> None:
    tree = random_tree(200)
    model = build(tree)
    robot = MujocoRobot(tree, model.joint_names)
    state = random_state(model, np.random.default_rng(1), frames=1)
    theirs = robot.acceleration(state.q, state.v, state.tau)
    theirs[:3] += np.cross(state.v[3:6], state.v[:3])
    assert deviation(model.forward_dynamics(state.q, state.v, state.tau), theirs) > 1e-3


def test_control_a_fixed_base_gives_other_accelerations() -> None:
    # the arm on a fixed base: M_mm instead of M*
    model = oo.robots.load("humanoid_torso")
    robot = MujocoRobot(tree_of(oo.robots.path("humanoid_torso")), model.joint_names)
    state = random_state(model, np.random.default_rng(2), frames=1)
    free = np.concatenate([np.zeros(6), state.tau[6:]])
    held = np.linalg.solve(
        model.mass_matrix(state.q)[6:, 6:], state.tau[6:] - model.bias_forces(state.q, state.v)[6:]
    )
    # the base's reaction mostly affects the shoulder, hardly the light wrist
    assert deviation(held[:1], robot.acceleration(state.q, state.v, free)[6:7]) > 0.1
