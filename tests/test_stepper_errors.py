"""Bad input to a stepper raises typed errors and leaves the run as it was."""

from __future__ import annotations

import json
import threading
import time
from typing import Any

import numpy as np
import pytest
from stepper_runs import Hold, assert_same_bits, passive

import onorbit_rs as oo


@pytest.mark.parametrize("dt", [0.0, -0.1, np.nan, np.inf, -np.inf])
def test_a_time_that_is_not_positive_is_rejected(dt: float) -> None:
    stepper = passive().start()
    stepper.advance(0.1)
    with pytest.raises(oo.exceptions.InputError, match=r"dt is .* s; it must be positive and finite"):
        stepper.advance(dt)
    assert stepper.time == 0.1


@pytest.mark.parametrize(
    ("t", "message"),
    [
        (0.05, "t is 0.05 s, which is before the current time, 0.1 s"),
        (-1.0, "t is -1 s, which is before the current time"),
        (np.nan, "t is NaN s; it must be finite"),
        (np.inf, "t is inf s; it must be finite"),
        (1.1, "t is 1.1 s, but the planned end of the run is 1 s; start the run with a longer duration"),
    ],
)
def test_times_that_cannot_be_reached_are_rejected(t: float, message: str) -> None:
    stepper = passive().start(duration=1.0)
    stepper.advance(0.1)
    before = stepper.q
    with pytest.raises(oo.exceptions.InputError, match=message):
        stepper.advance_to(t)
    assert stepper.time == 0.1
    np.testing.assert_array_equal(stepper.q, before)
    stepper.advance_to(0.1)  # the present
    stepper.advance_to(1.0)
    assert_same_bits(stepper.finish(), passive().run(1.0))


@pytest.mark.parametrize(
    ("tau", "error", "message"),
    [
        (np.zeros(6), "ShapeError", r"tau has shape \(6,\); expected \(7,\)"),
        (np.zeros((7, 1)), "ShapeError", r"tau has shape \(7, 1\)"),
        ([0.0, 0.0, np.nan, 0.0, 0.0, 0.0, 0.0], "InputError", r"tau\[2\] is NaN; it must be finite"),
        ({"nothing": 1.0}, "InputError", "tau contains the unknown joint 'nothing' of robot '"),
        ({"right_joint_1": np.inf}, "InputError", "it must be finite"),
        ({"right_joint_1": [1.0, 2.0]}, "ShapeError", "has shape"),
        ({"right_joint_1": "much"}, "DtypeError", "is text"),
        ("much", "DtypeError", "is text"),
    ],
    ids=str,
)
def test_commands_that_are_wrong_are_rejected(tau: Any, error: str, message: str) -> None:
    model = oo.robots.load("humanoid_torso")
    if isinstance(tau, dict) and "right_joint_1" in tau:
        tau = {model.joint_names[0]: tau["right_joint_1"]}
    stepper = passive().start(duration=0.2)
    stepper.advance(0.1)
    with pytest.raises(getattr(oo.exceptions, error), match=message):
        stepper.command(tau)
    stepper.advance_to(0.2)
    assert_same_bits(stepper.finish(), passive().run(0.2))


@pytest.mark.parametrize("duration", [0.0, -1.0, np.nan, np.inf])
def test_a_planned_end_that_is_not_positive_is_rejected(duration: float) -> None:
    simulation = passive()
    with pytest.raises(oo.exceptions.InputError, match=r"duration is .* s; it must be positive and finite"):
        simulation.start(duration=duration)
    assert len(simulation.run(0.01)) == 11


@pytest.mark.parametrize("end", ["start", "run", "finish"])
def test_a_stepper_after_its_end_is_rejected(end: str) -> None:
    simulation = passive()
    stepper = simulation.start()
    stepper.advance(0.1)
    _ = {"start": simulation.start, "run": lambda: simulation.run(0.1), "finish": stepper.finish}[end]()
    for use in (
        lambda: stepper.advance(0.1), lambda: stepper.advance_to(1.0), lambda: stepper.q,
        lambda: stepper.time, lambda: stepper.command(np.zeros(7)), stepper.trace, stepper.checkpoint,
        stepper.columns, stepper.finish,
    ):  # fmt: skip
        with pytest.raises(oo.exceptions.SimulationError, match="run has ended"):
            use()
    assert repr(stepper) == "<Stepper: ended or in use>"


def test_a_run_that_diverged_has_ended_with_its_rows() -> None:
    model = oo.robots.load("humanoid_torso")
    v = np.zeros(model.nv)
    v[6:] = 1e4
    stepper = oo.Simulation(model, model.neutral(), v, time_step=0.1).start()
    with pytest.raises(oo.exceptions.SimulationError, match="diverged") as caught:
        stepper.advance(1e3)
    assert len(caught.value.trace) >= 1 and not caught.value.trace.is_complete
    with pytest.raises(oo.exceptions.SimulationError, match="run has ended"):
        stepper.advance(0.1)


