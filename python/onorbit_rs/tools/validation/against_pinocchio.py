"""Compares dynamics algorithms with those of Pinocchio, which parses the same URDF independently."""

from __future__ import annotations

import importlib
import warnings
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

import onorbit_rs as oo
from onorbit_rs.common.coordinates import BASE_V, JOINTS_V
from onorbit_rs.tools.validation.case import Case, Gate, worst
from onorbit_rs.tools.validation.trees import deviation, random_state, random_tree, urdf

SEEDS, STATES = range(8), 4
GRAVITY = np.zeros(3)
"""Gravity of Pinocchio's model, m/s²; zero for a free-floating robot."""
KERNELS = (
    "mass matrix", "bias forces", "inverse dynamics", "forward dynamics", "momentum",
    "Jacobian of the tool", "generalized Jacobian",
)  # fmt: skip


def theirs(text: str, model: oo.Model, state: Any, tool: str) -> list[Any]:
    """Return Pinocchio's results, in the order of :data:`KERNELS` and in the joint order of ``model``."""
    pin: Any = importlib.import_module("pinocchio")
    robot = pin.buildModelFromXML(text, pin.JointModelFreeFlyer())
    robot.gravity.linear = GRAVITY
    data = robot.createData()
    q, v = oo.layouts.to_pinocchio(model, state.q, state.v, robot)
    joints = [robot.joints[robot.getJointId(name)].idx_v for name in model.joint_names]
    order = np.array([*range(6), *joints])

    def in_their_order(x: Any) -> Any:
        out = np.empty(model.nv)
        out[order] = x
        return out

    a, tau = in_their_order(state.a), in_their_order(state.tau)
    upper = np.triu(pin.crba(robot, data, q))
    mass = (upper + np.triu(upper, 1).T)[np.ix_(order, order)]
    frame = robot.getFrameId(tool, pin.FrameType.BODY)
    axes = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
    jacobian = pin.computeFrameJacobian(robot, data, q, frame, axes)[:, order]
    return [
        mass,
        np.array(pin.nonLinearEffects(robot, data, q, v))[order],
        np.array(pin.rnea(robot, data, q, v, a))[order],
        np.array(pin.aba(robot, data, q, v, tau))[order],
        np.array(pin.computeCentroidalMomentum(robot, data, q, v).vector),
        jacobian,
        # Jg = Jm - Jb Mbb⁻¹ Mbm
        jacobian[:, JOINTS_V]
        - jacobian[:, BASE_V] @ np.linalg.solve(mass[BASE_V, BASE_V], mass[BASE_V, JOINTS_V]),
    ]


def ours(model: oo.Model, state: Any, tool: str) -> list[Any]:
    """Return the results of this package's algorithms, in the order of :data:`KERNELS`."""
    return [
        model.mass_matrix(state.q),
        model.bias_forces(state.q, state.v),
        model.inverse_dynamics(state.q, state.v, state.a),
        model.forward_dynamics(state.q, state.v, state.tau),
        model.momentum(state.q, state.v),
        model.frame_jacobian(state.q, tool),
        model.free_floating(state.q, state.v, tool).jacobian,
    ]


def compare(text: str, tool: str, seed: int) -> Any:
    """Return the largest deviation of each result over several states, relative to its largest entry."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        model = oo.Model.from_urdf_string(text)
    rng = np.random.default_rng(seed)
    found = []
    for _ in range(STATES):
        state = random_state(model, rng, frames=1)
        pairs = zip(ours(model, state, tool), theirs(text, model, state, tool), strict=True)
        found.append([deviation(mine, other) for mine, other in pairs])
    return worst(found)


def trees() -> Any:
    """Return the largest deviations for robots with branches, skew axes and all kinds of joints."""
    return worst(compare(urdf(random_tree(seed, rotors=False)), "tool", 1000 + seed) for seed in SEEDS)


def bundled(name: str) -> Any:
    """Return the largest deviations for a bundled robot."""
    return compare(oo.robots.path(name).read_text(encoding="utf-8"), oo.robots.load(name).frame_names[-1], 1)


def case(name: str, measure: Callable[[], Any]) -> Case:
    """Return a validation case with one gate for each algorithm."""
    gates = tuple(Gate(kernel, 1e-12) for kernel in KERNELS)
    return Case("engines", name, "Pinocchio", gates, measure, needs="pinocchio")


CASES = (
    case("8 random trees of 12 links, 4 states each", trees),
    *(case(f"{name}, 4 states", partial(bundled, name)) for name in ("humanoid_torso", "humanoid_dual_arm")),
)
