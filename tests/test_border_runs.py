"""Runs through Python: Python controllers, Ctrl-C, divergence, and views of the trace."""

from __future__ import annotations

import gc
import signal
import subprocess
import sys
import textwrap
import threading
import time
import weakref
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.exceptions import ControlError, DtypeError, RunInterrupted, ShapeError, SimulationError

MODEL = oo.robots.load("humanoid_torso")
Q, V = MODEL.neutral(), np.zeros(MODEL.nv)
JOINTS = 7


class Calls(oo.Controller):
    """A controller that calls a given function at every update."""

    def __init__(self, answer: Callable[[float, Any], Any]) -> None:
        self.answer = answer
        self.times: list[float] = []
        self.resets = 0

    def reset(self) -> None:
        self.resets += 1

    def update(self, t: float, state: Any) -> Any:
        self.times.append(t)
        return self.answer(t, state)


def run(answer: Callable[[float, Any], Any], duration: float = 0.1, **known: Any) -> oo.Trace:
    return oo.Simulation(MODEL, Q, V, controller=Calls(answer), **known).run(duration)


# A controller in Python


def test_torques_of_a_python_controller_are_held_and_recorded() -> None:
    trace = run(lambda t, state: np.full(JOINTS, t), duration=0.01)
    assert trace.is_complete
    np.testing.assert_array_equal(trace.tau, np.repeat(trace.time[:, None], JOINTS, axis=1))
    np.testing.assert_array_equal(trace.time, np.arange(11) * 1e-3)


def test_lists_and_integers_are_torques_too() -> None:
    np.testing.assert_array_equal(run(lambda t, state: [1, 0, 0, 0, 0, 0, 0]).tau[:, 0], 1.0)


def test_a_controller_runs_at_its_rate_and_is_reset_for_every_run() -> None:
    controller = Calls(lambda t, state: np.zeros(JOINTS))
    simulation = oo.Simulation(MODEL, Q, V, controller=controller, control_period=0.005)
    first, second = simulation.run(0.02), simulation.run(0.02)
    assert controller.resets == 2
    once = [0.0, 0.005, 0.01, 0.015, 0.02]  # the last for the last row
    np.testing.assert_allclose(controller.times, once + once, atol=1e-15)
    np.testing.assert_array_equal(first.q, second.q)


def test_a_controller_may_keep_and_modify_its_state_arrays() -> None:
    kept: list[Any] = []

    def answer(t: float, state: Any) -> Any:
        kept.append((state.q.copy(), state.q))
        state.v[:] = 1e9
        return np.full(JOINTS, 0.1)

    trace = run(answer, duration=0.01)
    quiet = run(lambda t, state: np.full(JOINTS, 0.1), duration=0.01)
    np.testing.assert_array_equal(trace.v, quiet.v)
    for k, (copy, array) in enumerate(kept):
        np.testing.assert_array_equal(copy, array)
        np.testing.assert_array_equal(array, trace.q[k])


def test_the_state_contains_the_reference() -> None:
    seen: list[Any] = []
    pose = MODEL.frame_pose(Q, "tool")
    line = oo.LineParabola(pose, displacement=[0.5, 0, 0], duration=1.0)
    run(lambda t, state: seen.append(state) or np.zeros(JOINTS), reference=line, tool="tool")  # type: ignore[func-returns-value]
    np.testing.assert_allclose(seen[0].reference_pose, pose, atol=1e-15)
    assert seen[50].reference_velocity[0] > 0 and seen[50].reference_acceleration.shape == (6,)
    run(lambda t, state: seen.append(state) or np.zeros(JOINTS))  # type: ignore[func-returns-value]
    assert seen[-1].reference_pose is None


@pytest.mark.parametrize("where", ["update", "reset", "progress"])
@pytest.mark.parametrize(
    "raised", [ValueError("mine"), SystemExit(3), StopIteration(), oo.OnOrbitError("ours")]
)
def test_an_exception_is_re_raised_unchanged(where: str, raised: BaseException) -> None:
    def fail(*_: Any) -> Any:
        raise raised

    class Failing(oo.Controller):
        def reset(self) -> None:
            if where == "reset":
                fail()

        def update(self, t: float, state: Any) -> Any:
            return fail() if where == "update" and t > 0.01 else np.zeros(JOINTS)

    simulation = oo.Simulation(MODEL, Q, V, controller=Failing())
    with pytest.raises(type(raised)) as caught:
        simulation.run(1e4 if where == "progress" else 0.1, progress=fail if where == "progress" else None)
    assert caught.value is raised
    names = []
    frames = caught.value.__traceback__
    while frames is not None:
        names.append(frames.tb_frame.f_code.co_name)
        frames = frames.tb_next
    assert "fail" in names  # traceback included


def test_a_failed_run_leaves_the_simulation_usable() -> None:
    broken = True

    def answer(t: float, state: Any) -> Any:
        if broken:
            raise ValueError("mine")
        return np.zeros(JOINTS)

    simulation = oo.Simulation(MODEL, Q, V, controller=Calls(answer))
    with pytest.raises(ValueError, match="mine"):
        simulation.run(0.1)
    broken = False
    assert simulation.run(0.1).is_complete


