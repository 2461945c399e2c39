"""Captures and releases in chains, at control ticks, recorded rows and one instant, and by latches."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.tools.validation import capture, worlds
from onorbit_rs.tools.validation.capture import arm_and_target, momentum, random_pair, run, straight
from onorbit_rs.tools.validation.gauss import Craft, impact, mass_matrix, project, relative_twist
from onorbit_rs.tools.validation.trees import Array

INTEGRATORS = ("rk4", "dormand_prince", "semi_implicit_euler")


def carried() -> tuple[list[Craft], list[oo.System]]:
    """Returns four slow random robots."""
    crafts = [worlds.slow(6000 + i) for i in range(4)]
    return crafts, [worlds.system(name, craft) for name, craft in zip("abcd", crafts, strict=True)]


def frame(crafts: Sequence[Craft], name: str) -> str:
    return f"{name}/{crafts['abcd'.index(name)].frame}"


PAIRS = {"ab": (0, 1), "cb": (2, 1), "dc": (3, 2)}


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("order", list(itertools.permutations(PAIRS)), ids="-".join)
def test_chains_of_captures_are_released_in_any_order(order: tuple[str, ...], integrator: str) -> None:
    crafts, systems = carried()
    events: list[Any] = [
        oo.Capture(name, frame(crafts, name[0]), frame(crafts, name[1]), at=0.05 * (i + 1))
        for i, name in enumerate(PAIRS)
    ]
    impulse = np.array([0.3, -0.1, 0.2, 0.02, 0.01, -0.03])
    events += [
        oo.Release(f"free_{name}", name, at=0.2 + 0.05 * i, impulse=impulse) for i, name in enumerate(order)
    ]
    trace = run(systems, events, 0.4, integrator=integrator, time_step=5e-3)
    assert [event.name for event in trace.events] == [*PAIRS, *(f"free_{name}" for name in order)]
    active: list[str] = []
    for event in trace.events:
        rows = np.flatnonzero(trace.time == event.time)
        before, after = (worlds.at_row(trace, crafts, int(row)) for row in (rows[0], rows[-1]))
        for old, new in zip(before, after, strict=True):  # nothing moves
            assert np.abs(old.model.difference(old.q, new.q)).max() < 2e-14
        expected, mass = worlds.joined(before), mass_matrix(before)
        if event.kind == "capture":
            active.append(event.name)
            extra = np.zeros(len(expected))
        else:
            name = event.name.removeprefix("free_")
            active.remove(name)
            # an impulse on the captured frame, the opposite one on the capturing frame
            pose = before[PAIRS[name][0]].pose
            wrench = np.concatenate([pose[:3, :3] @ impulse[:3], pose[:3, :3] @ impulse[3:]])
            extra = np.linalg.solve(mass, relative_twist(before, *PAIRS[name]).T @ wrench)
        expected = expected + extra
        if active:
            lines = np.vstack([relative_twist(before, *PAIRS[name]) for name in active])
            expected, _ = project(mass, lines, expected)
        found = worlds.joined(after)
        assert np.abs(found - expected).max() < 1e-12 * np.abs(expected).max(), event
        assert worlds.change(before, after) < 1e-14
        assert event.momentum_error.max() < 1e-14


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_capture_and_its_release_at_the_same_instant(integrator: str) -> None:
    first, second = random_pair(3000)
    systems = [
        oo.System("a", first.model, first.q, first.v),
        oo.System("b", second.model, second.q, second.v),
    ]
    grasp = oo.Capture("grasp", f"a/{first.frame}", f"b/{second.frame}", at=0.0)
    let_go = oo.Release("let_go", "grasp", after="grasp")
    trace = run(systems, [grasp, let_go], 0.01, integrator=integrator)
    assert [event.time for event in trace.events] == [0.0, 0.0]
    row = np.flatnonzero(trace.time == 0.0)[-1]
    after = np.concatenate([trace[name].v[row] for name in "ab"])
    expected = np.concatenate(impact(first, second).v)
    assert np.abs(after - expected).max() < 1e-12 * np.abs(expected).max()
    for name, craft in (("a", first), ("b", second)):  # then each moves alone
        alone = oo.Simulation(craft.model, trace[name].q[row], trace[name].v[row], integrator=integrator)
        end = alone.run(0.01)
        assert np.abs(end.v[-1] - trace[name].v[-1]).max() < 1e-12 * np.abs(end.v).max()


class Clock:
    """A controller that stores when it is called and what it sees."""

    def __init__(self, count: int) -> None:
        self.count = count
        self.calls: list[tuple[float, Array]] = []

    def update(self, t: float, state: Any) -> Array:
        self.calls.append((t, np.array(state.v)))
        return np.full(self.count, 0.01 * np.cos(t))


def ticking(
    integrator: str, record_every: int, period: float | None, events: Sequence[oo.Capture | oo.Release]
) -> tuple[oo.WorldTrace, Clock, Craft, Craft]:
    """Returns a run in which a controlled arm captures and releases a robot."""
    first, second = arm_and_target(straight(4), [0.3, 0.2, -0.3, 0.1])
    clock = Clock(4)
    systems = [
        oo.System("a", first.model, first.q, first.v, controller=clock, control_period=period),
        oo.System("b", second.model, second.q, 0.1 * second.v),
    ]
    trace = run(systems, events, 1.0, integrator=integrator, time_step=0.01, record_every=record_every)
    return trace, clock, first, second


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("record_every", [1, 7, 10])
@pytest.mark.parametrize("period", [None, 0.05, 0.1])
@pytest.mark.parametrize("times", [(0.3, 0.6), (0.3, 0.655), (0.123456, 0.7), (0.0, 1.0)])
def test_events_at_control_ticks_and_recorded_rows(
    integrator: str, record_every: int, period: float | None, times: tuple[float, float]
) -> None:
    target = arm_and_target(straight(4), 0.0)[1].frame
    events = [
        oo.Capture("grasp", "a/tip", f"b/{target}", at=times[0]),
        oo.Release("let_go", "grasp", at=times[1], impulse=[0.1, 0, 0, 0, 0, 0]),
    ]
    trace, clock, first, second = ticking(integrator, record_every, period, events)
    assert [event.time for event in trace.events] == pytest.approx(list(times), abs=1e-15)
    assert trace.time[0] == 0.0 and trace.time[-1] == 1.0
    assert np.all(np.diff(trace.time) >= 0.0)
    for event in trace.events:
        rows = np.flatnonzero(trace.time == event.time)
        assert len(rows) == 2, trace.time  # one before the event, one after it
        before, after = (worlds.at_row(trace, (first, second), int(row)) for row in rows)
        assert worlds.change(before, after) < 1e-14
        assert event.momentum_error.max() < 1e-14
        if event.kind == "capture":
            expected = np.concatenate(impact(*before).v)
            assert np.abs(worlds.joined(after) - expected).max() < 1e-12
    assert np.abs(trace.momentum[:, :3] - trace.momentum[0, :3]).max() < 1e-13
    if period is not None:
        # every tick once, at its time, and after the event of the same instant
        ticks = [t for t, _ in clock.calls]
        assert np.allclose(ticks, np.arange(len(ticks)) * period, atol=1e-12, rtol=0.0), ticks
        for t, v in clock.calls:
            rows = np.flatnonzero(np.abs(trace.time - t) < 1e-12)
            if len(rows) == 2 and t < 1.0:
                assert np.array_equal(v, trace["a"].v[rows[-1]])


def test_sparse_recording_has_the_bits_of_dense_recording() -> None:
    events = [
        oo.Capture("grasp", "a/tip", f"b/{arm_and_target(straight(4), 0.0)[1].frame}", at=0.123456),
        oo.Release("let_go", "grasp", at=0.6),
    ]
    for integrator in ("rk4", "semi_implicit_euler"):
        dense, sparse = (ticking(integrator, every, 0.1, events)[0] for every in (1, 10))
        for name in "ab":
            assert np.array_equal(dense[name].q[-1], sparse[name].q[-1])
            assert np.array_equal(dense[name].v[-1], sparse[name].v[-1])


def two_boxes(gap: float, v: Sequence[float]) -> list[oo.System]:
    return [
        capture.rigid("a", 40.0, [3, 4, 5], [0, 0, 0], np.zeros(6)),
        capture.rigid("b", 20.0, [1, 2, 2], [gap, 0, 0], v),
    ]


@pytest.mark.parametrize("integrator", ["rk4", "semi_implicit_euler"])
@pytest.mark.parametrize("step", [0.01, 0.07, 0.5])
def test_a_latch_that_is_crossed_within_a_step_closes_after_its_time(integrator: str, step: float) -> None:
    """The box is within 0.1 m of the other for 0.2 s."""
    systems = two_boxes(1.0, [-1.0, 0, 0, 0, 0, 0])
    settings = {"integrator": integrator, "time_step": step}
    closes = oo.Capture("grasp", "a/base", "b/base", within=[0.1, 0.1], held_for=0.15)
    (event,) = run(systems, [closes], 3.0, **settings).events
    assert event.time == pytest.approx(0.9 + 0.15, abs=1e-11)
    leaves = oo.Capture("grasp", "a/base", "b/base", within=[0.1, 0.1], held_for=0.25)
    assert not run(systems, [leaves], 3.0, **settings).events


def test_a_latch_within_its_envelope_at_the_start_closes_after_its_time() -> None:
    systems = two_boxes(0.05, [0.0, 0.01, 0, 0, 0, 0])
    for held in (0.0, 0.2):
        event = oo.Capture("grasp", "a/base", "b/base", within=[0.1, 0.1], held_for=held)
        (record,) = run(systems, [event], 1.0, time_step=0.03).events
        assert record.time == held


@pytest.mark.parametrize(("speed", "closes"), [(0.03, True), (0.0, False)])
def test_a_latch_measures_the_velocity_in_the_frame_that_captures(speed: float, closes: bool) -> None:
    """Two frames 0.3 m apart turn at 0.1 rad/s: they turn together if the second one moves at 3 cm/s."""
    systems = [
        capture.rigid("a", 40.0, [3, 4, 5], [0, 0, 0], [0, 0, 0, 0, 0, 0.1]),
        capture.rigid("b", 20.0, [1, 2, 2], [0.3, 0, 0], [0, speed, 0, 0, 0, 0.1]),
    ]
    event = oo.Capture("grasp", "a/base", "b/base", within=[0.5, 0.1], slower_than=[1e-3, 1e-3])
    records = run(systems, [event], 0.05, time_step=0.01).events
    assert [record.time for record in records] == ([0.0] if closes else [])
    assert all(record.energy_lost < 1e-15 for record in records)


def test_events_at_and_after_the_end_of_a_run() -> None:
    systems = two_boxes(1.0, [-0.1, 0, 0, 0, 0, 0])
    for time, count in ((0.5, 1), (0.5000001, 0)):
        event = oo.Capture("grasp", "a/base", "b/base", at=time)
        trace = run(systems, [event], 0.5, time_step=0.01)
        assert len(trace.events) == count
        speed = trace["b"].v[-1, 0]
        assert speed == pytest.approx(-0.1 / 3.0 if count else -0.1, abs=1e-16)


def test_the_release_of_a_craft_that_carries_others_takes_them_along() -> None:
    crafts, systems = carried()
    captures = [
        oo.Capture(name, frame(crafts, name[0]), frame(crafts, name[1]), at=0.0) for name in ("bc", "ab")
    ]
    release = oo.Release("free", "ab", at=0.1, impulse=[1.0, 0, 0, 0, 0, 0])
    trace = run(systems, [*captures, release], 0.3, time_step=5e-3)
    late = trace["b"].time > 0.1
    poses = [
        np.linalg.inv(crafts[1].model.frame_pose(trace["b"].q[late], crafts[1].frame))
        @ crafts[2].model.frame_pose(trace["c"].q[late], crafts[2].frame)
    ]
    assert np.ptp(poses[0], axis=0).max() < 1e-13
    record = trace.events[-1]
    assert np.linalg.norm(record.impulse[:3]) == pytest.approx(1.0, abs=1e-12)
    # the work of the spring, computed at its frames, is the change of the kinetic energy; an audit that
    # compared the change with itself would give zero
    error = next(value for name, value, *_ in trace.certificate() if name == "free/energy_error_rel")
    assert 0.0 < error < 1e-14
    assert record.energy_lost < 0.0
    total = sum((momentum(craft, craft.v, np.zeros(3))[0] for craft in crafts), np.zeros(6))
    end = worlds.at_row(trace, crafts, -1)
    found = sum((momentum(craft, craft.v, np.zeros(3))[0] for craft in end), np.zeros(6))
    assert np.abs(found - total).max() < 1e-11 * np.abs(total).max()


def test_captures_at_one_instant_give_the_same_velocity_in_any_order() -> None:
    crafts, systems = carried()
    found = []
    for order in itertools.permutations(PAIRS):
        events = [oo.Capture(n, frame(crafts, n[0]), frame(crafts, n[1]), at=0.0) for n in order]
        trace = run(systems, events, 0.01, time_step=5e-3)
        assert [event.name for event in trace.events] == list(order)
        row = int(np.flatnonzero(trace.time == 0.0)[-1])
        found.append(worlds.joined(worlds.at_row(trace, crafts, row)))
        assert max(event.momentum_error.max() for event in trace.events) < 1e-14
    rows = np.vstack([relative_twist(crafts, *pair) for pair in PAIRS.values()])
    expected, _ = project(mass_matrix(crafts), rows, worlds.joined(crafts))
    assert np.abs(np.array(found) - expected).max() < 1e-12 * np.abs(expected).max()
    # control: without one of the captures
    expected, _ = project(mass_matrix(crafts), rows[:12], worlds.joined(crafts))
    assert np.abs(np.array(found) - expected).max() > 1e-3


def test_a_release_before_the_capture_has_no_effect() -> None:
    systems = two_boxes(1.0, [-0.1, 0, 0, 0, 0, 0])
    events = [oo.Capture("grasp", "a/base", "b/base", at=0.2), oo.Release("let_go", "grasp", at=0.1)]
    trace = run(systems, events, 0.5, time_step=0.01)
    assert [event.name for event in trace.events] == ["grasp"]
    assert trace["a"].v[-1, 0] == pytest.approx(-0.1 / 3.0, abs=1e-16)
    assert trace["b"].v[-1, 0] == pytest.approx(-0.1 / 3.0, abs=1e-16)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_second_capture_of_a_rigid_body_changes_nothing(integrator: str) -> None:
    systems = two_boxes(1.0, [-0.1, 0, 0, 0, 0, 0])
    events: list[oo.Capture | oo.Release] = [
        oo.Capture("grasp", "a/base", "b/base", at=0.1),
        oo.Capture("again", "b/base", "a/base", at=0.2),
        oo.Release("let_go", "grasp", on_command=True),
    ]
    trace = run(systems, events, 0.5, integrator=integrator, time_step=0.01)
    assert [event.name for event in trace.events] == ["grasp", "again"]
    assert trace["b"].v[-1, 0] == pytest.approx(-0.1 / 3.0, abs=1e-16)
    assert np.abs(trace.events[1].impulse).max() < 1e-16 and abs(trace.events[1].energy_lost) < 1e-17
    events[1:] = [oo.Capture("again", "b/base", "a/base", at=0.4), oo.Release("let_go", "grasp", at=0.3)]
    trace = run(systems, events, 0.5, integrator=integrator, time_step=0.01)
    assert [event.name for event in trace.events] == ["grasp", "let_go", "again"]


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_run_in_pieces_with_resuming_between_chained_captures_has_the_same_bits(integrator: str) -> None:
    crafts, systems = carried()
    events: list[Any] = [
        oo.Capture(n, frame(crafts, n[0]), frame(crafts, n[1]), at=0.05 * (i + 1))
        for i, n in enumerate(PAIRS)
    ]
    events += [oo.Release(f"free_{n}", n, at=0.25 + 0.05 * i) for i, n in enumerate(PAIRS)]
    world = oo.World(systems, events=events)

    def simulation() -> oo.Simulation:
        return oo.Simulation(world, integrator=integrator, time_step=7e-3, record_every=3)

    whole: Any = simulation().run(0.5)
    checkpoint = None
    for stop in (0.05, 0.1003, 0.15, 0.26, 0.3, 0.35, 0.5):
        stepper = simulation().start(resume=checkpoint) if checkpoint else simulation().start(duration=0.5)
        stepper.advance_to(stop)
        checkpoint = stepper.checkpoint()
    pieces: Any = stepper.finish()
    for name, column in itertools.product("abcd", whole["a"].columns()):
        assert getattr(pieces[name], column).tobytes() == getattr(whole[name], column).tobytes(), (
            name,
            column,
        )
    records = [[event.energy_lost for event in trace.events] for trace in (whole, pieces)]
    assert records[0] == records[1] and len(records[0]) == 6


@pytest.mark.parametrize("friction", [0.0, 0.05])
@pytest.mark.parametrize("time", [0.5, 0.501, 0.77])
def test_pieces_that_end_near_an_event_have_the_bits_of_one_run(time: float, friction: float):
    """A trial step past the event leaves the torques that were held before it."""

    def simulation() -> Any:
        builder = oo.ModelBuilder("target", base="bus", mass=200, inertia=np.diag([40.0, 60, 50]))
        builder.add_link(
            "panel", parent="bus", joint="hinge", axis=[0, 1, 0], xyz=[0, 0.8, 0],
            mass=20, com=[0.2, 0.5, 0], inertia=np.diag([4.0, 1, 5]), friction=friction,
        )  # fmt: skip
        target, craft = builder.build(), oo.Model.rigid_body(50.0, np.diag([5.0, 6, 7]))
        q = target.neutral()
        q[0] = 2
        path = oo.JointWaypoints([[0.0], [0.2]], times=[0, 3])
        control = oo.Control(oo.JointComputedTorque(kp=5.0, kd=3.0), reference=path, name="turn")
        pid = oo.Control(oo.JointPid(p=1.0, i=0.5, d=2.0), reference=path, name="pid", after="g")
        systems = [
            oo.System("a", craft, craft.neutral(), [0.05, 0, 0, 0.01, 0.02, 0]),
            oo.System("t", target, q, [0, 0, 0, 0.02, 0.03, 0.05, 0], controller=[control, pid]),
        ]
        events = [
            oo.Capture("g", "a/base", "t/panel", at=0.5),
            oo.Release("r", "g", at=0.7696, impulse=[1, 0, 0, 0, 0.1, 0]),
        ]
        return oo.Simulation(oo.World(systems, events=events), time_step=4e-3)

    whole, stepper = simulation().run(1.0), simulation().start(duration=1.0)
    stepper.advance_to(time)
    assert stepper["t"].q.shape == (8,)
    resumed = simulation().start(resume=stepper.checkpoint())
    for advanced in (stepper, resumed):
        advanced.advance_to(1.0)
        for name in ("a", "t"):
            got, expected = advanced.trace()[name], whole[name]
            rows = len(expected.time) - len(got.time)
            for column in ("q", "v", "tau", "acceleration", "work"):
                np.testing.assert_array_equal(getattr(got, column), getattr(expected, column)[rows:])


def test_a_capture_that_closes_a_loop_cannot_seat_its_frames():
    systems = two_boxes(1.0, [-0.1, 0, 0, 0, 0, 0])
    seat = {"seat": 0.2, "pose": np.eye(4)}
    events = [
        oo.Capture("g", "a/base", "b/base", at=0.1),
        oo.Capture("h", "a/base", "b/base", at=0.2, **seat),
    ]
    with pytest.raises(oo.OnOrbitError, match=r"at t = 0.2 s the event 'h' connects 'a' and 'b', .* 'seat'"):
        run(systems, events, 0.5, time_step=0.01)


def test_twenty_systems_are_captured_one_after_another():
    """Each servicer captures the next one, until all twenty are one tree."""
    servicer = oo.robots.load("servicer")
    systems = []
    for number in range(20):
        q = servicer.neutral()
        q[0] = 10.0 * number
        systems.append(oo.System(f"s{number}", servicer, q, np.zeros(servicer.nv)))
    events = [oo.Capture(f"g{i}", f"s{i}/tool", f"s{i + 1}/tool", at=0.1 * (i + 1)) for i in range(19)]
    trace = oo.Simulation(oo.World(systems, events=events), time_step=1e-2).run(2.5)
    assert len(trace.events) == 19
    assert all(passed for *_, passed in trace.certificate())
