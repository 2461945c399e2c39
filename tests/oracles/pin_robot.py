"""The same robot in Pinocchio, with states and results in the layout of this package."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pinocchio as pin  # type: ignore[import-untyped]

import onorbit_rs as oo
from onorbit_rs.tools.validation.trees import BASE, TOOL, Array, Part, State, Tree

W_AXES = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED


def pose(xyz: Any, rpy: Any) -> Any:
    return pin.SE3(pin.rpy.rpyToMatrix(*rpy), np.array(xyz, dtype=float))


def build(tree: Tree) -> Any:
    """Returns the tree in Pinocchio; a fixed link's inertia is added to its parent joint."""
    model = pin.Model()
    model.gravity.linear = np.zeros(3)
    add_tree(model, tree)
    return model


def add_tree(model: Any, tree: Tree, prefix: str = "") -> None:
    """Adds a tree with its own free base joint by joint; `prefix` precedes all names.

    The order is depth first: Pinocchio's crba and Jacobians assume that a subtree is a contiguous range of
    joints and are silently wrong otherwise.
    """
    root = model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), f"{prefix}root")
    place = {BASE: (root, pin.SE3.Identity())}
    armature: dict[str, float] = {}
    for part in depth_first(tree):
        if part.parent is not None:
            joint, placement = place[part.parent]
            placement = placement * pose(part.xyz, part.rpy)
            axis = np.array(part.axis) / np.linalg.norm(part.axis)
            if part.kind == "fixed":
                place[part.name] = (joint, placement)
            else:
                slider = part.kind == "prismatic"
                kind = pin.JointModelPrismaticUnaligned if slider else pin.JointModelRevoluteUnaligned
                joint = model.addJoint(joint, kind(axis), placement, prefix + part.joint)
                place[part.name] = (joint, pin.SE3.Identity())
                armature[prefix + part.joint] = part.rotor_inertia
        inertia = pin.Inertia(part.mass, np.array(part.com), np.array(part.inertia))
        model.appendBodyToJoint(place[part.name][0], inertia, place[part.name][1])
        model.addBodyFrame(prefix + part.name, *place[part.name], 0)
    joint, placement = place[tree.tool_link]
    model.addBodyFrame(prefix + TOOL, joint, placement * pose(tree.tool_xyz, tree.tool_rpy), 0)
    rotors = np.array(model.armature)
    for name, value in armature.items():
        rotors[model.joints[model.getJointId(name)].idx_v] = value
    model.armature = rotors


def depth_first(tree: Tree) -> Iterator[Part]:
    def below(part: Part) -> Iterator[Part]:
        yield part
        for child in tree.parts:
            if child.parent == part.name:
                yield from below(child)

    return below(tree.parts[0])


def from_urdf(text: str) -> Any:
    model = pin.buildModelFromXML(text, pin.JointModelFreeFlyer())
    model.gravity.linear = np.zeros(3)
    return model


