"""Checks slipping and holding brakes against closed forms, and their impulses against Gauss's principle."""

from __future__ import annotations

import pickle
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.common.coordinates import BASE_NV
from onorbit_rs.exceptions import EngineError, InputError, WorldError
from onorbit_rs.tools.validation import brakes
from onorbit_rs.tools.validation.brakes import BASE, SLIP, SPIN, WHEEL, spinning_wheel
from onorbit_rs.tools.validation.capture import random_pair, run


def failed(trace: Any) -> list[Any]:
    """Returns the lines of the certificate that fail."""
    return [line for line in trace.certificate() if not line[-1]]


REDUCED = BASE * WHEEL / (BASE + WHEEL)  # kg m2


@pytest.mark.parametrize("integrator", ["rk4", "dormand_prince", "semi_implicit_euler"])
def test_a_slipping_brake_stops_a_wheel_as_the_closed_form_says(integrator: str) -> None:
    trace = spinning_wheel(slip_torque=SLIP, integrator=integrator)
    chaser, (engage,) = trace["chaser"], trace.events
    assert (engage.kind, engage.time, engage.energy_lost) == ("engage", 0.5, 0.0)
    assert engage.systems == ("chaser", "chaser") and not np.any(engage.impulse)
    start, stop = 0.5, 0.5 + SPIN * REDUCED / SLIP
    for t, q, v in zip(chaser.time, chaser.q[:, 7], chaser.v[:, 6], strict=True):
        slowed = np.clip(t - start, 0.0, stop - start)
        assert abs(v - (SPIN - SLIP / REDUCED * slowed)) < 1e-11
        if integrator != "semi_implicit_euler":
            angle = SPIN * min(t, start) + SPIN * slowed - 0.5 * SLIP / REDUCED * slowed**2
            assert abs(q - angle) < 1e-11
    held = chaser.time > stop + 0.01
    assert np.all(chaser.v[held, 6] == 0.0) and len(set(chaser.q[held, 7])) == 1
    if integrator != "semi_implicit_euler":
        assert abs(chaser.dissipated[-1] - 0.5 * REDUCED * SPIN**2) < 1e-12
        assert failed(trace) == []
    assert np.abs(trace.momentum - trace.momentum[0]).max() < 1e-13


def test_a_rigid_brake_stops_the_wheel_at_once() -> None:
    trace = spinning_wheel()
    (engage,) = trace.events
    after = trace["chaser"].v[trace["chaser"].time > 0.5]
    assert abs(engage.energy_lost - 0.5 * REDUCED * SPIN**2) < 1e-13
    assert np.abs(engage.impulse - [0, 0, 0, 0, 0, -REDUCED * SPIN]).max() < 1e-13
    assert np.all(after[:, 6] == 0.0)
    assert np.abs(after[:, 5] - WHEEL * SPIN / (BASE + WHEEL)).max() < 1e-13
    assert failed(trace) == []


def test_a_brake_begins_to_slip_at_its_slip_torque() -> None:
    def moved(torque: float, slip: float = SLIP) -> float:
        chaser, target = brakes.wheel_system(0.0, slip, torque=torque)
        trace = run([chaser, target], [], 1.0, time_step=0.01)
        return float(np.abs(trace["chaser"].q[:, 7]).max())

    assert moved(SLIP * (1.0 - 1e-6)) == 0.0
    assert moved(SLIP * (1.0 + 1e-6)) > 0.0
    assert moved(1e3 * SLIP, np.inf) == 0.0


@pytest.mark.parametrize("seed", range(3200, 3212))
def test_a_rigid_brake_moves_random_trees_as_by_gauss_s_principle(seed: int) -> None:
    errors = dict(zip(brakes.ENGAGE, brakes.engage_against_gauss(seed), strict=True))
    assert all(errors[name] <= gate for name, gate in brakes.ENGAGE.items()), errors


@pytest.mark.parametrize("seed", range(3200, 3212))
def test_a_capture_with_engaged_brakes_is_that_of_gauss_s_principle(seed: int) -> None:
    off, left_out = brakes.capture_against_gauss(seed)
    assert off < 1e-12
    assert left_out > 1e-6  # control: without the rows of the brakes


