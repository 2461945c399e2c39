"""External engines: their input, their output, and their errors."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.exceptions import EngineError, InputError, RunInterrupted, ShapeError, SimulationError

ORBIT = {"semi_major_axis": 6778e3, "eccentricity": 0.01, "inclination": 0.9}
PUSH = oo.BodyWrench("torso", force=[0.0, 0.3, 0.1], start=0.0125, end=0.031)
START = [0.5342, -2.341, -2.0077, -2.2249, -2.2693, -0.1342, -0.1974]


class Euler:
    """A minimal engine with the package's dynamics: a first-order method without state."""

    def __init__(self, model: oo.Model) -> None:
        self.model, self.seen = model, []  # type: ignore[var-annotated]

    def step(
        self, start: float, end: float, q: Any, v: Any, tau: Any, wrenches: Any
    ) -> tuple[Any, Any, Any, Any, float, float]:
        outer = wrenches(start, q, v)
        self.seen.append((start, end, q.copy(), v.copy(), tau.copy(), outer))
        h, force = end - start, np.concatenate([np.zeros(6), tau])
        for name, wrench in zip(self.model.body_names, outer, strict=True):
            jacobian = self.model.frame_jacobian(q, name)  # pose of the link's origin in W
            arm = self.com(q, name) - self.model.frame_pose(q, name)[:3, 3]
            moment = wrench[3:] + np.cross(arm, wrench[:3])
            force += jacobian.T @ np.concatenate([wrench[:3], moment])
        a = self.model.forward_dynamics(q, v, force)
        moved = self.model.integrate(q, h * v)
        impulse = h * np.concatenate([outer[:, :3].sum(axis=0), np.zeros(3)])
        return moved, v + h * a, a, impulse, float(h * force @ v), 0.0

    def com(self, q: Any, name: str) -> Any:
        body = next(body for body in self.model.bodies if body.name == name)
        return (self.model.frame_pose(q, name) @ [*body.com, 1.0])[:3]


def reach(engine: Any = None, **settings: Any) -> oo.Simulation:
    model = oo.robots.load("humanoid_torso")
    q = model.neutral()
    q[7:] = START
    return oo.Simulation(
        model, q, np.zeros(model.nv), orbit=oo.Kepler(**ORBIT), engine=engine,
        environment=[oo.GravityGradient(), PUSH],
        controller=oo.ComputedTorque(model, "tool", kp=100, kd=20, null_space_damping=2),
        reference=oo.LineParabola(model.frame_pose(q, "tool"), displacement=[0.2, 0, 0], duration=2.0),
        **({"time_step": 0.01, "record_wrenches": True} | settings),
    )  # fmt: skip


@pytest.fixture
def model() -> oo.Model:
    return oo.robots.load("humanoid_torso")


def test_the_engine_receives_the_recorded_states(model: oo.Model) -> None:
    engine = Euler(model)
    trace = reach(engine).run(0.1)
    assert len(engine.seen) == len(trace.time)  # the last call only computes the acceleration
    for k, (start, end, q, v, tau, outer) in enumerate(engine.seen):
        assert start == trace.time[k]
        assert end == trace.time[min(k + 1, len(trace.time) - 1)]
        for given, row in ((q, trace.q), (v, trace.v), (tau, trace.tau)):
            np.testing.assert_array_equal(given, row[k])
        recorded = sum(np.asarray(rows[k]) for rows in trace.wrenches.values())
        np.testing.assert_allclose(outer, recorded, rtol=0, atol=1e-13 * np.abs(recorded).max())
    # a switching time within a step splits the step
    assert {0.0125, 0.031} <= set(trace.time)
    pushed = [outer[0, 1] > 0.25 for *_, outer in engine.seen]
    assert pushed == [0.0125 <= t < 0.031 for t in trace.time]


def test_it_moves_the_robot_and_the_certificate_checks_it(model: oo.Model) -> None:
    def run(engine: Any, time_step: float) -> oo.Trace:
        return reach(engine, time_step=time_step, control_period=0.002).run(1.0)

    ours, crude, finer = run(None, 0.002), run(Euler(model), 0.002), run(Euler(model), 0.001)
    off = np.abs(model.difference(ours.q[-1], crude.q[-1])).max()
    off_finer = np.abs(model.difference(ours.q[-1], finer.q[-1])).max()
    assert 1e-6 < off < 1e-2
    assert 1.7 < off / off_finer < 2.3  # first order
    failed = {name for name, _, _, passed in crude.certificate() if not passed}
    assert {"linear_momentum_drift_rel", "energy_balance_error_rel"} <= failed
    assert all(passed for *_, passed in ours.certificate())


def test_its_exception_is_re_raised_with_the_partial_trace(model: oo.Model) -> None:
    class Tired(Euler):
        def step(self, start: float, *rest: Any) -> Any:
            if start > 0.045:
                raise LookupError("no more")
            return super().step(start, *rest)

    with pytest.raises(LookupError, match="no more") as caught:
        reach(Tired(model)).run(1.0)
    trace = caught.value.trace  # type: ignore[attr-defined]
    assert trace.time[-1] == pytest.approx(0.04)
    assert trace.acceleration.shape == trace.v.shape
    assert not trace.is_complete