class PinRobot:
    """Every kernel of this package computed by Pinocchio, with vectors in the package's joint order."""

    def __init__(self, model: Any, joint_names: list[str]) -> None:
        self.model, self.data = model, model.createData()
        self.joints = [model.joints[model.getJointId(name)] for name in joint_names]
        # row i of the package is row order[i] of Pinocchio
        self.order = np.array([*range(6), *(joint.idx_v for joint in self.joints)])
        assert sorted(self.order) == list(range(model.nv))

    def q(self, ours: Array) -> Array:
        theirs = np.array(pin.neutral(self.model))
        theirs[:7] = ours[:7]
        for joint, angle in zip(self.joints, ours[7:], strict=True):
            value = (
                [angle] if joint.nq == 1 else [np.cos(angle), np.sin(angle)]
            )  # unbounded joints of its URDF reader
            theirs[joint.idx_q : joint.idx_q + joint.nq] = value
        return theirs

    def v(self, ours: Array) -> Array:
        theirs = np.empty(self.model.nv)
        theirs[self.order] = ours
        return theirs

    def frame(self, name: str) -> int:
        return int(self.model.getFrameId(name, pin.FrameType.BODY))

    def wrenches(self, external: dict[str, Array]) -> Any:
        """Converts wrenches on frames to wrenches on joints, in joint axes."""
        total = [pin.Force.Zero() for _ in range(self.model.njoints)]
        for name, wrench in external.items():
            frame = self.model.frames[self.frame(name)]
            total[frame.parentJoint] = total[frame.parentJoint] + frame.placement.act(pin.Force(wrench))
        vector = pin.StdVec_Force()
        vector.extend(total)
        return vector

    def generalized(self, q: Array, external: dict[str, Array]) -> Array:
        """Returns the generalized force ``Q = Σ Jᵀ F``."""
        total = np.zeros(self.model.nv)
        for name, wrench in external.items():
            jacobian = pin.computeFrameJacobian(
                self.model, self.data, q, self.frame(name), pin.ReferenceFrame.LOCAL
            )
            total += jacobian.T @ wrench
        return total

    def frame_pose(self, state: State, name: str) -> Array:
        pin.framesForwardKinematics(self.model, self.data, self.q(state.q))
        return np.array(self.data.oMf[self.frame(name)].homogeneous)

    def frame_velocity(self, state: State, name: str) -> Array:
        pin.forwardKinematics(self.model, self.data, self.q(state.q), self.v(state.v))
        return np.array(pin.getFrameVelocity(self.model, self.data, self.frame(name), W_AXES).vector)

    def frame_jacobian(self, state: State, name: str, axes: Any = W_AXES) -> Array:
        jacobian = pin.computeFrameJacobian(self.model, self.data, self.q(state.q), self.frame(name), axes)
        return np.array(jacobian[:, self.order])

    def mass_matrix(self, state: State) -> Array:
        upper = np.triu(pin.crba(self.model, self.data, self.q(state.q)))
        full = upper + np.triu(upper, 1).T
        return np.array(full[np.ix_(self.order, self.order)])

    def bias_forces(self, state: State) -> Array:
        bias = pin.nonLinearEffects(self.model, self.data, self.q(state.q), self.v(state.v))
        return np.array(bias[self.order])

    def inverse_dynamics(self, state: State) -> Array:
        q, v, a = self.q(state.q), self.v(state.v), self.v(state.a)
        tau = pin.rnea(self.model, self.data, q, v, a, self.wrenches(state.external))
        return np.array(tau[self.order])

    def forward_dynamics(self, state: State) -> Array:
        q, v, tau = self.q(state.q), self.v(state.v), self.v(state.tau)
        a = pin.aba(self.model, self.data, q, v, tau, self.wrenches(state.external))
        return np.array(a[self.order])

    def momentum(self, state: State) -> Array:
        h = pin.computeCentroidalMomentum(self.model, self.data, self.q(state.q), self.v(state.v))
        return np.array(h.vector)

    def kinetic_energy(self, state: State) -> float:
        """Returns the kinetic energy including rotors, with every version of Pinocchio."""
        v = state.v
        return float(0.5 * v @ self.mass_matrix(state) @ v)

    def center_of_mass(self, state: State) -> Array:
        return np.array(pin.centerOfMass(self.model, self.data, self.q(state.q)))

    def integrate(self, state: State) -> Array:
        """Integrates the base with Pinocchio's exponential on SE(3); joint coordinates are added."""
        free = pin.SE3(pin.XYZQUATToSE3(state.q[:7])) * pin.exp6(pin.Motion(state.v[:6]))
        base = pin.SE3ToXYZQUAT(free)
        return np.concatenate([base, state.q[7:] + state.v[6:]])

    def difference(self, state: State, other: Array) -> Array:
        start, end = pin.XYZQUATToSE3(state.q[:7]), pin.XYZQUATToSE3(other[:7])
        return np.concatenate([pin.log6(start.actInv(end)).vector, other[7:] - state.q[7:]])

    def classical_bias(self, state: State, name: str) -> Array:
        """Returns ``J̇ v`` from Pinocchio's J̇."""
        q, v = self.q(state.q), self.v(state.v)
        pin.computeJointJacobiansTimeVariation(self.model, self.data, q, v)
        pin.updateFramePlacements(self.model, self.data)
        rate = pin.getFrameJacobianTimeVariation(self.model, self.data, self.frame(name), W_AXES)
        return np.array(rate @ v)

    def free_floating(self, state: State, name: str, external: dict[str, Array]) -> dict[str, Array]:
        """Returns the reduced model by definition: blocks of M, c and Q, a solve with ``Mbb``."""
        mass, bias = self.mass_matrix(state), self.bias_forces(state)
        jacobian = self.frame_jacobian(state, name)
        applied = self.generalized(self.q(state.q), external)[self.order]
        base, arm = slice(0, 6), slice(6, None)
        coupling = np.linalg.solve(mass[base, base], mass[base, arm])  # Mbb⁻¹ Mbm
        back = np.linalg.solve(mass[base, base], bias[base] - applied[base])  # Mbb⁻¹ (cb - Qb)
        return {
            "inertia": mass[arm, arm] - mass[base, arm].T @ coupling,
            "bias": bias[arm] - coupling.T @ bias[base],
            "external": applied[arm] - coupling.T @ applied[base],
            "jacobian": jacobian[:, arm] - jacobian[:, base] @ coupling,
            "drift": self.classical_bias(state, name) - jacobian[:, base] @ back,
        }