def arm(seed: int = 3200, **settings: Any) -> tuple[oo.System, oo.System]:
    first, second = random_pair(seed)
    joints = first.model.joint_names
    v = first.v.copy()
    v[BASE_NV] = 0.0
    actuators = [oo.Brake("b0", joints[0], engaged=True), oo.Brake("b1", joints[1], slip_torque=0.05)]
    a = oo.System("a", first.model, first.q, v, actuators=actuators, **settings)
    return a, oo.System("b", second.model, second.q, second.v)


EVENTS = (
    oo.Engage("hold", "a/b1", at=0.011),
    oo.Capture("grasp", "a/base", "b/base", at=0.02),
    oo.Disengage("free", "a/b0", after="grasp", delay=0.02),
    oo.Engage("again", "a/b0", after="free", delay=0.02),
    oo.Release("let_go", "grasp", at=0.08, impulse=[1.0, 0, 0, 0, 0.1, 0]),
    oo.Disengage("off", "a/b1", at=0.09),
)


def test_brakes_stay_engaged_through_captures_and_releases() -> None:
    first, second = random_pair(3200)
    grasp = oo.Capture("grasp", f"a/{first.frame}", f"b/{second.frame}", at=0.02)
    events = [grasp if event.name == "grasp" else event for event in EVENTS]
    world = oo.World(arm(), events=events)
    trace: Any = oo.Simulation(world, time_step=1e-3).run(0.1)
    a = trace["a"]
    assert [event.kind for event in trace.events] == [
        "engage", "capture", "disengage", "engage", "release", "disengage"
    ]  # fmt: skip
    held = (a.time <= 0.04) | (a.time > 0.0600001)
    free = (a.time > 0.0401) & (a.time < 0.0599)
    assert np.all(a.v[held & (a.time != 0.04) & (a.time != 0.06), 6] == 0.0)
    assert np.all(a.v[free, 6] != 0.0)
    assert len(set(a.q[a.time < 0.04, 7])) == 1 and len(set(a.q[a.time > 0.0601, 7])) == 1
    assert all(np.max(event.momentum_error) < 1e-13 for event in trace.events)
    assert failed(trace) == []
    # the same bits after a checkpoint, wherever it is taken
    for until in (0.015, 0.03, 0.05, 0.07, 0.085):
        stepper = oo.Simulation(world, time_step=1e-3).start(duration=0.1)
        stepper.advance_to(until)
        saved = stepper.checkpoint()
        resumed: Any = oo.Simulation(world, time_step=1e-3).run(0.1, resume=saved)
        assert np.array_equal(resumed["a"].q, a.q) and np.array_equal(resumed["b"].v, trace["b"].v)
        assert np.array_equal(resumed["a"].dissipated, a.dissipated)


def test_a_stepper_triggers_a_brake() -> None:
    chaser, target = brakes.wheel_system(SPIN)
    world = oo.World([chaser, target], events=[oo.Engage("stop", "chaser/brake", on_command=True)])
    stepper: Any = oo.Simulation(world, time_step=0.01).start(duration=1.0)
    stepper.advance_to(0.333)
    stepper.trigger("stop")
    stepper.advance_to(1.0)
    assert stepper["chaser"].v[6] == 0.0 and stepper.trace().events[0].time == 0.333


def test_a_brake_of_one_robot_holds_in_a_run_of_one_robot() -> None:
    model = brakes.wheel()
    q, v = np.zeros(8), np.zeros(7)
    q[6], v[5] = 1.0, 0.3
    for slip in (SLIP, np.inf):
        held = [oo.Brake("brake", "spin", slip_torque=slip, engaged=True)]
        trace = oo.Simulation(model, q, v, time_step=0.01, actuators=held).run(1.0)
        assert np.all(trace.q[:, 7] == 0.0) and failed(trace) == []


def test_the_trace_of_one_system_has_its_events() -> None:
    chaser, target = brakes.wheel_system(SPIN, SLIP)
    events = [oo.Engage("slow", "chaser/brake", at=0.1)]
    alone: Any = oo.Simulation(oo.World([chaser], events=events), time_step=0.01).run(0.3)
    (record,) = alone.events
    assert (record.name, record.kind, record.time) == ("slow", "engage", 0.1)
    assert record.systems == ("chaser", "chaser")
    assert pickle.loads(pickle.dumps(alone)).events == [record]
    # in a world of several systems, each trace has the events that concern its system
    both: Any = oo.Simulation(oo.World([chaser, target], events=events), time_step=0.01).run(0.3)
    assert both["chaser"].events == both.events == [record]
    assert both["target"].events == []


