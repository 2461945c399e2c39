"""Random robots with closed loops, in this package and with the solvers of Pinocchio."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pinocchio as pin  # type: ignore[import-untyped]
from attached_pairs import transform
from pin_robot import PinRobot, build

import onorbit_rs as oo
from onorbit_rs.tools.validation import trees
from onorbit_rs.tools.validation.trees import Array, State, random_state, random_tree

LINKS = 24
LENGTH = 0.7  # of distance loops, m
# of the proximal iterations, which end too early with a tolerance of 1e-12
TOLERANCE, ITERATIONS = 1e-14, 6000
MU = {"constraintDynamics": 1e-6, "lcaba": 1e-4}  # proximal terms: `lcaba` is less accurate with smaller ones
CONTACTS = {"weld": pin.ContactType.CONTACT_6D, "spherical": pin.ContactType.CONTACT_3D}


@dataclass(frozen=True)
class Looped:
    """A random robot with loops in both engines, and a state that closes them."""

    tree: oo.Model
    model: oo.Model
    robot: PinRobot
    state: State

    @property
    def loops(self) -> list[oo.Loop]:
        return self.model.loops

    def solve(self, **changes: Any) -> tuple[Array, Array]:
        """Returns the acceleration and the constraint forces of this package."""
        state = State(**(vars(self.state) | changes))
        q, v, tau = state.q, state.v, state.tau
        return self.model.constrained_forward_dynamics(q, v, tau, external=state.external)


def looped(seed: int, kinds: Sequence[str], *, between_the_same: bool = False) -> Looped:
    """Returns a robot whose loops have random frames and poses, in a random state that closes them."""
    tree, rng = random_tree(seed, LINKS), np.random.default_rng(7000 + seed)
    model = trees.build(tree)
    robot = PinRobot(build(tree), model.joint_names)
    state = random_state(model, rng)
    loops: list[oo.Loop] = []
    for i, kind in enumerate(kinds):
        names = two_frames(robot, model.frame_names, rng)
        if between_the_same and loops:
            names = loops[0].frame_a, loops[0].frame_b
        pose_a = transform(rng)
        a, b = (np.array(model.frame_pose(state.q, name)) for name in names)
        pose_b = np.linalg.solve(b, a @ pose_a @ moved(kind, rng))
        length = LENGTH if kind == "distance" else None
        loops.append(oo.Loop(f"loop{i}", kind, *names, pose_a=pose_a, pose_b=pose_b, length=length))  # type: ignore[arg-type]
    closed = model.with_loops(loops)
    # several loops may have no other closed configuration nearby
    near = closed.integrate(state.q, 3e-4 * state.v) if len(loops) == 1 else state.q
    q = closed.closed_configuration(near)
    v = closed.closed_velocity(q, state.v)
    return Looped(model, closed, robot, State(q, v, state.a, state.tau, state.external))


def moved(kind: str, rng: np.random.Generator) -> Array:
    """Returns a random pose of the second side of a joint in its first side, which the joint permits."""
    if kind == "weld":
        return np.eye(4)
    if kind == "spherical":
        pose = transform(rng)
        pose[:3, 3] = 0.0
        return pose
    if kind == "revolute":
        return np.array(
            pin.SE3(pin.rpy.rpyToMatrix(0.0, 0.0, rng.uniform(-3.0, 3.0)), np.zeros(3)).homogeneous
        )
    shift = LENGTH if kind == "distance" else rng.uniform(-1.0, 1.0)
    return np.array(pin.SE3(np.eye(3), np.array([0.0, 0.0, shift])).homogeneous)


def two_frames(robot: PinRobot, names: list[str], rng: np.random.Generator) -> tuple[str, str]:
    """Returns two random frames on bodies that move relative to each other."""
    while True:
        a, b = (str(name) for name in rng.choice(names, 2, replace=False))
        if len({robot.model.frames[robot.frame(name)].parentJoint for name in (a, b)}) == 2:
            return a, b


def in_pinocchio(robot: PinRobot, loops: Sequence[oo.Loop]) -> Any:
    """Returns the loops as constraints of Pinocchio, in the axes of their first frames."""
    constraints = pin.StdVec_RigidConstraintModel()
    for loop in loops:
        sides: list[Any] = []
        for name, pose in ((loop.frame_a, loop.pose_a), (loop.frame_b, loop.pose_b)):
            frame = robot.model.frames[robot.frame(name)]
            sides += [frame.parentJoint, frame.placement * pin.SE3(np.array(pose))]
        kind = CONTACTS[loop.kind]
        constraints.append(pin.RigidConstraintModel(kind, robot.model, *sides, pin.ReferenceFrame.LOCAL))
    return constraints


def solve(
    method: str, model: Any, constraints: Any, q: Array, v: Array, tau: Array, mu: float | None = None
) -> tuple[Array, list[Array]]:
    """Returns the acceleration and the contact forces of `constraintDynamics` or of `lcaba`."""
    # both start from what earlier calls left in their data, which can keep them from converging
    data, found = model.createData(), pin.StdVec_RigidConstraintData()
    for constraint in constraints:
        found.append(constraint.createData())
    settings = pin.ProximalSettings(TOLERANCE, TOLERANCE, mu or MU[method], ITERATIONS)
    if method == "lcaba":
        pin.computeJointMinimalOrdering(model, data, constraints)
        a = pin.lcaba(model, data, q, v, tau, constraints, found, settings)
    else:
        pin.initConstraintDynamics(model, data, constraints, found)
        a = pin.constraintDynamics(model, data, q, v, tau, constraints, found, settings)
    return np.array(a), [np.array(one.contact_force.vector) for one in found]


def by_pinocchio(method: str, case: Looped) -> tuple[Array, Array]:
    """Returns the acceleration and the forces on the second bodies in the layout of this package."""
    robot, state, loops = case.robot, case.state, case.loops
    q, v = robot.q(state.q), robot.v(state.v)
    tau = robot.v(state.tau) + robot.generalized(q, state.external)
    a, forces = solve(method, robot.model, in_pinocchio(robot, loops), q, v, tau)
    # its forces act on the first bodies
    rows = [-force[: loop.rows] for loop, force in zip(loops, forces, strict=True)]
    return a[robot.order], np.concatenate(rows)