def every_kernel(robot: PinRobot, state: State, tool: str) -> dict[str, Any]:
    """Returns the results of all kernels from Pinocchio."""
    moved = robot.integrate(state)
    reduced = robot.free_floating(state, tool, state.external)
    return {
        "frame_pose": robot.frame_pose(state, tool),
        "frame_velocity": robot.frame_velocity(state, tool),
        "frame_jacobian": robot.frame_jacobian(state, tool),
        "mass_matrix": robot.mass_matrix(state),
        "bias_forces": robot.bias_forces(state),
        "inverse_dynamics": robot.inverse_dynamics(state),
        "forward_dynamics": robot.forward_dynamics(state),
        "momentum": robot.momentum(state),
        "kinetic_energy": robot.kinetic_energy(state),
        "center_of_mass": robot.center_of_mass(state),
        "integrate": moved,
        "difference": robot.difference(state, moved),
    } | {f"free_floating.{name}": value for name, value in reduced.items()}


def same_kernels(model: oo.Model, state: Any, tool: str) -> dict[str, Any]:
    """Returns the package's results; ``state`` holds one state or a batch with common wrenches."""
    q, v, external = state.q, state.v, state.external
    moved = model.integrate(q, v)
    reduced = model.free_floating(q, v, tool, external=external)
    return {
        "frame_pose": model.frame_pose(q, tool),
        "frame_velocity": model.frame_velocity(q, v, tool),
        "frame_jacobian": model.frame_jacobian(q, tool),
        "mass_matrix": model.mass_matrix(q),
        "bias_forces": model.bias_forces(q, v),
        "inverse_dynamics": model.inverse_dynamics(q, v, state.a, external=external),
        "forward_dynamics": model.forward_dynamics(q, v, state.tau, external=external),
        "momentum": model.momentum(q, v),
        "kinetic_energy": model.kinetic_energy(q, v),
        "center_of_mass": model.center_of_mass(q),
        "integrate": moved,
        "difference": model.difference(q, moved),
        "free_floating.inertia": reduced.inertia,
        "free_floating.bias": reduced.bias,
        "free_floating.external": reduced.external,
        "free_floating.jacobian": reduced.jacobian,
        "free_floating.drift": reduced.drift,
    }