def test_two_threads_cannot_use_one_stepper() -> None:
    simulation = passive()
    stepper = simulation.start()
    thread = threading.Thread(target=lambda: stepper.advance_to(60.0))
    thread.start()
    refused = 0
    while thread.is_alive():
        for use in (lambda: stepper.advance(0.1), lambda: stepper.time, simulation.start):
            try:
                use()
            except oo.exceptions.SimulationError as error:
                assert "in use by" in str(error)
                refused += 1
            else:
                break  # the thread has not begun, or has ended
        if refused >= 3:
            break
    thread.join()
    assert refused >= 3


def test_a_controller_cannot_use_the_stepper_that_calls_it() -> None:
    seen: list[str] = []

    def torque(t: float) -> Any:
        with pytest.raises(oo.exceptions.SimulationError, match="by an enclosing call") as caught:
            stepper.advance(1.0)
        seen.append(str(caught.value))
        return np.zeros(7)

    stepper = passive(controller=Hold(torque), control_period=0.05).start()
    stepper.advance(0.1)
    assert len(seen) == 2


def test_controllers_are_updated_once_per_tick() -> None:
    controller = Hold(lambda t: np.zeros(7))
    stepper = passive(controller=controller, control_period=0.05).start(duration=0.5)
    for _ in range(20):
        stepper.advance(0.025)
        _ = stepper.q, stepper.v, stepper.trace()
    stepper.finish()
    assert controller.calls == 11


def test_an_error_of_a_controller_is_raised_as_it_is() -> None:
    def fail(t: float) -> Any:
        raise KeyError("not today")

    stepper = passive(controller=Hold(fail)).start()
    with pytest.raises(KeyError, match="not today") as caught:
        stepper.advance(0.1)
    assert caught.value.trace is not None  # type: ignore[attr-defined]


def test_a_limit_of_wall_clock_time_returns_early() -> None:
    stepper = passive().start()
    begin = time.perf_counter()
    stepper.advance_to(1e6, wall_s=0.05)
    assert time.perf_counter() - begin < 5.0
    assert 0.0 < stepper.time < 1e6
    with pytest.raises(oo.exceptions.InputError, match=r"wall_s is -1 s; it must be from 0 to 1\.8e19 s"):
        stepper.advance_to(1e6, wall_s=-1.0)


def test_a_checkpoint_of_a_controller_that_cannot_be_saved_is_refused_and_the_run_goes_on() -> None:
    controller = Hold(lambda t: np.zeros(7))  # its function cannot be saved
    stepper = passive(controller=controller).start()
    stepper.advance(0.1)
    with pytest.raises(oo.exceptions.ControlError, match=r"the controller cannot be saved .*get_state"):
        stepper.checkpoint()
    stepper.advance(0.1)
    assert stepper.time == 0.2


def test_a_planned_end_that_is_refused_does_not_end_the_present_run() -> None:
    simulation = passive()
    stepper = simulation.start()
    stepper.advance(0.1)
    with pytest.raises(oo.exceptions.InputError, match="duration is -1 s"):
        simulation.start(duration=-1.0)
    stepper.advance(0.1)
    assert stepper.time == 0.2


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("time", 1e300), ("time", 1.5), ("time", -5.0), ("time", 0.05),
        ("progress.cursor.now", 0.3), ("progress.cursor.now", -1.0),
        ("progress.cursor.next_grid", 0), ("progress.state.trees.0.q", [0.0] * 14),
        ("progress.systems.0.rows", 3),
        ("progress.step_control.step", 1e-320),
    ],
)  # fmt: skip
def test_a_checkpoint_that_no_run_leaves_is_refused(path: str, value: Any) -> None:
    integrator = "dormand_prince" if "step_control" in path else "rk4"
    stepper = passive(integrator=integrator).start(duration=1.0)
    stepper.advance_to(0.1)
    checkpoint = stepper.checkpoint()
    state = json.loads(checkpoint.state)
    *parents, key = path.split(".")
    part = state["groups"][0]
    for parent in parents:
        part = part[int(parent)] if parent.isdigit() else part[parent]
    part[key] = value
    damaged = oo.Checkpoint(json.dumps(state), checkpoint.columns)
    simulation = passive(integrator=integrator)
    assert simulation.start(resume=checkpoint).time == 0.1
    with pytest.raises(oo.exceptions.CheckpointError, match="the checkpoint"):
        simulation.start(resume=damaged)


def test_rows_that_are_missing_from_a_checkpoint_are_named() -> None:
    stepper = passive().start(duration=1.0)
    stepper.advance(0.1)
    with pytest.raises(oo.exceptions.CheckpointError, match=r"after 100 rows, .* has 50 rows"):
        passive().start(resume=stepper.checkpoint(since=50))
