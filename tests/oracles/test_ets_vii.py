"""The base motion of ETS-VII from conservation of momentum alone, with Pinocchio's mass matrix.

No external wrench acts and the robot starts at rest, so its momentum stays zero and the base's twist is
`v_b = -Mbb⁻¹ Mbm q̇` along the recorded joints. Its integral is the motion of the base, without any forces,
controller or integrator of this package.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.common.rotations import angle_between

pin = pytest.importorskip("pinocchio", reason="the oracle is not installed: pip install pin")
import pin_robot  # noqa: E402

pytestmark = pytest.mark.filterwarnings("ignore:the inertia of link 'link_5'")

ROTATION_GATE = 1e-6  # rad
POSITION_GATE = 1e-6  # m


@pytest.fixture(scope="module")
def run() -> oo.Run:
    return oo.run("ets_vii_axis_by_axis", quiet=True)


def twists(run: oo.Run, *, carries_arm: bool = True) -> Any:
    """Returns the base twists (T, 6) in base axes; with or without the arm's inertia in that of the base."""
    text = oo.robots.path("ets_vii").read_text()
    robot = pin_robot.PinRobot(pin_robot.from_urdf(text), run.model.joint_names)
    q, v = np.asarray(run.trace.q), np.asarray(run.trace.v)
    found = np.empty((len(q), 6))
    for row, (place, rates) in enumerate(zip(robot_places(robot, q), v[:, 6:], strict=True)):
        mass = np.triu(pin.crba(robot.model, robot.data, place))
        base = mass[:6, :6] + np.triu(mass[:6, :6], 1).T
        if not carries_arm:
            base = np.array(robot.model.inertias[1].matrix())
        found[row] = -np.linalg.solve(base, mass[:6, robot.order[6:]] @ rates)
    return found


def robot_places(robot: pin_robot.PinRobot, q: Any) -> Any:
    """Returns Pinocchio's configurations with the base at the origin; its position does not affect ``M``."""
    at_origin = q.copy()
    at_origin[:, :7] = [0, 0, 0, 0, 0, 0, 1]
    return (robot.q(row) for row in at_origin)


def integrated(twist: Any, time: Any, first: Any) -> Any:
    """Returns the poses (T, 7): each step uses the mean of the twists at its ends, on SE(3)."""
    pose = pin.XYZQUATToSE3(first)
    poses = [first]
    for step, mean in zip(np.diff(time), 0.5 * (twist[1:] + twist[:-1]), strict=True):
        pose = pose * pin.exp6(pin.Motion(step * mean))
        poses.append(pin.SE3ToXYZQUAT(pose))
    return np.array(poses)


def apart(run: oo.Run, poses: Any) -> tuple[float, float]:
    """Returns the largest differences in attitude, rad, and position, m."""
    q = np.asarray(run.trace.q)
    return (
        float(angle_between(q[:, 3:7], poses[:, 3:7]).max()),
        float(np.linalg.norm(q[:, :3] - poses[:, :3], axis=1).max()),
    )


def test_the_base_moves_as_momentum_conservation_requires(run: oo.Run) -> None:
    time = np.asarray(run.trace.time)
    rotation, position = apart(run, integrated(twists(run), time, run.trace.q[0, :7]))
    print(f"off by {rotation:.1e} rad and {position:.1e} m over {time[-1]:g} s")
    assert rotation < ROTATION_GATE and position < POSITION_GATE


def test_a_fixed_base_or_a_massless_arm_is_detected(run: oo.Run) -> None:
    time, first = np.asarray(run.trace.time), run.trace.q[0, :7]
    held = integrated(np.zeros((len(time), 6)), time, first)
    assert apart(run, held)[0] > 0.02 and apart(run, held)[1] > 0.01
    alone = integrated(twists(run, carries_arm=False), time, first)
    assert apart(run, alone)[0] > 1e3 * ROTATION_GATE and apart(run, alone)[1] > 1e3 * POSITION_GATE


def test_joints_move_one_by_one_and_leave_the_base_at_rest(run: oo.Run) -> None:
    rates = np.abs(np.asarray(run.trace.v)[:, 6:])
    moving = rates > np.radians(0.01)
    assert moving.any(axis=0).all() and moving.sum(axis=1).max() == 1
    assert rates.max() == pytest.approx(np.radians(1.0), rel=1e-3)
    assert np.abs(run.trace.v[-1]).max() < 1e-9
    turned = np.degrees(run.trace.q[-1, 7:])
    np.testing.assert_allclose(turned, [30, -50, 70, 20, 30, -30], atol=1e-6)
