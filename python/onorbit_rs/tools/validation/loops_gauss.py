"""Tests closed loops against Gauss's principle, solved densely with rows from the Jacobians of frames."""

from __future__ import annotations

from typing import Any

import numpy as np

import onorbit_rs as oo
from onorbit_rs.common.coordinates import BASE_NV, JOINTS_Q, QUATERNION
from onorbit_rs.tools.validation.capture import momentum, random_craft
from onorbit_rs.tools.validation.capture import run as run_world
from onorbit_rs.tools.validation.case import Case, Gate, worst
from onorbit_rs.tools.validation.gauss import Craft, mass_matrix, relative_twist
from onorbit_rs.tools.validation.trees import Array, build, random_state, random_tree

CONSTRAINED = {
    "weld": [0, 1, 2, 3, 4, 5],
    "revolute": [0, 1, 2, 3, 4],
    "spherical": [0, 1, 2],
    "prismatic": [0, 1, 3, 4, 5],
}
"""Components of the relative twist that a loop constrains, in the axes of its joint on the first frame."""
SEEDS = range(3300, 3312)


def rows(model: oo.Model, q: Array) -> Array:
    """Return the constraint rows (m, nv) of the closed loops and mimic joints of a robot."""
    found: list[Any] = []
    for loop in model.loops:
        poses, jacobians = [], []
        for frame, local in ((loop.frame_a, loop.pose_a), (loop.frame_b, loop.pose_b)):
            pose, jacobian = model.frame_pose(q, frame), np.array(model.frame_jacobian(q, frame))
            poses.append(pose @ np.array(local))
            jacobian[:3] += np.cross(jacobian[3:].T, poses[-1][:3, 3] - pose[:3, 3]).T
            jacobians.append(jacobian)
        if loop.kind == "distance":
            n = poses[1][:3, 3] - poses[0][:3, 3]
            found.append(n @ (jacobians[1] - jacobians[0])[:3] / np.linalg.norm(n))
            continue
        axes = np.kron(np.eye(2), poses[0][:3, :3].T)
        found.extend((axes @ (jacobians[1] - jacobians[0]))[CONSTRAINED[loop.kind]])
    names = list(model.joint_names)
    for joint in model.joints:
        if joint.mimic is not None:
            leader, ratio, _ = joint.mimic
            row = np.zeros(model.nv)
            row[BASE_NV + names.index(joint.name)], row[BASE_NV + names.index(leader)] = 1.0, -ratio
            found.append(row)
    return np.array(found).reshape(-1, model.nv)


def nearest(mass: Array, constraints: Array, v: Array) -> Array:
    """Return the vector closest to ``v`` in the metric of ``mass`` with ``constraints @ v == 0``.

    The constraints may be redundant.
    """
    scale = 1.0 / np.sqrt(np.diag(mass))
    factor = np.linalg.cholesky(mass * np.outer(scale, scale))
    whitened = np.linalg.solve(factor, (constraints * scale).T).T
    lengths = np.linalg.norm(whitened, axis=1)
    whitened = whitened[lengths > 1e-12] / lengths[lengths > 1e-12, None]
    _, sizes, vectors = np.linalg.svd(whitened)
    independent = vectors[: int(np.sum(sizes > 1e-7 * sizes[0]))]
    y = factor.T @ (v / scale)
    for _ in range(2):
        y = y - independent.T @ (independent @ y)
    return np.asarray(scale * np.linalg.solve(factor.T, y))


def gripper(seed: int, redundant: bool = True) -> Craft:
    """Return a gripper of two four-bar linkages in a random state, with a random frame on it.

    If ``redundant``, one loop is closed twice. A mimic joint connects both linkages.
    """
    rng = np.random.default_rng(seed)
    loops = [oo.Loop(side, "revolute", f"{side}_pin", f"{side}_rod_tip") for side in ("left", "right")]
    if redundant:
        loops.append(oo.Loop("again", "spherical", "left_pin", "left_rod_tip"))
    model = oo.robots.load("four_bar_gripper").with_loops(loops)
    q = model.neutral()
    q[:3] = rng.uniform(-1.0, 1.0, 3)
    q[QUATERNION] = (lambda x: x / np.linalg.norm(x))(rng.normal(size=4))
    q[JOINTS_Q] = rng.uniform(0.1, 0.8)
    q = np.asarray(model.closed_configuration(q))
    v = nearest(np.array(model.mass_matrix(q)), rows(model, q), rng.uniform(-0.3, 0.3, model.nv))
    return Craft(model, q, v, str(rng.choice(["left_finger", "right_finger", "bus", "left_pin"])))