def derivatives(robot: PinRobot, state: State, tool: str) -> dict[str, Array]:
    """Returns all derivatives from Pinocchio's analytic ones; the reduced model's by its definition."""
    model, data = robot.model, robot.data
    q, v, fext = robot.q(state.q), robot.v(state.v), robot.wrenches(state.external)
    square = np.ix_(robot.order, robot.order)

    def inverse(a: Array) -> tuple[Array, ...]:
        found = pin.computeRNEADerivatives(model, data, q, v, robot.v(a), fext)
        return tuple(np.array(matrix)[square] for matrix in found)

    forward = pin.computeABADerivatives(model, data, q, v, robot.v(state.tau), fext)
    out = dict(zip(("inverse.dq", "inverse.dv", "inverse.da"), inverse(state.a), strict=True))
    for name, matrix in zip(("forward.dq", "forward.dv", "forward.dtau"), forward, strict=True):
        out[name] = np.array(matrix)[square]

    # a_b = -Mbb⁻¹ (Mbm q̈ + cb - Qb) makes the base rows of inverse dynamics vanish for all q and v
    rest = np.concatenate([np.zeros(6), state.a[6:]])
    mass = inverse(rest)[2]
    missing = pin.rnea(model, data, q, v, robot.v(rest), fext)[robot.order][:6]
    a = np.concatenate([-np.linalg.solve(mass[:6, :6], missing), state.a[6:]])
    dq, dv, _ = inverse(a)
    back_q, back_v = (-np.linalg.solve(mass[:6, :6], force[:6]) for force in (dq, dv))
    out["reduced.torque_dq"] = dq[6:] + mass[6:, :6] @ back_q
    out["reduced.torque_dv"] = dv[6:] + mass[6:, :6] @ back_v
    jacobian = robot.frame_jacobian(state, tool)
    for name, back, part in (("dq", back_q, 1), ("dv", back_v, 2)):
        out[f"reduced.acceleration_{name}"] = point(robot, state, a, tool)[part] + jacobian[:, :6] @ back
    out["reduced.velocity_dq"] = point(robot, state, a, tool)[0]
    return out


def point(robot: PinRobot, state: State, a: Array, name: str) -> tuple[Array, Array, Array]:
    """Returns ``∂ẋ/∂q``, ``∂ẍ/∂q``, ``∂ẍ/∂v`` of a frame's origin, classical, in W axes."""
    model, data = robot.model, robot.data
    twist, turning = robot.frame_velocity(state, name), robot.frame_jacobian(state, name)[3:].T
    pin.computeForwardKinematicsDerivatives(model, data, robot.q(state.q), robot.v(state.v), robot.v(a))
    frame = model.frames[robot.frame(name)]
    joint = frame.parentJoint
    axes = np.array(data.oMi[joint].rotation @ frame.placement.rotation)
    spatial, rate = frame.placement.actInv(data.a[joint]), frame.placement.actInv(data.v[joint])
    classical = [spatial.linear + np.cross(rate.angular, rate.linear), spatial.angular]
    at = (model, data, joint, frame.placement, pin.ReferenceFrame.LOCAL)
    velocity_q, angular_q, angular_v, _ = pin.getFrameAccelerationDerivatives(*at)
    _, linear_q, linear_v, _ = pin.getPointClassicAccelerationDerivatives(*at)
    speed_q, _ = pin.getPointVelocityDerivatives(*at)

    def in_w(linear: Array, angular: Array, of: Array | None = None) -> Array:
        """Rotates derivative rows from frame axes to W, including the rotation of the frame itself."""
        rows = np.vstack([axes @ linear, axes @ angular[3:]])[:, robot.order]
        if of is not None:
            rows += np.hstack([np.cross(turning, of[:3]), np.cross(turning, of[3:])]).T
        return np.array(rows)

    return (
        in_w(speed_q, velocity_q, twist),
        in_w(linear_q, angular_q, (np.array(classical) @ axes.T).ravel()),
        in_w(linear_v, angular_v),
    )
