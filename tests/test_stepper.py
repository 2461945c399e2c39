"""A run that is advanced from outside: the bits of one call, and commands beside controllers."""

from __future__ import annotations

import itertools
import time
from typing import Any

import numpy as np
import pytest
from bundled import ONE_ROBOT
from stepper_runs import Hold, assert_same_bits, passive, scenario, torque

import onorbit_rs as oo
from onorbit_rs.scenario import load
from onorbit_rs.scenario.build import build
from onorbit_rs.tools.validation import grasp_worlds


@pytest.mark.parametrize(
    "settings",
    [
        {}, {"integrator": "dormand_prince"}, {"integrator": "semi_implicit_euler"}, {"record_every": 7},
        {"enforce_limits": True, "restitution": 0.4},
    ],
    ids=str,
)  # fmt: skip
@pytest.mark.parametrize("dt", [0.02, 0.0371])
def test_pieces_have_the_bits_of_one_call(settings: dict[str, Any], dt: float) -> None:
    whole = scenario(**settings).run(2.0)
    stepper = scenario(**settings).start(duration=2.0)
    while stepper.time < 2.0:
        stepper.advance_to(min(stepper.time + dt, 2.0))
        assert np.isfinite(stepper.q).all() and np.isfinite(stepper.v).all()
    assert_same_bits(stepper.trace(), whole)
    assert stepper.trace().certificate() == whole.certificate()
    assert_same_bits(stepper.finish(), whole)


@pytest.mark.filterwarnings("ignore:the inertia of link")
@pytest.mark.parametrize("name", ONE_ROBOT)
def test_every_bundled_scenario_has_the_same_bits_in_pieces(name: str) -> None:
    data = load(name).resolved(load(name).file.parent)  # type: ignore[union-attr]
    step = data["simulation"]["time_step"]
    duration = min(data["simulation"]["duration"], 50 * step)
    whole = build(load(data)).simulation.run(duration)
    stepper = build(load(data)).simulation.start(duration=duration)
    for _ in range(7):
        stepper.advance_to(min(stepper.time + 9.3 * step, duration))
        _ = stepper.q, stepper.v
    stepper.advance_to(duration)
    assert_same_bits(stepper.finish(), whole)


def test_fifty_hertz_without_a_planned_end_has_the_bits_of_a_run() -> None:
    stepper = scenario().start()
    assert stepper.duration is None
    for _ in range(100):
        stepper.advance(0.02)
    assert stepper.time == 2.0, "times on the grid do not accumulate rounding"
    assert_same_bits(stepper.trace(), scenario().run(2.0))


@pytest.mark.parametrize("pieces", [[0.35], [0.02], [0.0371, 0.0007]], ids=str)
@pytest.mark.parametrize("law", ["grip", "pid"])
def test_a_grasp_has_the_same_bits_in_pieces_with_and_without_a_planned_end(
    law: str, pieces: list[float]
) -> None:
    """The run ends at the last grid point, 70 · 0.005 s = 0.35000000000000003 s, not at 0.35 s."""
    end, step = 0.35, 5e-3
    reference = oo.JointWaypoints([[0.0225], [0.0185]], times=[0.0, 0.2])
    pid = oo.Control(oo.JointPid(p=4000.0, d=400.0), reference=reference, joints=["left_jaw"], name="jaw")
    made = grasp_worlds.world([grasp_worlds.grip() if law == "grip" else pid], opening=0.045)

    def run(duration: float | None) -> oo.WorldTrace:
        stepper = oo.Simulation(made, time_step=step).start(duration=duration)
        for piece in itertools.cycle(pieces):
            if stepper.time > end - 1e-9:
                return stepper.finish()
            stepper.advance_to(min(stepper.time + piece, end))
        raise AssertionError

    whole = oo.Simulation(made, time_step=step).run(end)
    assert whole["hand"].time[-1] == 70 * step != end
    assert np.any(np.asarray(whole.contacts["left"].force)), "the hand holds the bar"
    for trace in (run(end), run(None)):
        for system in ("hand", "bar"):
            assert_same_bits(trace[system], whole[system])
        for side in ("left", "right"):
            for part in ("force", "point", "elastic", "dissipated"):
                own = getattr(trace.contacts[side], part)
                np.testing.assert_array_equal(own, getattr(whole.contacts[side], part))


