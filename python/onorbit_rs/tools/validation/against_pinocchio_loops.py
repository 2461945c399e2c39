"""Compares accelerations under closed loops with those of Pinocchio's proximal constraint dynamics."""

from __future__ import annotations

import importlib
import warnings
from typing import Any

import numpy as np

import onorbit_rs as oo
from onorbit_rs.tools.validation.case import Case, Gate, worst
from onorbit_rs.tools.validation.loops_gauss import nearest, rows
from onorbit_rs.tools.validation.trees import Array, deviation, random_state, random_tree, urdf

SEEDS, LINKS = range(8), 14
MU, TOLERANCE, ITERATIONS = 1e-4, 1e-14, 200
"""Settings of Pinocchio's proximal iteration; with a smaller `mu`, digits are lost."""
APART = 0.3
"""Distance of two ball joints that replace a pin in Pinocchio's model, m."""


def looped(seed: int) -> tuple[str, oo.Model, list[oo.Loop], Any]:
    """Return a random robot as URDF text and as a model, with loops that its random state closes.

    The loops are a ball joint and, for even seeds, a weld, or, for odd seeds, a pin and the ball joint again.
    """
    rng = np.random.default_rng(4000 + seed)
    text = urdf(random_tree(40 + seed, links=LINKS, rotors=False))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        model = oo.Model.from_urdf_string(text)
    state = random_state(model, rng, frames=1)
    links, loops = [body.name for body in model.bodies], list[oo.Loop]()
    kinds: Any = ["spherical", ("weld", "revolute")[seed % 2], *["again"] * (seed % 2)]
    for kind in kinds:
        if kind == "again":
            a, b, pose_b = loops[0].frame_a, loops[0].frame_b, np.array(loops[0].pose_b)
        else:
            a, b = (str(name) for name in rng.choice(links, 2, replace=False))
            pose_b = np.linalg.inv(model.frame_pose(state.q, b)) @ model.frame_pose(state.q, a)
        loops.append(oo.Loop(kind, "spherical" if kind == "again" else kind, a, b, pose_b=pose_b))
    return text, model.with_loops(loops), loops, state


def constraints(pin: Any, robot: Any, loop: oo.Loop) -> list[Any]:
    """Return Pinocchio's constraints for a loop: a weld, a ball joint, or two ball joints on a pin's axis."""
    places = []
    for name, pose in ((loop.frame_a, loop.pose_a), (loop.frame_b, loop.pose_b)):
        frame = robot.frames[robot.getFrameId(name, pin.FrameType.BODY)]
        places.append((frame.parentJoint, frame.placement * pin.SE3(np.array(pose))))
    kind = pin.ContactType.CONTACT_6D if loop.kind == "weld" else pin.ContactType.CONTACT_3D
    shifts = [pin.SE3.Identity()]
    if loop.kind == "revolute":
        shifts.append(pin.SE3(np.eye(3), np.array([0.0, 0.0, APART])))
    (joint_a, at_a), (joint_b, at_b) = places
    found = []
    for shift in shifts:
        one = pin.RigidConstraintModel(
            kind, robot, joint_a, at_a * shift, joint_b, at_b * shift, pin.ReferenceFrame.LOCAL
        )
        found.append(one)
    return found


def theirs(text: str, model: oo.Model, loops: list[oo.Loop], q: Array, v: Array, tau: Array) -> Array:
    """Return Pinocchio's acceleration, reordered to the joint order of ``model``."""
    pin: Any = importlib.import_module("pinocchio")
    robot = pin.buildModelFromXML(text, pin.JointModelFreeFlyer())
    robot.gravity.linear = np.zeros(3)
    data = robot.createData()
    their_q, their_v = oo.layouts.to_pinocchio(model, q, v, robot)
    joints = [robot.joints[robot.getJointId(name)].idx_v for name in model.joint_names]
    order = np.array([*range(6), *joints])
    their_tau = np.empty(model.nv)
    their_tau[order] = tau
    models = pin.StdVec_RigidConstraintModel()
    for loop in loops:
        models.extend(constraints(pin, robot, loop))
    datas = pin.StdVec_RigidConstraintData()
    datas.extend([one.createData() for one in models])
    pin.initConstraintDynamics(robot, data, models, datas)
    settings = pin.ProximalSettings(TOLERANCE, TOLERANCE, MU, ITERATIONS)
    a = pin.constraintDynamics(robot, data, their_q, their_v, their_tau, models, datas, settings)
    return np.asarray(np.array(a)[order], dtype=np.float64)


def compare(seed: int) -> float:
    """Return the deviation of the acceleration, relative to its largest component."""
    text, model, loops, state = looped(seed)
    q = state.q
    v = nearest(np.array(model.mass_matrix(q)), rows(model, q), state.v)
    found, _ = model.constrained_forward_dynamics(q, v, state.tau)
    return deviation(found, theirs(text, model, loops, q, v, state.tau))


def random_trees() -> tuple[float]:
    """Return the largest deviation for random robots with loops."""
    return (float(worst(compare(seed) for seed in SEEDS)),)


CASES = (
    Case(
        "loops", "8 random trees with two or three loops, some redundant", "Pinocchio, constraintDynamics",
        (Gate("acceleration", 1e-9),), random_trees, needs="pinocchio",
    ),
)  # fmt: skip