@pytest.mark.parametrize("answer", [np.zeros(6), np.zeros((7, 1)), np.zeros((1, 7)), 0.0, []])
def test_torques_of_a_wrong_shape_are_rejected(answer: Any) -> None:
    with pytest.raises(ShapeError, match=r"update.*expected \(7,\)") as caught:
        run(lambda t, state: answer)
    assert caught.value.got == list(np.shape(answer)) or np.shape(answer) == ()


@pytest.mark.parametrize("answer", [None, "strong", np.zeros(7, complex), [None] * 7])
def test_torques_that_are_not_numbers_are_rejected(answer: Any) -> None:
    with pytest.raises(DtypeError, match="update"):
        run(lambda t, state: answer)


@pytest.mark.parametrize("value", [float("nan"), float("inf")])
def test_torques_that_are_not_finite_are_rejected(value: float) -> None:
    with pytest.raises(
        ControlError, match=r"returned (NaN|inf) for joint 'arm_joint_4' at t = 0.05"
    ) as caught:
        run(lambda t, state: np.where((np.arange(7) == 3) & (t > 0.0495), value, 0.0))
    assert isinstance(caught.value, ValueError)


def test_a_controller_without_update_is_rejected() -> None:
    """The error is raised at construction, not during a run."""
    nothing = type("Nothing", (oo.Controller,), {})
    with pytest.raises(TypeError, match=r"abstract class Nothing .*update"):
        nothing()


# Divergence


def test_a_diverging_run_names_time_and_state_and_keeps_the_trace() -> None:
    with pytest.raises(SimulationError, match=r"diverged at t = .*reduce time_step") as caught:
        run(lambda t, state: np.full(JOINTS, 1e200 if t > 0.0495 else 0.1), duration=1.0)
    error = caught.value
    assert isinstance(error, ArithmeticError) and isinstance(error, oo.OnOrbitError)
    assert 0.04 < error.time < 0.1
    assert np.isfinite(error.q).all() and np.isfinite(error.v).all()
    assert len(error.q) == MODEL.nq and len(error.v) == MODEL.nv
    trace = error.trace
    assert not trace.is_complete and len(trace) > 40
    for name in trace.columns():
        if name != "acceleration":  # the acceleration of the last row is not finite
            assert np.isfinite(getattr(trace, name)).all(), name
    np.testing.assert_array_equal(trace.q[-1], error.q)
    hide_rounding = run(lambda t, state: np.full(JOINTS, 0.1), duration=0.04)
    np.testing.assert_array_equal(trace.q[:41], hide_rounding.q)


# Ctrl-C


def interrupt_after(seconds: float) -> threading.Timer:
    timer = threading.Timer(seconds, signal.raise_signal, (signal.SIGINT,))
    timer.start()
    return timer


LONG = 1e6  # seconds of simulation, hours of computing


def check_interrupted(error: RunInterrupted, begun: float) -> None:
    assert time.perf_counter() - begun < 5.0
    assert isinstance(error, KeyboardInterrupt) and not isinstance(error, Exception)
    trace = error.trace
    assert not trace.is_complete and len(trace) > 1
    assert 0 < error.time < LONG and trace.time[-1] == pytest.approx(error.time, rel=1e-9)
    assert np.isfinite(trace.q).all()


def test_ctrl_c_stops_a_native_run_with_its_trace() -> None:
    simulation = oo.Simulation(MODEL, Q, V, time_step=1e-2, record_every=1000)
    timer, begun = interrupt_after(0.3), time.perf_counter()
    with pytest.raises(RunInterrupted, match="interrupted at t = ") as caught:
        simulation.run(LONG)
    timer.join()
    check_interrupted(caught.value, begun)


def test_ctrl_c_stops_a_run_inside_a_python_controller_with_its_trace() -> None:
    def slow(t: float, state: Any) -> Any:
        time.sleep(1e-3)  # the signal arrives here
        return np.zeros(JOINTS)

    simulation = oo.Simulation(MODEL, Q, V, controller=Calls(slow), time_step=1e-2, record_every=1000)
    timer, begun = interrupt_after(0.3), time.perf_counter()
    with pytest.raises(RunInterrupted) as caught:
        simulation.run(LONG)
    timer.join()
    error = caught.value
    assert time.perf_counter() - begun < 5.0
    assert error.trace is not None and not error.trace.is_complete and len(error.trace) >= 1


def test_ctrl_c_from_outside_ends_a_process_cleanly() -> None:
    program = textwrap.dedent("""
        import onorbit_rs as oo, numpy as np
        model = oo.robots.load("humanoid_torso")
        rest = np.zeros(model.nv)
        simulation = oo.Simulation(model, model.neutral(), rest, time_step=1e-2, record_every=1000)
        print("ready", flush=True)
        try:
            simulation.run(1e6)
        except KeyboardInterrupt as error:
            print(type(error).__name__, len(error.trace) > 1, flush=True)
    """)
    process = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True)
    try:
        assert process.stdout is not None and process.stdout.readline() == "ready\n"
        time.sleep(0.3)
        process.send_signal(signal.SIGINT)
        output, _ = process.communicate(timeout=20)
    finally:
        process.kill()
    assert output == "RunInterrupted True\n"
    assert process.returncode == 0