def test_the_state_is_that_of_the_row_and_cannot_be_written() -> None:
    stepper = scenario().start()
    stepper.advance(0.5)
    trace = stepper.trace()
    assert trace.time[-1] == stepper.time == 0.5 and not trace.is_complete
    np.testing.assert_array_equal(stepper.q, trace.q[-1])
    np.testing.assert_array_equal(stepper.v, trace.v[-1])
    for array in (stepper.q, stepper.v):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1.0
    assert repr(stepper) == "<Stepper: at t = 0.5 s>"
    assert repr(scenario().start(duration=2.0)) == "<Stepper: at t = 0 s of 2 s>"


def test_a_trace_does_not_change_when_the_run_goes_on() -> None:
    stepper = scenario().start()
    stepper.advance(0.1)
    trace, q = stepper.trace(), stepper.q
    before = trace.q.copy()
    stepper.advance(0.1)
    np.testing.assert_array_equal(trace.q, before)
    np.testing.assert_array_equal(q, before[-1])
    assert len(stepper.trace()) == 201


@pytest.mark.parametrize("integrator", ["rk4", "dormand_prince"])
@pytest.mark.parametrize("stop", [0.5, 0.50042])
def test_a_checkpoint_resumes_to_the_same_bits(integrator: str, stop: float) -> None:
    whole = scenario(integrator=integrator).run(2.0)
    stepper = scenario(integrator=integrator).start(duration=2.0)
    stepper.advance_to(stop)
    checkpoint = stepper.checkpoint()
    again = scenario(integrator=integrator).start(resume=checkpoint)
    assert again.time == stop and again.duration == 2.0
    np.testing.assert_array_equal(again.q, stepper.q)
    again.advance_to(2.0)
    assert_same_bits(again.finish(), whole)
    assert_same_bits(scenario(integrator=integrator).run(2.0, resume=checkpoint), whole)


def test_columns_are_the_new_rows() -> None:
    stepper = scenario().start()
    stepper.advance(0.1)
    first = stepper.columns()
    stepper.advance(0.1)
    second = stepper.columns(since=len(first["time"]))
    trace = stepper.trace()
    joined = np.concatenate([first["q"], second["q"]])
    np.testing.assert_array_equal(joined, trace.q[:-1])
    assert stepper.checkpoint(since=150).columns["q"].shape == (50, trace.q.shape[1])
    with pytest.raises(oo.exceptions.InputError, match="since is 201, but the run has 200 rows"):
        stepper.columns(201)


