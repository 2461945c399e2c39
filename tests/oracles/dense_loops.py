"""The dense equations of robots with closed loops, with the mass matrix and the Jacobians of Pinocchio."""

from __future__ import annotations

import numpy as np
import pinocchio as pin  # type: ignore[import-untyped]
from pin_loops import Looped
from pin_robot import PinRobot

import onorbit_rs as oo
from onorbit_rs.tools.validation.trees import Array, State

DEPENDENT = 1e-8  # singular value of the scaled rows, relative to the largest, below which rows are dependent


def dense(case: Looped, *, drift: bool = True) -> tuple[Array, Array, int]:
    """Returns the acceleration, the constraint forces and the number of independent rows.

    `a = a_free + L⁻ᵀ (J L⁻ᵀ)⁺ [−(J a_free + J̇ v)]` with `M = L Lᵀ`. `drift=False` leaves out `J̇ v`.
    """
    robot, state = case.robot, case.state
    mass, bias = robot.mass_matrix(state), robot.bias_forces(state)
    applied = state.tau - bias + robot.generalized(robot.q(state.q), state.external)[robot.order]
    free = np.linalg.solve(mass, applied)
    parts = [rows(robot, state, loop) for loop in case.loops]
    jacobian, rate = (np.concatenate([part[i] for part in parts]) for i in (0, 1))
    lower = np.linalg.cholesky(mass)
    scaled = np.linalg.solve(lower, jacobian.T).T
    u, sizes, vt = np.linalg.svd(scaled, full_matrices=False)
    rank = int((sizes > DEPENDENT * sizes[0]).sum())
    u, sizes, vt = u[:, :rank], sizes[:rank], vt[:rank]
    residual = u.T @ -(jacobian @ free + (rate if drift else 0.0))
    a = free + np.linalg.solve(lower.T, vt.T @ (residual / sizes))
    return a, u @ (residual / sizes**2), rank


def can_move(case: Looped) -> bool:
    """Returns true if the joints in the loops can move relative to each other, and no row is redundant."""
    jacobian = np.concatenate([rows(case.robot, case.state, loop)[0] for loop in case.loops])
    joints = int((np.abs(jacobian[:, 6:]).max(axis=0) > 1e-9).sum())
    return dense(case)[2] == len(jacobian) < joints


def rows(robot: PinRobot, state: State, loop: oo.Loop) -> tuple[Array, Array]:
    """Returns the rows `J` of a loop in the axes of its first frame, and `J̇ v`, from frames of Pinocchio."""
    sides = [
        side(robot, state, *given)
        for given in ((loop.frame_a, np.array(loop.pose_a)), (loop.frame_b, np.array(loop.pose_b)))
    ]
    (pose, jacobian_a, twist_a, rate_a), (other, jacobian_b, twist_b, rate_b) = sides
    jacobian, twist, rate = jacobian_b - jacobian_a, twist_b - twist_a, rate_b - rate_a
    axes, gap, turn = pose[:3, :3].T, other[:3, 3] - pose[:3, 3], twist_a[3:]
    if loop.kind == "distance":
        # d² = L²:  d·Δv = 0,  d·Δa + Δv·Δv = 0
        size = np.linalg.norm(gap)
        return (gap @ jacobian[:3])[None] / size, np.array([gap @ rate[:3] + twist[:3] @ twist[:3]]) / size
    along, about = axes @ jacobian[:3], axes @ jacobian[3:]
    along_rate, about_rate = axes @ rate[:3], axes @ (rate[3:] + np.cross(twist[3:], turn))
    if loop.kind == "prismatic":
        # x·d = 0:  x·Δv + (ω × x)·d = 0,  x·Δa + 2 (ω × x)·Δv + (α × x + ω × (ω × x))·d = 0
        along = along - axes @ np.cross(jacobian_a[3:].T, gap).T
        turning = np.cross(rate_a[3:], gap) - np.cross(turn, np.cross(turn, gap))
        along_rate = axes @ (rate[:3] - 2.0 * np.cross(turn, twist[:3]) - turning)
    count = {"weld": (3, 3), "revolute": (3, 2), "spherical": (3, 0), "prismatic": (2, 3)}[loop.kind]
    return (
        np.concatenate([along[: count[0]], about[: count[1]]]),
        np.concatenate([along_rate[: count[0]], about_rate[: count[1]]]),
    )


def side(robot: PinRobot, state: State, name: str, pose: Array) -> tuple[Array, Array, Array, Array]:
    """Returns pose, Jacobian, twist and `J̇ v` (classical) of a joint of a loop at a frame, in W axes."""
    model, data, q, v = robot.model, robot.data, robot.q(state.q), robot.v(state.v)
    placement = model.frames[robot.frame(name)].placement * pin.SE3(pose)
    at = (model.frames[robot.frame(name)].parentJoint, placement, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED)
    jacobian = pin.computeFrameJacobian(model, data, q, robot.frame(name), at[2])
    pin.forwardKinematics(model, data, q, v, np.zeros(model.nv))
    arm = data.oMi[at[0]].rotation @ (
        placement.translation - model.frames[robot.frame(name)].placement.translation
    )
    jacobian[:3] += np.cross(jacobian[3:].T, arm).T
    return (
        np.array((data.oMi[at[0]] * placement).homogeneous),
        np.array(jacobian[:, robot.order]),
        np.array(pin.getFrameVelocity(model, data, *at).vector),
        np.array(pin.getFrameClassicalAcceleration(model, data, *at).vector),
    )
