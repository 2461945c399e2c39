"""Captures between random trees against Pinocchio: the velocity after them, and 5 s of motion of both.

Pinocchio's tree of both robots (`appendModel`) is integrated here by RK4, with Richardson's extrapolation.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from attached_pairs import PREFIX, Pair, pair

import onorbit_rs as oo
from onorbit_rs.tools.validation.capture import run
from onorbit_rs.tools.validation.gauss import project
from onorbit_rs.tools.validation.trees import Array, State

pin = pytest.importorskip("pinocchio", reason="the oracle is not installed: pip install pin")
import pin_robot  # noqa: E402
from test_attach_pinocchio import appended  # noqa: E402

SEEDS, SPEED = range(4), 0.5
DURATION, STEP = 5.0, 2e-3
GATE = 1e-12  # the largest value observed is 2e-14


class Constant:
    """A controller that applies constant torques."""

    def __init__(self, tau: Array) -> None:
        self.tau = tau

    def update(self, _t: float, _state: Any) -> Array:
        return self.tau


def torques(model: oo.Model) -> Array:
    """Returns a torque for each joint, N m or N."""
    return 0.05 * np.cos(1.0 + np.arange(model.nv - 6))


def captured(
    two: Pair, duration: float, *, driven: bool = False, **settings: Any
) -> tuple[oo.WorldTrace, Array]:
    """Returns a run in which A captures B at t = 0, and B's velocity before, which differs from A's."""
    v_b = SPEED * np.random.default_rng(1).uniform(-1.0, 1.0, two.b.nv)
    systems = [
        oo.System(name, model, q, v, controller=Constant(torques(model)) if driven else None)
        for name, model, q, v in (
            ("a", two.a, two.state_a[0], SPEED * two.state_a[1]),
            ("b", two.b, two.state_b[0], v_b),
        )
    ]
    event = oo.Capture("grasp", "a/tool", f"b/{PREFIX}tool", at=0.0)
    return run(systems, [event], duration, **settings), v_b


def together(two: Pair, trace: oo.WorldTrace, row: int) -> tuple[Array, Array]:
    """Returns the state of the tree of both from those of the two robots."""
    q, v = two.both.neutral(), np.zeros(two.both.nv)
    q[:7], v[:6] = trace["a"].q[row, :7], trace["a"].v[row, :6]
    for part, name in ((two.a, "a"), (two.b, "b")):
        places = [two.both.joint_names.index(joint) for joint in part.joint_names]
        q[7:][places], v[6:][places] = trace[name].q[row, 7:], trace[name].v[row, 6:]
    return q, v


def rates(robot: Any, q: Array, v: Array, tau: Array) -> tuple[Array, Array]:
    """Returns q̇ and v̇ under the torques `tau` (nv,), with the derivative of the unit quaternion `½ q ⊗ ω`."""
    x, y, z, w = quaternion = q[3:7] / np.linalg.norm(q[3:7])
    rotation = pin.Quaternion(quaternion).toRotationMatrix()
    a, b, c = v[3:6]
    turn = [w * a + y * c - z * b, w * b + z * a - x * c, w * c + x * b - y * a, -x * a - y * b - z * c]
    changes = np.concatenate([rotation @ v[:3], 0.5 * np.array(turn), v[6:]])
    at = np.concatenate([q[:3], quaternion, q[7:]])
    return changes, robot.forward_dynamics(State(at, v, v, tau, {}))


def integrate(robot: Any, q: Array, v: Array, tau: Array, steps: int) -> tuple[Array, Array]:
    """Returns the state after `DURATION` by RK4."""
    h = DURATION / steps
    for _ in range(steps):
        k1 = rates(robot, q, v, tau)
        k2 = rates(robot, q + 0.5 * h * k1[0], v + 0.5 * h * k1[1], tau)
        k3 = rates(robot, q + 0.5 * h * k2[0], v + 0.5 * h * k2[1], tau)
        k4 = rates(robot, q + h * k3[0], v + h * k3[1], tau)
        q, v = (x + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]) for i, x in enumerate((q, v)))
        q[3:7] /= np.linalg.norm(q[3:7])
    return q, v


def extrapolated(robot: Any, q: Array, v: Array, tau: Array) -> tuple[Array, Array]:
    """Returns the state after `DURATION` from two steps, without the error of the fourth order."""
    steps = round(DURATION / STEP)
    coarse, fine = (integrate(robot, q, v, tau, count) for count in (steps, 2 * steps))
    return tuple((16.0 * b - a) / 15.0 for a, b in zip(coarse, fine, strict=True))  # type: ignore[return-value]


def error(found: tuple[Array, Array], expected: tuple[Array, Array]) -> float:
    """Returns the largest deviation of q and of v, relative to the largest entry of each."""
    (q, v), (other_q, other_v) = found, expected
    other_q = other_q.copy()
    other_q[3:7] *= np.sign(other_q[3:7] @ q[3:7])
    pairs = ((q, other_q), (v, other_v))
    return max(float(np.abs(a - b).max() / np.abs(b).max()) for a, b in pairs)


@pytest.fixture(scope="module", params=SEEDS)
def two(request: pytest.FixtureRequest) -> Pair:
    return pair(request.param)


@pytest.fixture(scope="module", params=[False, True], ids=["free", "driven"])
def moved(two: Pair, request: pytest.FixtureRequest) -> tuple[oo.WorldTrace, Array]:
    """Returns a run and the torques (nv,) on the tree of both."""
    settings = {"integrator": "dormand_prince", "tolerance": 1e-13}
    tau = np.zeros(two.both.nv)
    if request.param:
        for part in (two.a, two.b):
            tau[6:][[two.both.joint_names.index(joint) for joint in part.joint_names]] = torques(part)
    return captured(two, DURATION, driven=request.param, **settings)[0], tau


def test_the_velocity_after_a_capture_by_the_mass_matrices_of_pinocchio(two: Pair) -> None:
    trace, v_b = captured(two, 1e-3)
    first = pin_robot.PinRobot(pin_robot.build(two.tree_a), two.a.joint_names)
    names = [name.removeprefix(PREFIX) for name in two.b.joint_names]
    second = pin_robot.PinRobot(pin_robot.build(two.tree_b), names)
    before = np.concatenate([SPEED * two.state_a[1], v_b])
    blocks, lines = [], []
    point = two.a.frame_pose(two.state_a[0], "tool")[:3, 3]
    for robot, (q, _), sign in ((first, two.state_a, -1.0), (second, two.state_b, 1.0)):
        v = np.zeros(robot.model.nv)
        state = State(q, v, v, v, {})
        blocks.append(robot.mass_matrix(state))
        jacobian = robot.frame_jacobian(state, "tool")
        jacobian[:3] += np.cross(jacobian[3:].T, point - robot.frame_pose(state, "tool")[:3, 3]).T
        lines.append(sign * jacobian)
    mass = np.zeros((len(before), len(before)))
    mass[: two.a.nv, : two.a.nv], mass[two.a.nv :, two.a.nv :] = blocks
    expected, _ = project(mass, np.hstack(lines), before)
    row = np.flatnonzero(trace.time == 0.0)[-1]
    found = np.concatenate([trace[name].v[row] for name in "ab"])
    assert np.abs(found - expected).max() < 1e-12 * np.abs(np.concatenate([before, expected])).max()


def test_the_motion_after_a_capture_is_that_of_pinocchio_s_append_model(
    two: Pair, moved: tuple[oo.WorldTrace, Array]
) -> None:
    trace, tau = moved
    start = together(two, trace, int(np.flatnonzero(trace.time == 0.0)[-1]))
    expected = extrapolated(appended(two), *start, tau)
    assert np.abs(expected[0][7:] - start[0][7:]).max() > 1.0  # rad
    found = error(together(two, trace, -1), expected)
    print(f"largest relative deviation after {DURATION:g} s: {found:.1e}")
    assert found < GATE


def test_control_kept_axes_and_dropped_rotors_are_rejected(
    two: Pair, moved: tuple[oo.WorldTrace, Array]
) -> None:
    trace, tau = moved
    start = together(two, trace, int(np.flatnonzero(trace.time == 0.0)[-1]))
    found = together(two, trace, -1)
    assert error(found, integrate(appended(two, sign=1.0), *start, tau, steps=500)) > 1e-3
    light = appended(two)
    light.model.armature = np.zeros(light.model.nv)
    assert error(found, integrate(light, *start, tau, steps=500)) > 1e-4