# The trace


@pytest.fixture(scope="module")
def trace() -> oo.Trace:
    law = oo.ComputedTorque(MODEL, "tool", null_space_damping=1.0)
    q = Q.copy()
    q[7:] = [0.5342, -2.341, -2.0077, -2.2249, -2.2693, -0.1342, -0.1974]
    orbit = oo.Kepler(semi_major_axis=6.778e6)
    reference = oo.LineParabola(
        MODEL.frame_pose(q, "tool"), displacement=[0.5, 0, 0], height=[0, 0, 0.4], duration=10
    )
    simulation = oo.Simulation(
        MODEL, q, V, orbit=orbit, environment=[oo.GravityGradient()], controller=law, reference=reference
    )
    return simulation.run(0.05)


SHAPES = {
    "time": (), "q": (14,), "v": (13,), "tau": (7,), "acceleration": (13,), "momentum": (6,), "impulse": (6,),
    "kinetic_energy": (), "work": (), "center_of_mass": (3,), "tool_pose": (4, 4), "reference_pose": (4, 4),
    "position_error": (3,), "attitude_error": (3,), "position_eci": (3,), "velocity_eci": (3,),
}  # fmt: skip


@pytest.mark.parametrize("name", SHAPES)
def test_columns_are_read_only_views_whose_base_is_the_trace(trace: oo.Trace, name: str) -> None:
    column = getattr(trace, name)
    assert column.shape == (51, *SHAPES[name]) and column.dtype == np.float64
    assert column.base is trace
    assert not column.flags.owndata and not column.flags.writeable and column.flags.c_contiguous
    assert np.shares_memory(column, getattr(trace, name))  # the second access returns the same array
    with pytest.raises(ValueError, match="read-only"):
        column[0] = 0.0
    with pytest.raises(ValueError, match="WRITEABLE"):
        column.flags.writeable = True
    assert name in trace.columns()


def test_columns_that_do_not_apply_are_none() -> None:
    trace = oo.Simulation(MODEL, Q, V).run(0.01)
    for name in (
        "tool_pose",
        "reference_pose",
        "position_error",
        "attitude_error",
        "position_eci",
        "velocity_eci",
    ):
        assert getattr(trace, name) is None
        assert name not in trace.columns()
    rigid = oo.Model.rigid_body(2.0, np.eye(3))
    assert oo.Simulation(rigid, rigid.neutral(), np.zeros(6)).run(0.01).tau.shape == (11, 0)


def test_a_view_outlives_its_trace() -> None:
    trace = oo.Simulation(MODEL, Q, V + 0.1).run(0.01)
    q, copy = trace.q, trace.q.copy()
    del trace
    gc.collect()
    junk = [
        np.random.default_rng(k).normal(size=1000) for k in range(200)
    ]  # reuses the memory if it was freed
    np.testing.assert_array_equal(q, copy)
    assert junk and q.base is not None


def test_a_python_controller_is_released_with_its_simulation() -> None:
    controller = Calls(lambda t, state: np.zeros(JOINTS))
    gone = weakref.ref(controller)
    simulation = oo.Simulation(MODEL, Q, V, controller=controller)
    simulation.run(0.01)
    del controller
    assert gone() is not None
    del simulation
    gc.collect()
    assert gone() is None


def test_rows_are_the_start_every_kth_step_and_the_end() -> None:
    trace = oo.Simulation(MODEL, Q, V + 0.1, record_every=4).run(0.01)
    np.testing.assert_allclose(trace.time, [0, 0.004, 0.008, 0.01], atol=1e-15)
    full = oo.Simulation(MODEL, Q, V + 0.1).run(0.01)
    np.testing.assert_array_equal(trace.q, full.q[[0, 4, 8, 10]])
    assert len(trace) == 4


def test_every_run_starts_from_the_given_state_and_gives_the_same_bits() -> None:
    simulation = oo.Simulation(MODEL, Q, V + 0.1)
    first, second = simulation.run(0.2), simulation.run(0.2)
    for name in first.columns():
        np.testing.assert_array_equal(getattr(first, name), getattr(second, name))
    np.testing.assert_array_equal(first.q[0], Q)


def test_progress_is_reported_at_a_steady_rate() -> None:
    seen: list[tuple[float, float]] = []
    begun = time.perf_counter()
    oo.Simulation(MODEL, Q, V, time_step=1e-3, record_every=10_000).run(
        60.0, progress=lambda t, duration: seen.append((t, duration))
    )
    wall = time.perf_counter() - begun
    assert len(seen) <= wall / 0.05 + 1  # 50 ms apart
    assert all(duration == 60.0 for _, duration in seen)
    assert [t for t, _ in seen] == sorted(t for t, _ in seen)
