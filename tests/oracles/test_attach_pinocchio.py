"""Attached random trees against Pinocchio's `appendModel`, with the attached robot re-rooted in this file."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from attached_pairs import PREFIX, SEEDS, Pair, pair

from onorbit_rs.tools.validation.trees import Tree, deviation, random_state

pin = pytest.importorskip("pinocchio", reason="the oracle is not installed: pip install pin")
import pin_robot  # noqa: E402

GATE = 1e-12  # as in test_pinocchio.py


def reversed_part(tree: Tree, *, sign: float) -> tuple[Any, Any]:
    """Returns B in Pinocchio with its tool link fixed, and the pose of the tool frame in that link.

    `X_pc = X₀ R(a, q)`, so `X_cp = R(−a, q) X₀⁻¹`: `sign` is −1; +1 keeps the axis.
    """
    model = pin.Model()
    stack = [(tree.tool_link, None, 0, pin.SE3.Identity())]
    while stack:
        name, via, joint, placement = stack.pop()
        part = next(part for part in tree.parts if part.name == name)
        inertia = pin.Inertia(part.mass, np.array(part.com), np.array(part.inertia))
        model.addFrame(pin.Frame(PREFIX + name, joint, 0, placement, pin.FrameType.BODY, inertia))
        if name == tree.tool_link:
            tool = placement * pin_robot.pose(tree.tool_xyz, tree.tool_rpy)
            model.addFrame(pin.Frame(f"{PREFIX}tool", joint, 0, tool, pin.FrameType.BODY))
        neighbours = [(child.name, child, True) for child in tree.parts if child.parent == name]
        if part.parent is not None:
            neighbours.append((part.parent, part, False))
        for other, edge, forward in neighbours:
            if edge.name == via:
                continue
            origin, axis = pin_robot.pose(edge.xyz, edge.rpy), np.array(edge.axis) / np.linalg.norm(edge.axis)
            start = placement * origin if forward else placement
            end, below = pin.SE3.Identity() if forward else origin.inverse(), joint
            if edge.kind == "fixed":
                end = start * end
            else:
                slides = edge.kind == "prismatic"
                kind = pin.JointModelPrismaticUnaligned if slides else pin.JointModelRevoluteUnaligned
                along = kind(axis if forward else sign * axis)
                below = model.addJoint(joint, along, start, PREFIX + edge.joint)
            stack.append((other, edge.name, below, end))
    return model, pin_robot.pose(tree.tool_xyz, tree.tool_rpy)


def appended(two: Pair, *, sign: float = -1.0) -> Any:
    """Returns the tree of both robots in Pinocchio."""
    first, (second, tool) = pin_robot.build(two.tree_a), reversed_part(two.tree_b, sign=sign)
    whole = pin.appendModel(first, second, first.getFrameId("tool"), pin.SE3(two.pose) * tool.inverse())
    # `appendModel` of Pinocchio 4.1 drops the rotor inertias of both models and their gravity
    whole.gravity.linear, rotors = np.zeros(3), np.zeros(whole.nv)
    for prefix, tree in (("", two.tree_a), (PREFIX, two.tree_b)):
        for part in tree.parts[1:]:
            if part.kind != "fixed":
                joint = whole.joints[whole.getJointId(prefix + part.joint)]
                rotors[joint.idx_v] = part.rotor_inertia
    whole.armature = rotors
    return pin_robot.PinRobot(whole, two.both.joint_names)


@pytest.fixture(scope="module", params=SEEDS)
def two(request: pytest.FixtureRequest) -> Pair:
    return pair(request.param)


def test_accelerations_are_those_of_pinocchio_s_append_model(two: Pair) -> None:
    robot = appended(two)
    assert two.both.mass == pytest.approx(pin.computeTotalMass(robot.model), rel=1e-14)
    rng = np.random.default_rng(6000)
    for _ in range(3):
        state = random_state(two.both, rng)
        ours = two.both.forward_dynamics(state.q, state.v, state.tau, external=state.external)
        assert deviation(ours, robot.forward_dynamics(state)) < GATE
        for frame in two.both.frame_names:
            assert deviation(two.both.frame_pose(state.q, frame), robot.frame_pose(state, frame)) < GATE


def test_control_reversed_joints_that_keep_their_axes_are_rejected(two: Pair) -> None:
    state = random_state(two.both, np.random.default_rng(6000))
    ours = two.both.forward_dynamics(state.q, state.v, state.tau, external=state.external)
    theirs = appended(two, sign=1.0).forward_dynamics(state)
    assert deviation(ours, theirs) > 0.1  # of order one
