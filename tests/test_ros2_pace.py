"""Real time: waits, delays, garbage collection and priority."""

from __future__ import annotations

import gc
import os
import signal
import threading
import time

import numpy as np
import pytest
from ros2_runs import DOMAIN, Peer, needs_ros2, node_of, spinning
from stepper_runs import passive, scenario

needs_ros2()

from onorbit_rs.ros2.delays import Delays  # noqa: E402
from onorbit_rs.ros2.pace import RealTime  # noqa: E402
from onorbit_rs.ros2.participant import Participant  # noqa: E402
from onorbit_rs.ros2.scheduling import collected_in_slack, prioritized  # noqa: E402

TICK = 1e-3


class Machine:
    """A clock that advances by a microsecond whenever it is read, with sleeps that end too late."""

    def __init__(self, late: float) -> None:
        self.now, self.late = 100.0, late
        self.sleeps: list[float] = []

    def clock(self) -> float:
        self.now += 1e-6
        return self.now

    def sleep(self, seconds: float) -> None:
        self.sleeps.append(seconds)
        self.now += seconds + self.late


def paced(machine: Machine, is_calibrated: bool) -> dict[str, float]:
    """Returns the report of the delays of 100 ticks, s."""
    pace = RealTime(TICK, clock=machine.clock, sleep=machine.sleep)
    if is_calibrated:
        pace.calibrate()
    for k in range(100):
        pace.wait(k * TICK)
    return pace.report()


def test_a_wait_is_exact_although_sleeps_end_late() -> None:
    exact = paced(Machine(1.5e-4), is_calibrated=True)
    assert exact["late_max_s"] < 5e-6 and exact["missed"] == 0.0
    without = paced(Machine(1.5e-4), is_calibrated=False)
    assert without["late_median_s"] == pytest.approx(1.5e-4, rel=0.05), "negative control"


def test_the_processor_is_kept_busy_for_a_fraction_of_a_tick_at_most() -> None:
    for late, early in ((0.0, 0.0), (1e-4, 1.5e-4), (1.0, 3e-4)):
        pace = RealTime(TICK, clock=(machine := Machine(late)).clock, sleep=machine.sleep)
        pace.calibrate()
        assert pace.early == pytest.approx(early, abs=5e-6)
    machine = Machine(1.0)
    fast = RealTime(1e-4, clock=machine.clock, sleep=machine.sleep)
    fast.calibrate()
    assert fast.early == pytest.approx(3e-5)


def test_the_processor_is_not_kept_busy_after_a_missed_tick() -> None:
    """The scheduler of Linux delays a program more, the more processor time it has used."""
    machine = Machine(1.5e-4)
    pace = RealTime(TICK, clock=machine.clock, sleep=machine.sleep)
    pace.calibrate()
    pace.wait(0.0)
    machine.now += 2.5 * TICK
    late = []
    for k in range(1, 150):
        pace.wait(k * TICK)
        late.append(-pace.ahead(k * TICK))
    assert late[50] == pytest.approx(1.5e-4, rel=0.1), "the sleep alone"
    assert late[140] < 5e-6


def test_a_tick_is_missed_if_it_is_late_by_a_tick() -> None:
    machine = Machine(0.0)
    pace = RealTime(TICK, clock=machine.clock, sleep=machine.sleep)
    pace.wait(0.0)
    machine.now += 4.5 * TICK  # a pause of the machine: the ticks at 1, 2 and 3 ms are late by one or more
    for k in range(1, 10):
        pace.wait(k * TICK)
    assert pace.report()["missed"] == pytest.approx(0.3)
    assert pace.slipped == 0.0
    machine.now += 0.5
    pace.wait(10 * TICK)
    assert pace.slipped == pytest.approx(0.5, abs=0.01), "it does not catch up"


def test_a_long_wait_is_many_short_sleeps_and_a_short_wait_is_one() -> None:
    for tick, count in ((TICK, 1), (0.05, 1), (1.0, 21)):
        machine = Machine(1.5e-4)
        pace = RealTime(tick, clock=machine.clock, sleep=machine.sleep)
        pace.early = 2e-4
        pace.wait(0.0)
        machine.sleeps.clear()
        pace.wait(tick)
        assert abs(len(machine.sleeps) - count) <= (count > 1)
        assert max(machine.sleeps) <= 0.05
        assert -pace.ahead(tick) < 5e-6


