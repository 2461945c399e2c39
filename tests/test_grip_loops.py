"""Grip force of jaws that closed loops move: the lever of the motor includes the motion of the loops."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray

import onorbit_rs as oo
from onorbit_rs.tools.validation.contact_bodies import at, body

FORCE = 15.0
"""Grip force, N."""
SIDES = ("left", "right")
RADIUS = 0.03
"""Radius of the pin, m."""


@cache
def gripper() -> oo.Model:
    """Return the gripper with two four-bar linkages; 'right_crank' mimics 'left_crank'."""
    loops = [oo.Loop(f"{side}_linkage", "revolute", f"{side}_pin", f"{side}_rod_tip") for side in SIDES]
    return oo.robots.load("four_bar_gripper").with_loops(loops)


def opened(angle: float) -> NDArray[np.float64]:
    """Return the configuration with cranks at an angle, rad; the fingers are parallel."""
    model, q = gripper(), gripper().neutral()
    joints = {name: index for index, name in enumerate(model.joint_names)}
    for side in SIDES:
        for joint, value in (("crank", angle), ("hinge", -angle), ("rod", angle)):
            q[7 + joints[f"{side}_{joint}"]] = value
    return q


def gripped(x: float, *, integral: float = 0.0, force: float = FORCE, lasts: float = 6.0) -> oo.WorldTrace:
    """Return the trace of the gripper that closes on a pin along z at the position `x`, m."""
    pin = body(f'<cylinder radius="{RADIUS}" length="0.2"/>', 5.0, [0.02, 0.02, 0.01])
    law = oo.GripForce(force, closing_rate=-0.3, damping=0.5, ramp=0.5, integral=integral)
    model, q = gripper(), opened(0.35)
    control = oo.Control(law, joints=["left_crank"], name="grip")
    systems = [
        oo.System("hand", model, q, np.zeros(model.nv), controller=[control]),
        at("pin", pin, [x, 0, 0]),
    ]
    contacts = [
        oo.Contact(
            f"hand/{side}_finger", "pin/body", name=side, normal=oo.HuntCrossley(2e4, 1.0, dissipation=20.0)
        )
        for side in SIDES
    ]
    trace = oo.Simulation(oo.World(systems, contacts=contacts), time_step=5e-3, record_every=20).run(lasts)
    assert isinstance(trace, oo.WorldTrace)
    return trace


def mean_force(trace: oo.WorldTrace) -> float:
    contacts = [trace.contacts[side] for side in SIDES]
    return float(np.mean([abs(one.force[-1] @ one.normal[-1]) for one in contacts]))


def in_base(q: NDArray[np.float64], frame: str) -> NDArray[np.float64]:
    """Return the pose of a frame relative to the base."""
    return np.asarray(np.linalg.inv(gripper().frame_pose(q, "bus")) @ gripper().frame_pose(q, frame))


def virtual_work(trace: oo.WorldTrace) -> float:
    """Return the work of closing, J/rad, against 1 N on each finger, by differences of the closed motion."""
    q, total, step = np.asarray(trace["hand"].q[-1]), 0.0, 1e-5
    index = 7 + list(gripper().joint_names).index("left_crank")
    ends = []
    for h in (step, -step):
        angle = q[index] + h
        moved = opened(angle)
        moved[:7] = q[:7]
        ends.append(gripper().closed_configuration(moved))
    base = gripper().frame_pose(q, "bus")[:3, :3]
    for side in SIDES:
        contact = trace.contacts[side]
        place = np.linalg.inv(gripper().frame_pose(q, f"{side}_finger")) @ [*contact.point[-1], 1.0]
        points = [(in_base(end, f"{side}_finger") @ place)[:3] for end in ends]
        velocity = base @ (points[0] - points[1]) / (ends[0][index] - ends[1][index])
        total += float(np.asarray(contact.normal[-1]) @ velocity)  # the normal points from finger to pin
    return total


def lever_of_the_tree(trace: oo.WorldTrace) -> float:
    """Return the lever, m, of fingers that are fixed to their cranks: the control without the loops."""
    q, total = np.asarray(trace["hand"].q[-1]), 0.0
    for side, sign in (("left", 1.0), ("right", -1.0)):
        contact = trace.contacts[side]
        crank = gripper().frame_pose(q, f"{side}_crank_link")
        axis, arm = sign * crank[:3, 2], np.asarray(contact.point[-1]) - crank[:3, 3]
        total += float(axis @ np.cross(arm, contact.normal[-1]))
    return total


@pytest.mark.parametrize("x", [0.39, 0.42, 0.46])
def test_the_settled_force_is_the_desired_one_at_every_place_of_the_fingers(x: float) -> None:
    """Without an integral, the force is `F` only with the right lever: `τ = λ F` balances `λ N`."""
    trace = gripped(x)
    force, effort = mean_force(trace), float(trace["hand"].tau[-1, 0])
    assert abs(float(trace["hand"].v[-1, 6])) < 1e-7  # at rest
    assert force == pytest.approx(FORCE, rel=1e-5)
    lever = virtual_work(trace)
    assert effort / FORCE == pytest.approx(lever, rel=1e-5)
    # control: the lever of the tree differs, and the force would differ by the same factor
    ratio = lever_of_the_tree(trace) / lever
    assert ratio > {0.39: 1.05, 0.42: 1.4, 0.46: 1.8}[x], ratio


def test_the_integral_has_nothing_to_correct() -> None:
    trace = gripped(0.44, integral=5.0)
    error = np.asarray(trace["hand"].tracking["grip"])[:, 0]
    time = np.asarray(trace["hand"].time)
    risen = (time > time[np.argmax(error < 0.9 * FORCE)] + 1.0) & (time > 2.0)
    assert mean_force(trace) == pytest.approx(FORCE, rel=1e-9)
    assert np.abs(error[risen]).max() < 0.02 * FORCE
