"""Ctrl-C interrupts every long call; a call that fails at the same time keeps its own error."""

from __future__ import annotations

import ctypes
import operator
import os
import signal
import threading
import time
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo

POSIX = pytest.mark.skipif(os.name != "posix", reason="os.kill sends SIGINT only on POSIX")
DEEP_SPACE = (
    "1 11801U          80230.29629788  .01431103  00000-0  14311-1 0    13",
    "2 11801  46.7916 230.4354 7318036  47.4722  10.4117  2.28537848    13",
)
Call = Callable[[], Any]

HEARD_WITHIN_S = 5.0
"""Wall-clock limit on a busy machine; Ctrl-C once had an effect only at the end, after 45 s."""


def numerical(degree: int = 70, t0: float = 0.0) -> oo.Numerical:
    field = oo.GravityField("egm2008", degree=degree, order=0)
    return oo.Numerical([7e6, 0, 0], [0, 5400.0, 5400.0], t0=t0, environment=[field])


def long_propagation() -> Call:
    return partial(oo.propagate, [numerical() for _ in range(3)], [2e8])


def long_orbit() -> Call:
    return partial(numerical().state, 2e8)


def long_backwards() -> Call:
    return partial(numerical().state, np.array([-2e8, 0.0]))


def long_frames() -> Call:
    return partial(numerical().lvlh, [0.0, 2e8])


def long_relative() -> Call:
    return partial(oo.relative.to_lvlh, numerical(), 2e8, np.ones(3), np.ones(3))


def long_field() -> Call:
    field = oo.GravityField("egm2008", degree=70)
    return partial(field.acceleration, np.tile([7e6, 1e5, 2e5], (1_000_000, 1)))


def long_many_times() -> Call:
    orbits = [oo.Sgp4(*DEEP_SPACE) for _ in range(2)]
    return partial(oo.propagate, orbits, np.linspace(0.0, 1e5, 2_000_000), threads=2)


def long_start() -> Call:
    """Returns a call that integrates the reference orbit for years before the run begins."""
    body = oo.Model.rigid_body(1.0, np.eye(3))
    orbit = numerical(t0=-2e8)
    q, v = body.neutral(), np.zeros(body.nv)
    return partial(oo.Simulation(body, q, v, orbit=orbit, time_step=0.1).run, 1.0)


@POSIX
@pytest.mark.parametrize(
    "prepared",
    [
        long_propagation,
        long_orbit,
        long_backwards,
        long_frames,
        long_relative,
        long_field,
        long_many_times,
        long_start,
    ],
)
def test_ctrl_c_interrupts_long_calls(prepared: Callable[[], Call]) -> None:
    call = prepared()  # building the arguments with NumPy takes a while
    sent: list[float] = []

    def press() -> None:
        sent.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    timer = threading.Timer(0.2, press)
    timer.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            call()
        assert time.monotonic() - sent[0] < HEARD_WITHIN_S
    finally:
        timer.cancel()
        timer.join()


def test_an_interrupted_orbit_continues_with_the_same_bits() -> None:
    whole, parts = numerical(8), numerical(8)
    for t in np.linspace(0.0, 20_000.0, 40):
        parts.state(t)
    assert np.array_equal(whole.state(20_000.0), parts.state(20_000.0))


def with_ctrl_c_pending(call: Callable[[], Any], returned: list[Any] | None = None) -> None:
    """Makes a call while a Ctrl-C is pending that Python has not handled."""
    returned = [] if returned is None else returned
    returned.extend(map(operator.call, [ctypes.pythonapi.PyErr_SetInterrupt, call]))


def test_ctrl_c_interrupts_a_certificate_and_a_batch() -> None:
    """Each call takes at least twice the interval at which signals are checked."""
    model = oo.robots.load("humanoid_torso")
    v = np.full(model.nv, 0.01)
    trace = oo.Simulation(model, model.neutral(), v, time_step=1e-3, record_every=1).run(50.0)
    q = np.tile(model.neutral(), (400_000, 1))
    for call in (trace.certificate, partial(model.mass_matrix, q, threads=1)):
        returned: list[Any] = []
        with pytest.raises(KeyboardInterrupt):
            with_ctrl_c_pending(call, returned)
        assert len(returned) == 1, f"{call} came to its end"
    assert all(passed for *_, passed in trace.certificate())


def test_an_error_with_ctrl_c_pending_keeps_its_type() -> None:
    with pytest.raises(KeyboardInterrupt) as stop:
        with_ctrl_c_pending(partial(oo.Kepler, semi_major_axis=-7e6, true_anomaly=0.0))
    assert isinstance(stop.value.__context__, oo.exceptions.OrbitError)


def test_a_run_that_diverges_with_ctrl_c_pending_keeps_its_trace() -> None:
    model = oo.robots.load("humanoid_torso")
    simulation = oo.Simulation(model, model.neutral(), np.full(model.nv, 1e8), time_step=1.0)
    with pytest.raises(oo.exceptions.SimulationError):
        simulation.run(100.0)
    with pytest.raises(oo.exceptions.RunInterrupted) as stop:
        with_ctrl_c_pending(partial(simulation.run, 100.0))
    assert len(stop.value.trace.time) >= 1
    assert isinstance(stop.value.__context__, oo.exceptions.SimulationError)