def expected_capture(first: Craft, second: Craft) -> Array:
    """Return the velocities (Σnv,) after a capture, by Gauss's principle with the rows of all loops."""
    crafts = (first, second)
    own = np.zeros((len(rows(first.model, first.q)), first.model.nv + second.model.nv))
    own[:, : first.model.nv] = rows(first.model, first.q)
    constraints = np.vstack([relative_twist(crafts, 0, 1), own])
    return nearest(mass_matrix(crafts), constraints, np.concatenate([first.v, second.v]))


def capture_with_gripper(seed: int) -> tuple[float, float, float]:
    """Return the errors of velocity, energy lost and momentum in a capture by a gripper with closed loops.

    All errors are relative.
    """
    first, second = gripper(seed), random_craft(seed)
    systems = [oo.System(name, c.model, c.q, c.v) for name, c in zip("ab", (first, second), strict=True)]
    event = oo.Capture("grasp", f"a/{first.frame}", f"b/{second.frame}", at=0.0)
    trace = run_world(systems, [event], 1e-3, time_step=1e-3)
    v_a, v_b = (trace[name].v[np.flatnonzero(trace[name].time == 0.0)[-1]] for name in "ab")
    before, after = np.concatenate([first.v, second.v]), expected_capture(first, second)
    mass = mass_matrix((first, second))
    lost = 0.5 * (before @ mass @ before - after @ mass @ after)
    point = first.pose[:3, 3]
    changes = [
        momentum(c, v, point)[0] - momentum(c, c.v, point)[0] for c, v in ((first, v_a), (second, v_b))
    ]
    scales = sum(momentum(c, c.v, point)[1] for c in (first, second))
    return (
        float(np.abs(np.concatenate([v_a, v_b]) - after).max() / np.abs([before, after]).max()),
        abs(trace.events[0].energy_lost / lost - 1.0),
        float((np.linalg.norm(sum(changes).reshape(2, 3), axis=1) / scales).max()),  # type: ignore[union-attr]
    )


def captures() -> tuple[float, ...]:
    """Return the largest errors of :func:`capture_with_gripper` over all seeds."""
    return tuple(worst(capture_with_gripper(seed) for seed in SEEDS))


LENGTH = 0.4
"""Length of the loops of kind `distance`, m."""


def random_loops(seed: int) -> tuple[oo.Model, Array, Array]:
    """Return a random robot with closed loops, its configuration, and random generalized forces (nv,).

    One loop is a ball joint, which occurs twice, so the second one is redundant; up to two further loops are
    of random kinds.
    """
    rng = np.random.default_rng(seed)
    tree = build(random_tree(seed, links=14))
    state = random_state(tree, rng, frames=1)
    links = [body.name for body in tree.bodies]
    loops: list[oo.Loop] = []
    kinds: Any = ("spherical", "revolute", "prismatic", "weld", "distance")
    for kind in kinds:
        a, b = (str(name) for name in rng.choice(links, 2, replace=False))
        pose_b = np.linalg.inv(tree.frame_pose(state.q, b)) @ tree.frame_pose(state.q, a)
        is_distance = kind == "distance"
        pose_b[:3, 3] += is_distance * LENGTH * pose_b[:3, 0]
        loops.append(oo.Loop(kind, kind, a, b, pose_b=pose_b, length=LENGTH if is_distance else None))
    ball = loops[0]
    loops.append(oo.Loop("again", "spherical", ball.frame_a, ball.frame_b, pose_b=ball.pose_b))
    chosen = [loops[i] for i in sorted({0, 5, *rng.choice(5, 2, replace=False).tolist()})]
    return tree.with_loops(chosen), state.q, state.tau