def test_an_engaged_event_that_changes_nothing_is_not_recorded() -> None:
    chaser, target = brakes.wheel_system(0.0, SLIP)
    events = [oo.Engage("again", "chaser/brake", at=0.1)]
    trace = run([chaser, target], events, 0.2, time_step=0.01)
    assert trace.events == []


def test_brakes_pickle() -> None:
    model = oo.robots.load("humanoid_dual_arm")
    first, second = model.joint_names[:2]
    actuators = [oo.Brake("b", first, slip_torque=2.0, engaged=True), oo.Brake("c", second)]
    q = np.zeros(model.nq)
    q[6] = 1.0
    craft = oo.System("a", model, q, np.zeros(model.nv), actuators=actuators)
    events: list[Any] = [
        oo.Disengage("off", "a/b", at=0.01),
        oo.Engage("on", "a/c", after="off", delay=0.001),
    ]
    target = brakes.wheel_system(0.0)[1]
    world = pickle.loads(pickle.dumps(oo.World([craft, target], events=events)))
    trace: Any = oo.Simulation(world, time_step=1e-3).run(0.02)
    records = trace.events
    assert [record.kind for record in records] == ["disengage", "engage"]
    assert pickle.loads(pickle.dumps(records[0])) == records[0]
    assert repr(records[0]) == "<disengage 'off' of a at t = 0.01 s: 0 J lost>"
    assert [repr(one) for one in (*events, actuators[1])] == [
        "<Disengage 'off': disengages a/b>", "<Engage 'on': engages a/c>",
        f"<Brake 'c' of {second}>",
    ]  # fmt: skip


def test_runs_in_steps_of_any_length_agree() -> None:
    ends = [spinning_wheel(slip_torque=SLIP, time_step=step)["chaser"].q[-1] for step in (0.01, 0.003)]
    assert all(np.abs(a - b).max() < 1e-11 for a, b in pairwise(ends))


BAD: tuple[tuple[list[oo.Brake], str, Any], ...] = (
    ([oo.Brake("b", "spinn")], "no joint|joint 'spinn'", None),
    ([oo.Brake("b", "spin"), oo.Brake("b", "spin")], "two brakes of one system have the name 'b'", None),
    ([oo.Brake("b", "spin"), oo.Brake("c", "spin")], "'b' and 'c' are both on the joint 'spin'", None),
    ([oo.Brake("b", "spin", engaged=True)], "starts with the rate 2 rad/s", None),
    (
        [oo.Brake("b", "spin")],
        "the only brake of the system 'chaser' is 'b'",
        oo.Engage("e", "chaser/c", at=0),
    ),
    ([], "the system 'chaser' has no brakes", oo.Disengage("e", "chaser/c", at=0)),
    ([], "there is no system 'craft'", oo.Engage("e", "craft/c", at=0)),
    ([], "as in 'chaser/elbow_brake'", oo.Engage("e", "c", at=0)),
)


@pytest.mark.parametrize(("actuators", "message", "event"), BAD)
def test_wrong_brakes_are_refused(actuators: list[oo.Brake], message: str, event: Any) -> None:
    model = brakes.wheel()
    q, v = np.zeros(8), np.zeros(7)
    q[6], v[6] = 1.0, SPIN
    with pytest.raises(WorldError, match=message):
        chaser = oo.System("chaser", model, q, v, actuators=actuators)
        oo.World([chaser], events=[] if event is None else [event])


@pytest.mark.parametrize("torque", [-1.0, 0.0, np.nan])
def test_a_slip_torque_must_be_positive(torque: float) -> None:
    with pytest.raises(InputError, match="it must be positive"):
        oo.Brake("b", "spin", slip_torque=torque)


def test_an_external_engine_refuses_brakes() -> None:
    class Engine:
        def step(self, *arguments: Any) -> Any: ...

    q = np.zeros(8)
    q[6] = 1.0
    actuators = [oo.Brake("b", "spin")]
    with pytest.raises(EngineError, match="does not support a brake"):
        oo.Simulation(brakes.wheel(), q, np.zeros(7), actuators=actuators, engine=Engine())
