"""Compares a robot file with Pinocchio: masses, equations of motion and poses for the same ``q``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pin_robot
import pinocchio as pin  # type: ignore[import-untyped]

import onorbit_rs as oo
from onorbit_rs.robots.expand import expand
from onorbit_rs.tools.validation.trees import State, deviation, random_state


def read(file: Path, root_joint: bool = True) -> Any:
    """Return Pinocchio's model; ``root_joint=False`` if the file has the floating joint of the base."""
    if file.suffix == ".xacro":
        return pin_robot.from_urdf(expand(file)[0])
    model = pin.buildModelFromUrdf(str(file), *([pin.JointModelFreeFlyer()] if root_joint else []))
    model.gravity.linear = np.zeros(3)
    return model


def links(model: Any) -> list[str]:
    """Return the links of the robot; links without a joint above belong to the world."""
    return [
        frame.name for frame in model.frames if frame.type == pin.FrameType.BODY and frame.parentJoint > 0
    ]


def deviations(model: oo.Model, theirs: Any, seed: int, states: int = 2) -> dict[str, float]:
    """Return the worst deviations relative to Pinocchio's largest entry; ``seed`` draws the states."""
    robot = pin_robot.PinRobot(theirs, model.joint_names)
    rng = np.random.default_rng(seed)
    largest = {"mass": deviation(model.mass, pin.computeTotalMass(theirs))}
    for _ in range(states):
        for name, off in of_state(model, robot, random_state(model, rng, frames=1)).items():
            largest[name] = float(np.maximum(off, largest.get(name, 0.0)))  # nan stays
    return largest


def of_state(model: oo.Model, robot: pin_robot.PinRobot, state: State) -> dict[str, float]:
    state.external.clear()  # test_pinocchio.py has wrenches
    q, v = state.q, state.v
    poses = {name: robot.frame_pose(state, name) for name in links(robot.model)}
    mass_matrix, bias = robot.mass_matrix(state), robot.bias_forces(state)
    # an acceleration is as uncertain as M is badly conditioned; the torque that it takes is not
    acceleration = model.forward_dynamics(q, v, state.tau)
    torque = robot.inverse_dynamics(State(q, v, acceleration, state.tau, {}))
    size = (np.abs(mass_matrix) @ np.abs(acceleration) + np.abs(bias)).max() + np.abs(state.tau).max()
    return {
        "mass_matrix": deviation(model.mass_matrix(q), mass_matrix),
        "inverse_dynamics": deviation(model.inverse_dynamics(q, v, state.a), robot.inverse_dynamics(state)),
        "forward_dynamics": float(np.abs(torque - state.tau).max() / size),
        "frame_pose": float(
            np.max([deviation(model.frame_pose(q, name), pose) for name, pose in poses.items()])
        ),
    }


def moving_alike(model: oo.Model, theirs: Any, child: str, seed: int) -> dict[str, float]:
    """Return the deviations for one joint of several degrees of freedom between the base and ``child``.

    The coordinates of the engines differ. Those of Pinocchio are computed from the poses and velocities of
    the two links, and quantities that do not depend on coordinates must agree.
    """
    state = random_state(model, np.random.default_rng(seed), frames=1)
    base, arm = (Moving(model, state, name) for name in (model.body_names[0], child))
    joint = theirs.joints[theirs.frames[theirs.getFrameId(child, pin.FrameType.BODY)].parentJoint]
    between = base.pose.actInv(arm.pose)
    moved = theirs.jointPlacements[joint.id].actInv(between)
    rate = (arm.twist - between.actInv(base.twist)).vector
    if joint.nv == 6:
        place = pin.SE3ToXYZQUAT(moved)
    else:  # planar: x, y, cos, sin; the rate is in the child's axes
        place, rate = np.array([*moved.translation[:2], *moved.rotation[:2, 0]]), rate[[0, 1, 5]]
    q, v = np.concatenate([state.q[:7], place]), np.concatenate([state.v[:6], rate])
    data = theirs.createData()
    return {
        "kinetic_energy": deviation(
            model.kinetic_energy(state.q, state.v), pin.computeKineticEnergy(theirs, data, q, v)
        ),
        "momentum": deviation(
            model.momentum(state.q, state.v), pin.computeCentroidalMomentum(theirs, data, q, v).vector
        ),
        "center_of_mass": deviation(model.center_of_mass(state.q), pin.centerOfMass(theirs, data, q)),
    }


class Moving:
    """Pose of a link and its twist in link axes."""

    def __init__(self, model: oo.Model, state: State, name: str) -> None:
        self.pose = pin.SE3(model.frame_pose(state.q, name))
        axes = pin.SE3(self.pose.rotation, np.zeros(3))
        self.twist = axes.actInv(pin.Motion(model.frame_velocity(state.q, state.v, name)))