def test_a_pause_neither_shortens_nor_lengthens_the_wait_for_a_tick() -> None:
    machine = Machine(0.0)
    pace = RealTime(10.0, clock=machine.clock, sleep=machine.sleep)
    pace.wait(0.0)
    machine.now += 3.0
    for _ in range(100):
        pace.idle(10.0, 0.5)
    assert pace.ahead(10.0) == pytest.approx(7.0, abs=1e-3)
    pace.idle(500.0, 0.5)  # after /step
    assert pace.ahead(500.0) == pytest.approx(10.0, abs=1e-3)
    machine.now += 60.0
    pace.idle(500.0, 0.5)
    assert pace.ahead(500.0) == pytest.approx(0.0, abs=1e-3)


@pytest.mark.skipif(os.name != "posix", reason="sends SIGINT")
def test_a_long_tick_ends_at_once_at_ctrl_c() -> None:
    with node_of(passive(time_step=60.0)) as node:
        threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
        begin = time.perf_counter()
        trace = node.spin(600.0)
        assert 0.3 <= time.perf_counter() - begin < 5.0
    assert trace.time[-1] == 60.0, "the state that is due at the end of the wait"


def test_a_pause_is_answered_in_a_long_tick() -> None:
    with Peer() as peer, node_of(passive(time_step=60.0)) as node:
        peer.hear("/events", "diagnostic_msgs/msg/DiagnosticArray")
        assert peer.publisher("/events")
        with spinning(node, 120.0):
            for is_paused, text in ((False, "running"), (True, "paused")):
                peer.say("/pause", "std_msgs/msg/Bool", {"data": is_paused})
                (answer,) = peer.take("/events", 1, seconds=10.0)
                assert answer["status"][0]["message"] == text
            peer.say("/step", "std_msgs/msg/Float64", {"data": 60.0})


def test_delays_are_counted_in_bounded_memory() -> None:
    late = Delays(1e-3)
    values = np.abs(np.random.default_rng(1).normal(scale=4e-4, size=20_000))
    for value in (0.0, *values, 5.0):
        late.add(value)
    assert (late.count, late.largest, late.missed) == (20_002, 5.0, int(np.sum(values > 1e-3)) + 1)
    for fraction in (0.5, 0.99):
        assert late.quantile(fraction) == pytest.approx(np.quantile(values, fraction), rel=0.02)
    assert late._counts.nbytes < 30_000


def test_garbage_is_collected_when_there_is_time() -> None:
    def litter(count: int) -> None:
        for _ in range(count):
            cycle: list[object] = []
            cycle.append(cycle)

    with collected_in_slack() as tidy:
        assert not gc.isenabled()
        litter(2000)
        tidy(1e-4)
        assert gc.get_count()[0] > 1000, "no time before the next tick"
        tidy(1e-3)
        assert gc.get_count()[0] < 700
        litter(100_000)
        tidy(-1.0)
        assert gc.get_count()[0] < 700, "the memory is bounded without slack"
    assert gc.isenabled()


def test_looking_for_subscribers_leaves_no_garbage() -> None:
    """Garbage at each tick causes collections, which pause a node for 30 ms."""
    kind = ("/joint_states", "sensor_msgs/msg/JointState")
    participant = Participant(DOMAIN)
    writer, reader = participant.writer(*kind), participant.reader(*kind)
    gc.collect()
    gc.disable()
    try:
        for _ in range(100):
            assert writer.subscribers() == 1
        assert gc.collect() < 10
        for _ in range(100):
            writer._entity.get_matched_subscriptions()
        assert gc.collect() >= 100, "negative control"
    finally:
        gc.enable()
    assert reader.take() == []
    participant.close()


def test_a_priority_that_is_not_permitted_is_a_warning(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise PermissionError(1, "Operation not permitted")

    monkeypatch.setattr(os, "sched_setscheduler", refuse, raising=False)
    with (
        pytest.warns(UserWarning, match=r"without real-time priority \(Operation not permitted\)") as found,
        node_of(scenario(), has_priority=True) as node,
    ):
        assert node.spin(0.01).time[-1] == 0.01
    assert len(found) == 1 and "'@users - rtprio 1'" in str(found[0].message)
    with node_of(scenario(), pace="fast", has_priority=True) as node:
        assert node.spin(0.01).time[-1] == 0.01, "real time only"


@pytest.mark.skipif(not hasattr(os, "sched_getscheduler"), reason="only Linux has SCHED_FIFO")
def test_the_priority_ends_with_the_block() -> None:
    before = os.sched_getscheduler(0)
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(1))
        os.sched_setscheduler(0, before, os.sched_param(0))
    except PermissionError:
        pytest.skip("this user does not have the permission for SCHED_FIFO")
    with prioritized(True) as has_priority:
        assert has_priority and os.sched_getscheduler(0) == os.SCHED_FIFO
    assert os.sched_getscheduler(0) == before
    with prioritized(False) as has_priority:
        assert not has_priority and os.sched_getscheduler(0) == before
