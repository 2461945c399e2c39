"""Batches of looped robots agree with single runs."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest
from looped_robots import closing, linkage
from looped_robots import start as near_start

import onorbit_rs as oo
from onorbit_rs.exceptions import ControlError, InputError

PINS = [
    oo.Loop(f"{side}_linkage", "revolute", f"{side}_pin", f"{side}_rod_tip", project=True)
    for side in ("left", "right")
]


@pytest.mark.parametrize(("robot", "loops"), [("parallel_gripper", []), ("four_bar_gripper", PINS)])
def test_a_batch_agrees_with_single_runs(robot: str, loops: list[oo.Loop]) -> None:
    model = oo.robots.load(robot).with_loops(loops)
    q = model.neutral()
    q[7] = 0.01
    q = model.closed_configuration(q)
    rates = np.zeros((5, model.nv))
    rates[:, 3:6], rates[:, 6] = [0.1, 0.2, 0.3], 0.01 * np.arange(1, 6)
    v = np.array([model.closed_velocity(q, each) for each in rates])
    final = oo.rollout(model, np.tile(q, (5, 1)), v, steps=300)[0]
    assert np.abs(model.loop_errors(final)).max() < 1e-15
    assert np.ptp(final[:, 7]) > 1e-4
    for start, end in zip(v, final, strict=True):
        np.testing.assert_allclose(oo.Simulation(model, q, start).run(0.3).q[-1], end, rtol=0, atol=1e-15)
        alone = oo.rollout(model, q[None], start[None], steps=300, threads=1)[0][0]
        np.testing.assert_array_equal(alone, end)


KP, KD = 4.0, 4.0  # 1/s², 1/s
STEPS, STEP = 150, 2e-3
RING = "hands"


def armed(gripper: str, loops: list[oo.Loop]) -> tuple[oo.Model, oo.Model, str]:
    """Return an arm with a gripper, the same tree with all joints free, and the name of the driven frame."""
    arm = oo.robots.load("humanoid_torso")
    text = oo.robots.path(gripper).read_text()
    hand, free = (oo.Model.from_urdf_string(each) for each in (text, re.sub(r"<mimic[^>]*>", "", text)))
    closed = oo.attach(arm, "tool", hand.with_loops(loops), prefix="hand_")
    return closed, oo.attach(arm, "tool", free, prefix="hand_"), "hand_left_finger"


def ring() -> tuple[oo.Model, oo.Model, str]:
    """Return a servicer whose hands are welded to each other, its tree, and the name of the driven frame."""
    robot = oo.robots.load("two_arm_servicer")
    q = robot.neutral()
    q[7:] = np.linspace(0.3, 1.0, robot.nq - 7)
    pose = np.linalg.solve(robot.frame_pose(q, "left_tool"), robot.frame_pose(q, "right_tool"))
    return (
        robot.with_loops([oo.Loop(RING, "weld", "left_tool", "right_tool", pose_a=pose)]),
        robot,
        "left_tool",
    )


CASES = [armed("four_bar_gripper", PINS), armed("parallel_gripper", []), ring()]


def states(model: oo.Model, count: int) -> tuple[Any, Any]:
    """Return different states that close the loops, (count, nq) and (count, nv)."""
    rng = np.random.default_rng(5)
    q, v = np.empty((count, model.nq)), np.empty((count, model.nv))
    for row in range(count):
        near = model.neutral()
        if any(loop.name == RING for loop in model.loops):
            near[7:] = np.linspace(0.3, 1.0, model.nq - 7)
        else:
            near[7:14] = [0.5342, -2.341, -2.0077, -2.2249, -2.2693, -0.1342, -0.1974]
        near[7:14] += rng.uniform(-0.02, 0.02, 7)
        q[row] = model.closed_configuration(near)
        v[row] = model.closed_velocity(q[row], rng.uniform(-0.02, 0.02, model.nv))
    return q, v


def law_of(model: oo.Model, frame: str, q: Any) -> tuple[oo.ComputedTorque, oo.Reference]:
    """Return a law that moves a frame by some centimetres, and its reference."""
    first = model.frame_pose(q, frame)
    last = first.copy()
    last[:3, 3] += [0.03, -0.02, 0.02]
    reference = oo.Line(first, last, duration=STEPS * STEP)
    return oo.ComputedTorque(model, frame, kp=KP, kd=KD, null_space_damping=0.5, damping=1e-3), reference


@pytest.mark.parametrize("case", CASES, ids=["four-bar", "mimic", "ring"])
def test_computed_torque_in_a_batch_is_that_of_a_simulation(case: Any) -> None:
    model, tree, frame = case
    q, v = states(model, 5)
    law, reference = law_of(model, frame, q[0])
    options: Any = {"steps": STEPS, "time_step": STEP, "controller": law, "reference": reference}
    rows = oo.rollout(model, q, v, record_every=50, **options)
    assert np.abs(model.loop_errors(rows[0].reshape(-1, model.nq))).max() < 1e-14
    for threads in (1, 2):
        again = oo.rollout(model, q, v, record_every=50, threads=threads, **options)
        assert all(np.array_equal(a, b) for a, b in zip(again, rows, strict=True))
    for state in range(5):
        run: Any = oo.Simulation(
            model, q[state], v[state], controller=law, reference=reference, time_step=STEP, record_every=50,
            reference_start_tolerance=[10.0, 4.0],
        ).run(STEPS * STEP)  # fmt: skip
        assert np.abs(run.tau).max() > 1e-2
        np.testing.assert_allclose(rows[0][state], run.q, rtol=0, atol=1e-13)
        np.testing.assert_allclose(rows[1][state], run.v, rtol=0, atol=1e-13)
        alone = oo.rollout(model, q[state : state + 1], v[state : state + 1], record_every=50, **options)
        assert all(np.array_equal(one[0], many[state]) for one, many in zip(alone, rows, strict=True))
    # the negative control: the law for the tree, in which all joints are free and driven
    tree_law = oo.ComputedTorque(tree, frame, kp=KP, kd=KD, null_space_damping=0.5, damping=1e-3)
    torques = []
    for robot, own in ((model, law), (tree, tree_law)):
        run = oo.Simulation(
            robot, q[0], v[0], controller=own, reference=reference, time_step=STEP,
            reference_start_tolerance=[10.0, 4.0],
        ).run(STEPS * STEP)  # fmt: skip
        torques.append(run.tau[:STEPS])
    assert np.abs(torques[1][0] - torques[0][0]).max() > 1e-3 * np.abs(torques[0][0]).max()
    given: Any = {"steps": STEPS, "time_step": STEP}
    ends = [oo.rollout(model, q[:1], v[:1], tau=tau[None], **given)[0][0] for tau in torques]
    np.testing.assert_allclose(ends[0], rows[0][0, -1], rtol=0, atol=1e-13)
    assert np.abs(ends[1] - ends[0]).max() > 1e-3


def test_a_rollout_names_the_state_that_opens_a_loop() -> None:
    model = linkage().build().with_loops([closing()])
    q = np.tile(model.closed_configuration(near_start(model)), (5, 1))
    v = np.zeros((5, model.nv))
    q[3, 7] += 0.1
    with pytest.raises(
        InputError, match=r"state 3: the initial configuration opens the loop 'closing' by 0\.0"
    ):
        oo.rollout(model, q, v, steps=2)
    q[3] = q[0]
    v[4, 6] = 1.0
    with pytest.raises(InputError, match=r"state 4: the initial velocity opens the loop 'closing' by"):
        oo.rollout(model, q, v, steps=2, threads=2)
    mended = linkage().build().with_loops([closing(project=True)])
    first = oo.rollout(mended, near_start(mended)[None], v[:1], steps=1, record_every=1)[0][0, 0]
    np.testing.assert_allclose(first, q[0], rtol=0, atol=1e-13)


def test_computed_torque_with_too_few_joints_is_refused() -> None:
    model = linkage().build().with_loops([closing()])
    q = model.closed_configuration(near_start(model))
    with pytest.raises(ControlError, match="joints"):
        law = oo.ComputedTorque(model, "coupler")
        oo.rollout(
            model, q[None], np.zeros((1, 9)), steps=2, controller=law,
            reference=oo.Hold(model.frame_pose(q, "coupler")),
        )  # fmt: skip