def at_rest(seed: int) -> float:
    """Return the error of the acceleration of a random robot at rest.

    The error is relative to the largest component of the acceleration without loops.
    """
    model, q, tau = random_loops(seed)
    found = model.constrained_forward_dynamics(q, np.zeros(model.nv), tau)[0]
    mass = np.array(model.mass_matrix(q))
    expected = nearest(mass, rows(model, q), np.asarray(np.linalg.solve(mass, tau), dtype=np.float64))
    return float(np.abs(found - expected).max() / np.abs(np.linalg.solve(mass, tau)).max())


def accelerations() -> tuple[float]:
    """Return the largest error of the accelerations of random robots with redundant loops."""
    return (float(worst(at_rest(seed) for seed in SEEDS)),)


def close(model: oo.Model, q: Array, v: Array) -> tuple[Array, Array]:
    """Return the nearest configuration that closes the loops, and the nearest velocity that they permit."""
    closed = np.asarray(model.closed_configuration(q))
    return closed, np.asarray(model.closed_velocity(closed, v))


def center_of_mass(model: oo.Model, q: Array) -> Array:
    """Return the centre of mass in W, (3,), m."""
    total = np.zeros(3)
    for body in model.bodies:
        total += body.mass * (model.frame_pose(q, body.name) @ np.append(body.com, 1.0))[:3]
    return np.asarray(total / model.mass)


OPENED = (0.02, 0.01)
"""Changes of the joint positions that open the loops, rad."""


def closed_from_open(seed: int) -> tuple[float, float, float]:
    """Return the errors when the loops of a gripper, opened by small changes of all joints, are closed.

    These are the relative error of the velocity, the relative change of momentum, and the shortfall from two
    of the order with which the shift of the mass centre decreases with the opening.
    """
    craft = gripper(seed, redundant=False)
    model, rng = craft.model, np.random.default_rng(seed)
    direction, v = np.zeros(model.nv), rng.uniform(-0.3, 0.3, model.nv)
    direction[BASE_NV:] = rng.uniform(-1.0, 1.0, model.nv - BASE_NV)
    shifts = []
    for size in OPENED:
        opened = np.asarray(model.integrate(craft.q, size * direction))
        q, after = close(model, opened, v)
        shifts.append(np.linalg.norm(center_of_mass(model, q) - center_of_mass(model, opened)))
    point = q[:3]
    before = momentum(Craft(model, q, v, ""), v, point)
    change = (momentum(Craft(model, q, v, ""), after, point)[0] - before[0]).reshape(2, 3)
    nearby = nearest(np.array(model.mass_matrix(q)), rows(model, q), v)
    return (
        float(np.abs(after - nearby).max() / np.abs(v).max()),
        float((np.linalg.norm(change, axis=1) / before[1]).max()),
        max(0.0, 2.0 - float(np.log2(shifts[0] / shifts[1]))),
    )


def closing() -> tuple[float, ...]:
    """Return the largest errors of :func:`closed_from_open` over all seeds."""
    return tuple(worst(closed_from_open(seed) for seed in SEEDS))


GAUSS = "Gauss's principle with the rows of all loops"

CASES = (
    Case(
        "loops", "12 random trees with redundant loops", GAUSS, (Gate("acceleration", 1e-11),), accelerations,
    ),
    Case(
        "loops", "12 captures by a gripper of four-bar linkages with a mimic joint", GAUSS,
        (Gate("velocity", 1e-12), Gate("energy lost", 1e-12), Gate("momentum", 1e-14)), captures,
    ),
    Case(
        "loops", "12 grippers whose open loops are closed", GAUSS + "; the mass centre moves by O(φ²)",
        (
            Gate("velocity", 1e-12), Gate("momentum", 1e-14),
            Gate("shortfall of the convergence order, shift of the mass centre", 0.2),
        ), closing,
    ),
)  # fmt: skip
