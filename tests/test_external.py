"""Joints that follow commands from outside of the run: laws, trajectories, timeouts and wrong commands."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo

KP, KD, STEP = 25.0, 10.0, 1e-3
MOVE = np.linspace(0.2, -0.3, 7)


def servicer() -> tuple[oo.Model, np.ndarray, np.ndarray]:
    """Returns the servicer with a bent arm, at rest."""
    model = oo.robots.load("servicer")
    q = model.neutral()
    q[7:] = [0, 1.4260, 0, 1.3391, 0, -1.1943, 0]
    return model, q, np.zeros(model.nv)


def started(law: Any, **settings: Any) -> oo.Stepper:
    model, q, v = servicer()
    keywords = {"time_step": STEP} | settings
    return oo.Simulation(model, q, v, controller=law, **keywords).start(duration=3.0)


def sampled(e: np.ndarray, kp: float, kd: float, h: float, steps: int) -> np.ndarray:
    """Returns (e, e') of a double integrator under a = kp e + kd e', held for `h`, after some steps."""
    a = np.array([[1.0, h], [0.0, 1.0]]) - np.outer([h * h / 2, h], [kp, kd])
    return np.linalg.matrix_power(a, steps) @ e


def test_a_position_obeys_the_linear_error_law() -> None:
    """With a heavy base the joints are double integrators, so that the error is that of the sampled law."""
    builder = oo.ModelBuilder("hinge", base="base", mass=1e9, inertia=np.eye(3) * 1e9)
    builder.add_link("arm", parent="base", joint="hinge", axis=[0, 0, 1.0], mass=1.0, inertia=np.eye(3))
    robot = builder.build()
    q, v = robot.neutral(), np.zeros(robot.nv)
    stepper = oo.Simulation(robot, q, v, controller=oo.External(KP, KD), time_step=STEP).start()
    stepper.send("control", position=[0.4])
    stepper.advance_to(0.5)
    expected = sampled(np.array([0.4, 0.0]), KP, KD, STEP, 500)
    assert 0.4 - stepper.q[7] == pytest.approx(expected[0], rel=1e-7)
    assert -stepper.v[6] == pytest.approx(expected[1], rel=1e-7)
    stepper.send("control", velocity=[0.3])
    rate = float(stepper.v[6])
    stepper.advance_to(0.75)
    assert 0.3 - stepper.v[6] == pytest.approx((0.3 - rate) * (1 - KD * STEP) ** 250, rel=1e-7)


@pytest.mark.parametrize("integrator", ["rk4", "dormand_prince", "semi_implicit_euler"])
def test_a_quintic_trajectory_has_the_bits_of_the_same_waypoints(integrator: Any) -> None:
    model, q, v = servicer()
    settings: Any = {"time_step": 5e-3, "integrator": integrator, "control_period": 1e-2}
    goals = np.array([q[7:] + MOVE, q[7:] - MOVE])
    reference = oo.JointWaypoints([q[7:], *goals], times=[0.0, 0.8, 2.0])
    law = oo.JointComputedTorque(kp=100, kd=20)
    expected = oo.Simulation(model, q, v, controller=law, reference=reference, **settings).run(2.5)
    stepper = started(oo.External(100, 20), **settings)
    zeros = np.zeros((2, 7))
    stepper.send_trajectory("control", [0.8, 2.0], goals, velocities=zeros, accelerations=zeros)
    stepper.advance_to(2.5)
    trace = stepper.finish()
    rows = len(expected) - 1  # the row at the end of the run is that of a step
    for name in ("q", "v", "tau"):
        assert np.array_equal(getattr(trace, name)[:rows], getattr(expected, name)[:rows]), name


def desired(trace: oo.Trace) -> np.ndarray:
    """Returns the desired positions of the joints in each row."""
    return trace.q[:, 7:] + trace.tracking["control"]


@pytest.mark.parametrize("kind", ["linear", "cubic"])
def test_points_are_interpolated_as_by_joint_trajectory_controller(kind: str) -> None:
    stepper = started(oo.External(100, 20), time_step=1e-2)
    q = stepper.q[7:].copy()
    times, points = np.array([0.5, 1.0]), np.array([q + MOVE, q - MOVE])
    rates = np.array([0.5 * MOVE, 0 * MOVE])
    keywords: Any = {"velocities": rates} if kind == "cubic" else {}
    stepper.send_trajectory("control", times, points, **keywords)
    stepper.advance_to(1.5)
    trace = stepper.finish()
    knots, values = [0.0, 0.5, 1.0], np.array([q, *points])
    slopes = np.array([0 * MOVE, *rates])
    for t, row in zip(trace.time, desired(trace), strict=True):
        i = 0 if t < 0.5 else 1
        h, u = knots[i + 1] - knots[i], min((t - knots[i]) / (knots[i + 1] - knots[i]), 1.0)
        expected = values[i] + u * (values[i + 1] - values[i])
        if kind == "cubic":  # Hermite's form
            expected = (
                (2 * u**3 - 3 * u**2 + 1) * values[i] + (u**3 - 2 * u**2 + u) * h * slopes[i]
                + (3 * u**2 - 2 * u**3) * values[i + 1] + (u**3 - u**2) * h * slopes[i + 1]
            )  # fmt: skip
        assert np.abs(row - expected).max() < 1e-12, t


def test_a_new_trajectory_starts_from_the_desired_state() -> None:
    """This holds even if the joints lag behind, so that commands do not shake the arm."""
    stepper = started(oo.External(4, 4), time_step=1e-2)
    q = stepper.q[7:].copy()
    rest = {"velocities": [0 * MOVE], "accelerations": [0 * MOVE]}
    stepper.send_trajectory("control", [1.0], [q + MOVE], **rest)
    stepper.advance_to(0.5)
    stepper.send_trajectory("control", [1.0], [q], **rest)
    stepper.advance_to(2.0)
    trace = stepper.finish()
    path = desired(trace)
    assert np.abs(trace.tracking["control"][50]).max() > 1e-4
    middle = np.flatnonzero(np.isclose(trace.time, 0.5))[0]
    assert np.abs(path[middle] - q - MOVE / 2).max() < 1e-9
    change = np.diff(path, axis=0)
    assert (
        np.abs(np.diff(change, axis=0)).max() < 2e-3 * np.abs(MOVE).max()
    )  # neither position nor rate jumps
    assert np.abs(path[-1] - q).max() == 0.0


def test_a_start_in_the_past_skips_ahead_and_a_later_one_waits() -> None:
    q = servicer()[1][7:]
    points = np.array([q + MOVE * i for i in (1, 2, 3)])
    late = started(oo.External(100, 20), time_step=1e-2)
    late.advance_to(0.5)
    late.send_trajectory("control", [0.25, 0.75, 1.0], points, start=0.0)
    late.advance_to(1.2)
    path = desired(late.finish())
    assert np.abs(path[50] - q - 1.5 * MOVE).max() < 1e-12  # in the middle of the second interval
    assert np.abs(path[-1] - points[-1]).max() == 0.0
    early = started(oo.External(100, 20), time_step=1e-2)
    early.send("control", position=q + 5 * MOVE)
    early.advance_to(0.1)
    early.send_trajectory("control", [0.5], points[:1], start=0.3)
    early.advance_to(1.0)
    path = desired(early.finish())
    assert np.abs(path[1:30] - q - 5 * MOVE).max() < 1e-12
    assert np.abs(path[55] - q - 3 * MOVE).max() < 1e-12  # halfway from the earlier command


def test_efforts_are_torques_and_are_added_to_positions() -> None:
    effort = np.linspace(1e-3, 7e-3, 7)
    alone = started(oo.External())
    alone.send("control", effort=effort)
    alone.advance_to(0.1)
    assert np.array_equal(alone.finish().tau, np.tile(effort, (101, 1)))
    position = started(oo.External(KP, KD))
    position.send("control", position=servicer()[1][7:], effort=effort)
    position.advance_to(STEP)
    assert np.abs(position.finish().tau[0] - effort).max() < 1e-15


@pytest.mark.parametrize(("kp", "kd", "expected"), [(KP, KD, "hold"), (0, KD, "damp"), (0, 0, "free")])
def test_before_the_first_command(kp: float, kd: float, expected: str) -> None:
    model, q, v = servicer()
    v[6:] = 0.1
    stepper = oo.Simulation(model, q, v, controller=oo.External(kp, kd), time_step=1e-2).start()
    stepper.advance_to(3.0)
    trace = stepper.finish()
    moved, rate = trace.q[-1, 7:] - q[7:], trace.v[-1, 6:]
    if expected == "free":
        assert not trace.tau.any() and np.abs(rate).max() > 0.05
    else:
        assert np.abs(rate).max() < 1e-5
        assert np.abs(moved).max() < 1e-5 if expected == "hold" else np.abs(moved - 0.1 / KD).max() < 1e-3


@pytest.mark.parametrize("command", ["position", "velocity", "effort", "trajectory"])
@pytest.mark.parametrize("on_timeout", ["hold", "damp", "zero"])
def test_a_timeout(command: str, on_timeout: Any) -> None:
    """A stale velocity or effort must not continue: the joints stop, or move freely."""
    stepper = started(oo.External(100, 20, timeout=0.5, on_timeout=on_timeout), time_step=1e-2)
    q = stepper.q[7:].copy()
    if command == "trajectory":
        stepper.send_trajectory("control", [0.25], [q + MOVE])
    else:
        stepper.send(
            "control", **{command: {"position": q + MOVE, "velocity": MOVE}.get(command, MOVE / 100)}
        )
    last = 0.25 if command == "trajectory" else 0.0
    stepper.advance_to(3.0)
    trace = stepper.finish()
    due = np.flatnonzero(np.isclose(trace.time, last + 0.5))[0]
    before, after = desired(trace)[due - 1], desired(trace)[due:]
    assert (
        np.abs(before - (trace.q[due - 1, 7:] if command in ("velocity", "effort") else q + MOVE)).max()
        < 1e-12
    )
    if on_timeout == "zero":
        assert not trace.tau[due:].any() and trace.tau[due - 1].any()
    else:
        assert np.abs(trace.v[-1, 6:]).max() < 1e-6 and trace.tau[due].any()
    if on_timeout == "hold":
        kept = trace.q[due, 7:] if command in ("velocity", "effort") else q + MOVE
        assert np.abs(after - kept).max() == 0.0
        assert np.abs(trace.q[-1, 7:] - kept).max() < 1e-6


def test_a_command_prevents_the_timeout() -> None:
    stepper = started(oo.External(0, 20, timeout=0.3, on_timeout="zero"), time_step=1e-2)
    for k in range(10):
        stepper.advance_to(0.2 * (k + 1))
        stepper.send("control", velocity=MOVE)
    tau = stepper.finish().tau
    assert tau[30:-1].any(axis=1).all()


def test_a_command_takes_effect_at_the_next_update_of_the_controllers() -> None:
    for sent, expected in [(0.0, 0.0), (0.012, 0.02), (0.02, 0.02), (0.0200001, 0.04)]:
        stepper = started(oo.External(), time_step=1e-3, control_period=0.02)
        if sent:
            stepper.advance_to(sent)
        stepper.send("control", effort=MOVE)
        stepper.advance_to(0.1)
        trace = stepper.finish()
        first = trace.time[trace.tau.any(axis=1)][0]
        assert first == pytest.approx(expected, abs=1e-12), sent


Errors, ROW = oo.exceptions, [MOVE]
WRONG: list[tuple[Callable[[oo.Stepper], None], type[Exception], str]] = [
    (lambda s: s.send("contrl", position=MOVE), Errors.ControlError, "did you mean 'control'"),
    (lambda s: s.send("control"), Errors.ControlError, "is empty"),
    (lambda s: s.send("control", position=MOVE[:3]), Errors.ShapeError, "have 7 numbers, .* has 3 numbers"),
    (lambda s: s.send("control", effort=[np.nan] * 7), Errors.InputError, "finite"),
    (lambda s: s.send("control", velocity=[np.inf] * 7), Errors.InputError, "finite"),
    (lambda s: s.send("control", position=1e99 * MOVE), Errors.InputError, "within"),
    (lambda s: s.send("control", acceleration=MOVE), Errors.ControlError, "without positions or velocities"),
    (lambda s: s.send_trajectory("control", [], np.zeros((0, 7))), Errors.ControlError, "is empty"),
    (lambda s: s.send_trajectory("control", [1, 1], [MOVE, MOVE]), Errors.InputError, "increase"),
    (lambda s: s.send_trajectory("control", [-1], [MOVE]), Errors.InputError, "at least 0 s"),
    (lambda s: s.send_trajectory("control", [np.nan], [MOVE]), Errors.InputError, "finite"),
    (lambda s: s.send_trajectory("control", [1], [MOVE], start=-2), Errors.InputError, "later 'start'"),
    (lambda s: s.send_trajectory("control", [1, 2], [MOVE]), Errors.ShapeError, "2 rows, one per time, of 7"),
    (lambda s: s.send_trajectory("control", [1], MOVE), Errors.ShapeError, "one row per time"),
    (lambda s: s.send_trajectory("control", [1], ROW, accelerations=ROW), Errors.ControlError, "without"),
    (lambda s: s.wrench("tol", [1, 0, 0]), Errors.FrameError, "did you mean 'tool'"),
    (lambda s: s.wrench("tool", [1, 0, np.nan]), Errors.InputError, "finite"),
    (lambda s: s.wrench("tool", [1, 0]), Errors.ShapeError, "expected"),
    (lambda s: s.wrench("tool", [1, 0, 0], frame="lvlh"), Errors.InputError, "'world' and 'body'"),  # type: ignore[arg-type]
]  # fmt: skip


@pytest.mark.parametrize("number", range(len(WRONG)))
def test_a_wrong_command_changes_nothing(number: int) -> None:
    wrong, error, text = WRONG[number]
    traces = []
    for sends in (False, True):
        stepper = started(oo.External(KP, KD), time_step=1e-2)
        stepper.send("control", velocity=MOVE)
        stepper.advance_to(0.105)
        if sends:
            with pytest.raises(error, match=text):
                wrong(stepper)
        stepper.advance_to(0.3)
        traces.append(stepper.finish())
    assert np.array_equal(traces[0].q, traces[1].q) and np.array_equal(traces[0].time, traces[1].time)


def test_gains_that_a_command_requires() -> None:
    for law, command in [
        (oo.External(0, KD), {"position": MOVE}),
        (oo.External([1, 1, 1, 0, 1, 1, 1], KD), {"position": MOVE}),
        (oo.External(KP, 0), {"velocity": MOVE}),
    ]:
        with pytest.raises(Errors.ControlError, match=r"> 0 .*External\(kp=100"):
            started(law).send("control", **command)
    for keywords in ({"on_timeout": "hold"}, {"on_timeout": "damp"}, {"kp": 1.0}, {"timeout": np.nan}):
        with pytest.raises(Errors.ControlError):
            oo.External(**({"timeout": 1.0} | keywords))  # type: ignore[arg-type]
    oo.External(timeout=1.0, on_timeout="zero")


def test_only_external_controls_that_have_not_ended_take_commands() -> None:
    model, q, v = servicer()
    names = model.joint_names
    controls = [
        oo.Control(oo.External(KP, KD), joints=names[:4], name="arm", end=0.5),
        oo.Control(oo.JointComputedTorque(), reference=oo.JointHold(q[11:]), joints=names[4:], name="wrist"),
    ]
    stepper = oo.Simulation(model, q, v, controller=controls, time_step=1e-2).start()
    assert stepper.external == {"arm": names[:4]}
    only = r".*the only control that follows them is 'arm'"
    with pytest.raises(Errors.ControlError, match="'wrist' does not follow external commands" + only):
        stepper.send("wrist", position=MOVE[:3])
    with pytest.raises(Errors.ControlError, match="no control 'control' follows" + only):
        stepper.send("control", position=MOVE)
    with pytest.raises(Errors.ControlError, match="is driven by control 'arm'"):
        stepper.command({names[0]: 1.0})
    stepper.send("arm", position=q[7:11])
    stepper.advance_to(0.6)
    with pytest.raises(Errors.ControlError, match="has ended"):
        stepper.send("arm", position=q[7:11])
    with pytest.raises(Errors.ControlError, match="a reference is given to an External controller"):
        oo.Simulation(model, q, v, controller=oo.External(), reference=oo.JointHold(q[7:]))
    with pytest.raises(Errors.ControlError, match="neither a goal"):
        oo.Simulation(model, q, v, controller=[oo.Control(oo.External(), goal=oo.Goal(tolerance=1))])


def test_friction_is_compensated_for_positions_and_acts_against_efforts() -> None:
    builder = oo.ModelBuilder("slider", base="base", mass=20.0, inertia=np.eye(3))
    builder.add_link(
        "mass", parent="base", joint="slide", kind="prismatic", axis=[1, 0, 0], mass=5.0, inertia=np.eye(3),
        friction=1.0, damping=2.0,
    )  # fmt: skip
    model = builder.build()
    q, v = model.neutral(), np.zeros(model.nv)
    reduced = 20.0 * 5.0 / 25.0

    def end(**command: Any) -> tuple[float, float]:
        stepper = oo.Simulation(model, q, v, controller=oo.External(KP, KD), time_step=STEP).start()
        stepper.send("control", **command)
        stepper.advance_to(0.5)
        trace = stepper.finish()
        assert all(passed for _, _, _, passed in trace.certificate())
        return float(trace.q[-1, 7]), float(trace.v[-1, 6])

    expected = sampled(np.array([0.4, 0.0]), KP, KD, STEP, 500)
    assert 0.4 - end(position=[0.4])[0] == pytest.approx(
        expected[0], rel=1e-2
    )  # the damping is held for a step
    assert end(effort=[0.9]) == (0.0, 0.0)  # the joint sticks
    rate = (3.0 - 1.0) / 2.0 * (1 - np.exp(-2.0 / reduced * 0.5))  # m v̇ = τ − f − b v
    assert end(effort=[3.0])[1] == pytest.approx(rate, rel=1e-9)
