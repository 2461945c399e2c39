"""Many simulations on threads: the bits of each alone, bounded look-ahead, errors."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator

import numpy as np
import pytest
from contact_worlds import pair
from two_arms import hold

import onorbit_rs as oo
from onorbit_rs import exceptions

INERTIA = np.diag([120.0, 90.0, 150.0])
CRAFT = oo.ModelBuilder("craft", base="hub", mass=500.0, inertia=INERTIA).build()
DURATION = 0.5


def capture(seed: int) -> oo.Simulation:
    """Returns a world in which one craft captures another that tumbles."""
    q, v = CRAFT.neutral(), np.zeros(6)
    servicer = oo.System("servicer", CRAFT, q, v)
    q[0] = 2.5
    v[3:] = np.random.default_rng(seed).normal(0.0, 0.02, 3)
    grasp = oo.Capture("grasp", "servicer/hub", "target/hub", at=0.2)
    world = oo.World([servicer, oo.System("target", CRAFT, q, v)], events=[grasp])
    return oo.Simulation(world, time_step=0.01, record_every=50)


def touch(seed: int) -> oo.Simulation:
    """Returns two spheres that collide at a speed that depends on the seed."""
    return oo.Simulation(pair(speed=0.1 + 0.01 * seed), time_step=2e-3)


def closed_loop(seed: int) -> oo.Simulation:
    """Returns a servicer that holds a module with one hand, and closes a loop with the other one later.

    The left hand releases the module after that.
    """
    world, _ = hold(load=None, events=second_grasp(seed))
    return oo.Simulation(world, time_step=0.01, record_every=10)


def second_grasp(seed: int) -> list[oo.Capture | oo.Release]:
    hands = [(f"servicer/{side}_tool", f"module/{side}_handle") for side in ("left", "right")]
    return [
        oo.Capture("left", *hands[0], at=0.0),
        oo.Capture("right", *hands[1], at=0.1 + 0.02 * seed),
        oo.Release("open", "left", after="right", delay=0.2),
    ]


def bits(trace: oo.Trace) -> list[bytes]:
    assert isinstance(trace, oo.WorldTrace)
    return [trace[name].v.tobytes() + trace[name].q.tobytes() for name in trace.names]


@pytest.mark.parametrize("case", [capture, touch, closed_loop])
def test_every_run_has_the_bits_of_a_run_alone_for_any_number_of_threads(case: object) -> None:
    assert callable(case)
    alone = [bits(case(seed).run(DURATION)) for seed in range(6)]
    for threads in (1, 2, 3, None):
        traces = oo.run_batch((case(seed) for seed in range(6)), DURATION, threads=threads)
        assert [bits(trace) for trace in traces] == alone
    assert alone[0] != alone[1]  # control: the runs differ


def test_callables_build_the_simulations_on_the_threads() -> None:
    alone = [bits(capture(seed).run(DURATION)) for seed in range(3)]
    built: list[str] = []

    def case(seed: int) -> oo.Simulation:
        built.append(threading.current_thread().name)
        return capture(seed)

    traces = oo.run_batch([lambda seed=seed: case(seed) for seed in range(3)], DURATION, threads=2)
    assert [bits(trace) for trace in traces] == alone
    assert all(name.startswith("onorbit-run") for name in built)


def test_simulations_are_taken_from_a_generator_as_their_results_are_used() -> None:
    taken = []

    def endless() -> Iterator[oo.Simulation]:
        for seed in range(10**9):
            taken.append(seed)
            yield capture(seed)

    traces = oo.run_batch(endless(), DURATION, threads=2)
    assert not taken
    for number, _ in zip(range(5), traces, strict=False):
        assert len(taken) <= number + 5
    traces.close()  # type: ignore[attr-defined]
    assert len(taken) < 12


def test_an_error_names_its_run_and_ends_the_others() -> None:
    def cases() -> Iterator[oo.Simulation]:
        yield capture(0)
        yield oo.Simulation(pair(gap=-0.05), time_step=2e-3)  # overlapping
        for seed in range(100):
            yield capture(seed)

    traces = oo.run_batch(cases(), 1e4, threads=2)
    next(traces)
    began = time.monotonic()
    with pytest.raises(exceptions.OnOrbitError) as found:
        next(traces)
    assert found.value.__notes__ == ["in the run of simulation 1, counted from 0"]
    assert time.monotonic() - began < 20.0
    with pytest.raises(StopIteration):
        next(traces)


@pytest.mark.parametrize(
    ("threads", "error", "message"),
    [
        (0, exceptions.InputError, "threads is 0; it must be at least 1"),
        (-2, exceptions.InputError, "threads is -2"),
        (1.5, exceptions.DtypeError, "threads is 1.5; it must be a positive integer"),
        (True, exceptions.DtypeError, "threads is True"),
    ],
)
def test_bad_numbers_of_threads(threads: object, error: type[Exception], message: str) -> None:
    with pytest.raises(error, match=message):
        oo.run_batch([], 1.0, threads=threads)  # type: ignore[arg-type]


def test_a_duration_that_is_invalid_is_the_error_of_the_first_run() -> None:
    with pytest.raises(exceptions.InputError, match="duration"):
        next(oo.run_batch([capture(0)], -1.0))
    assert list(oo.run_batch([], 1.0)) == []