@pytest.mark.parametrize("every", [1, 5])
def test_rows_that_are_dropped_do_not_change_the_motion(every: int) -> None:
    alone = scenario(record_every=every).run(0.4)
    stepper = scenario(record_every=every).start(duration=0.4)
    stepper.advance_to(0.2)
    stepper.drop_rows(10_000)
    assert len(stepper.columns()["time"]) == 200 // every, "fewer rows than are kept"
    stepper.drop_rows(10)
    assert len(stepper.columns()["time"]) == 11
    stepper.present()
    stepper.advance_to(0.4)
    checkpoint = stepper.checkpoint()
    trace = stepper.finish()
    kept = np.r_[0, 200 // every - 10 : len(alone)]
    for name in alone.columns():
        own, all_rows = getattr(trace, name), np.asarray(getattr(alone, name))
        np.testing.assert_array_equal(own, all_rows[kept], err_msg=name)
    checks, full = ([check[0] for check in each.certificate()] for each in (trace, alone))
    pairs = {"base_rows_residual_rel", "attitude_consistency", "center_of_mass_error_rel"}
    assert set(full) - set(checks) == (pairs if every == 1 else set())
    assert all(passed for *_, passed in trace.certificate())
    with pytest.raises(oo.exceptions.CheckpointError, match="rows"):
        scenario(record_every=every).start(resume=checkpoint)


@pytest.mark.filterwarnings("ignore:the inertia of link")
@pytest.mark.parametrize("name", ["iss_gravity_gradient", "geo_radiation", "humanoid_reach"])
def test_looking_just_after_a_tick_does_not_change_the_motion(name: str) -> None:
    """Laws that compensate the environment saw its wrenches over the shortened step."""
    simulation = build(load(name)).simulation
    step = load(name).simulation.time_step
    whole = simulation.run(50 * step)
    stepper = simulation.start(duration=50 * step)
    for k in (10, 11, 20):
        stepper.advance_to((k + 1e-3) * step)
        _ = stepper.q, stepper.trace()
        stepper.advance_to((k + 0.5) * step)
        _ = stepper.v
        stepper.advance_to((k + 1) * step)
        _ = stepper.trace()
    stepper.advance_to(50 * step)
    assert_same_bits(stepper.finish(), whole)


def test_long_adaptive_steps_are_tried_without_their_rows() -> None:
    """A robot at rest takes steps of many rows; each call once recorded all of them."""
    model = oo.robots.load("humanoid_torso")
    stepper = oo.Simulation(
        model, model.neutral(), np.zeros(model.nv), integrator="dormand_prince"
    ).start()  # fmt: skip
    stepper.advance(5.0)
    begin = time.perf_counter()
    for _ in range(50):
        stepper.advance(0.02)
        _ = stepper.q
    assert time.perf_counter() - begin < 2.0, "it took 3.5 s per call"
    assert abs(stepper.time - 6.0) < 1e-9 and stepper.trace().time[-1] == stepper.time


def test_a_command_follows_a_control_that_ends() -> None:
    names = oo.robots.load("humanoid_torso").joint_names
    group = oo.Control(Hold(lambda t: np.full(2, 1e-3)), joints=names[:2], name="a", end=0.5)
    stepper = passive(controller=[group]).start()
    stepper.advance_to(0.5)
    stepper.command({names[0]: 2e-3})
    stepper.advance(0.1)
    assert stepper.trace().tau[-1, 0] == 2e-3


@pytest.mark.filterwarnings("ignore:the inertia of link")
@pytest.mark.parametrize("name", ["dual_arm_reach", "geo_radiation"])
def test_a_run_resumes_from_its_very_beginning(name: str) -> None:
    simulation = build(load(name)).simulation
    duration = 20 * load(name).simulation.time_step
    whole = simulation.run(duration)
    checkpoint = simulation.start(duration=duration).checkpoint()
    assert_same_bits(simulation.run(duration, resume=checkpoint), whole)


def test_commands_have_the_bits_of_a_controller_that_gives_them() -> None:
    whole = passive(controller=Hold(torque), control_period=0.02).run(1.0)
    stepper = passive().start(duration=1.0)
    for k in range(50):
        stepper.command(torque(stepper.time))
        stepper.advance_to((k + 1) * 0.02)
    stepper.command(torque(stepper.time))
    trace = stepper.finish()
    for name in ("time", "q", "v", "tau", "momentum", "work"):
        np.testing.assert_array_equal(getattr(trace, name), getattr(whole, name), err_msg=name)


def test_a_command_by_names_works_beside_a_controller() -> None:
    model = oo.robots.load("humanoid_torso")
    names = model.joint_names
    group = oo.Control(Hold(lambda t: torque(t)[:3]), joints=names[:3], name="arm")
    stepper = passive(controller=[group]).start()
    stepper.command({names[5]: 2e-3})
    stepper.advance(0.1)
    stepper.command({names[6]: 1e-3})
    stepper.advance(0.1)
    tau = stepper.trace().tau
    np.testing.assert_array_equal(tau[50], [*torque(0.05)[:3], 0.0, 0.0, 2e-3, 0.0])
    np.testing.assert_array_equal(tau[150], [*torque(0.15)[:3], 0.0, 0.0, 2e-3, 1e-3])
    with pytest.raises(oo.exceptions.ControlError, match="is driven by control 'arm', which is active"):
        stepper.command(np.zeros(7))
    with pytest.raises(oo.exceptions.ControlError, match=names[1]):
        stepper.command({names[1]: 0.0})


def test_a_command_within_a_step_cuts_it() -> None:
    stepper = passive(integrator="dormand_prince").start()
    stepper.advance_to(0.1234)
    stepper.command(np.full(7, 1e-3))
    stepper.advance_to(0.3)
    fine = passive(time_step=1e-4).start()
    fine.advance_to(0.1234)
    fine.command(np.full(7, 1e-3))
    fine.advance_to(0.3)
    np.testing.assert_allclose(stepper.q, fine.q, atol=1e-9)


def test_a_command_after_a_look_at_the_rows_is_not_lost():
    """Reading the rows takes a trial step, after which a command still holds."""
    robot = oo.robots.load("servicer")
    traces = []
    for looks in (False, True):
        simulation = oo.Simulation(robot, robot.neutral(), np.zeros(robot.nv), time_step=1e-2)
        stepper = simulation.start(duration=1.0)
        stepper.advance_to(0.5)
        if looks:
            stepper.trace()
        stepper.command(np.ones(len(robot.joint_names)))
        stepper.advance_to(1.0)
        traces.append(stepper.trace())
    np.testing.assert_array_equal(traces[1].q, traces[0].q)
    assert traces[1].tau[-1].all()