def test_ctrl_c_within_it_is_an_interrupted_run(model: oo.Model) -> None:
    class Stopped(Euler):
        def step(self, start: float, *rest: Any) -> Any:
            if start > 0.045:
                raise KeyboardInterrupt
            return super().step(start, *rest)

    with pytest.raises(RunInterrupted) as caught:
        reach(Stopped(model)).run(1.0)
    assert caught.value.trace.time[-1] == pytest.approx(0.04)


def test_a_state_that_is_no_longer_finite_is_a_divergence(model: oo.Model) -> None:
    class Lost(Euler):
        def step(self, start: float, *rest: Any) -> Any:
            q, v, *others = super().step(start, *rest)
            return (q, v * np.nan if start > 0.045 else v, *others)

    with pytest.raises(SimulationError, match=r"diverged at t = 0\.05") as caught:
        reach(Lost(model)).run(1.0)
    assert np.isfinite(caught.value.q).all()
    assert caught.value.trace.time[-1] == pytest.approx(0.05)


@pytest.mark.parametrize(
    ("spoil", "error", "message"),
    [
        (
            lambda left: (left[0][:-1], *left[1:]),
            ShapeError,
            r"the q that the engine returned has shape \(13,\)",
        ),
        (lambda left: left[:4], ValueError, "6"),
        (lambda left: None, TypeError, "None"),
    ],
)
def test_an_object_without_step_is_rejected(model: oo.Model, spoil: Any, error: Any, message: str) -> None:
    class Wrong(Euler):
        def step(self, *given: Any) -> Any:
            return spoil(super().step(*given))

    with pytest.raises(error, match=message):
        reach(Wrong(model)).run(0.1)


def test_wrenches_are_rejected_for_invalid_states(model: oo.Model) -> None:
    class Wrong(Euler):
        def step(self, start: float, end: float, q: Any, v: Any, tau: Any, wrenches: Any) -> Any:
            return wrenches(start, q[:-1], v)

    with pytest.raises(ShapeError, match=r"q has shape \(13,\); expected \(14,\)"):
        reach(Wrong(model)).run(0.1)


def test_a_resumed_run_has_the_same_bits(model: oo.Model) -> None:
    kept: list[Any] = []

    def stop(t: float, _: float) -> None:
        if t > 0.6:
            raise KeyboardInterrupt

    whole = reach(Euler(model), time_step=0.0005).run(1.0)
    with pytest.raises(RunInterrupted):
        reach(Euler(model), time_step=0.0005).run(
            1.0, progress=stop, checkpoint=kept.append, checkpoint_every=0.0
        )
    columns = {name: np.concatenate([part.columns[name] for part in kept]) for name in kept[0].columns}
    halfway = oo.Checkpoint(kept[-1].state, columns)
    resumed = reach(Euler(model), time_step=0.0005).run(1.0, resume=halfway)
    for name in whole.columns():
        np.testing.assert_array_equal(getattr(whole, name), getattr(resumed, name))


class Spoilt(Euler):
    """The same engine with one invalid output."""

    def __init__(self, model: oo.Model, which: int, change: Any) -> None:
        super().__init__(model)
        self.which, self.change = which, change

    def step(self, *now: Any) -> Any:
        answer = list(super().step(*now))
        answer[self.which] = self.change(answer[self.which])
        return tuple(answer)


def test_an_invalid_quaternion_is_rejected(model: oo.Model) -> None:
    longer = Spoilt(model, 0, lambda q: np.concatenate([q[:3], 1.5 * q[3:7], q[7:]]))
    with pytest.raises(EngineError, match=r"norm 1\.5.*normalise"):
        reach(longer).run(0.05)


@pytest.mark.parametrize("which", range(6))
def test_non_finite_output_is_rejected(model: oo.Model, which: int) -> None:
    with pytest.raises(SimulationError, match="is not finite"):
        reach(Spoilt(model, which, lambda x: x * np.nan)).run(0.05)


def test_wrenches_are_available_during_a_step_only(model: oo.Model) -> None:
    class Lost(Euler):
        def step(self, start: float, end: float, q: Any, v: Any, tau: Any, wrenches: Any) -> Any:
            return wrenches(start, q * np.nan, v)

    with pytest.raises(InputError, match="q holds NaN"):
        reach(Lost(model)).run(0.05)


def test_an_engine_of_one_robot_is_refused_at_once_in_a_world(model: oo.Model) -> None:
    start = model.neutral(), np.zeros(model.nv)
    world = oo.World([oo.System(name, model, *start) for name in ("a", "b")])
    with pytest.raises(EngineError, match="a world of several systems needs a method step_world"):
        oo.Simulation(world, engine=Euler(model))
