"""Commands and wrenches from outside on free and captured systems."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.common.coordinates import JOINTS_Q

GRASPED = np.array([0, 1.4260, 0, 1.3391, 0, -1.1943, 0])


def world(controller: Any, knows: list[str], effects: list[Any] | None = None) -> oo.World:
    """Returns a servicer that captures a satellite at 0.1 s."""
    servicer, target = oo.robots.load("servicer"), oo.robots.load("target_satellite")
    q, q_target = servicer.neutral(), target.neutral()
    q[JOINTS_Q] = GRASPED
    offset = servicer.frame_pose(q, "tool")[:3, 3] - target.frame_pose(q_target, "handle")[:3, 3]
    q_target[:3] = offset
    v_target = np.array([0, 0, 0, 0.002, -0.003, 0.001])
    control = oo.Control(controller, name="arm") if isinstance(controller, oo.External) else controller
    systems = [
        oo.System("servicer", servicer, q, np.zeros(servicer.nv), controller=[control], knows=knows),
        oo.System("target", target, q_target, v_target),
    ]
    grasp = oo.Capture("grasp", "servicer/tool", "target/handle", at=0.1)
    return oo.World(systems, events=[grasp], environment=effects or [])


def assert_certified(trace: Any) -> None:
    for part in (trace, *(trace[name] for name in trace.names)):
        assert all(passed for _, _, _, passed in part.certificate()), part.certificate()


@pytest.mark.parametrize("knows", [["target"], []], ids=["knows", "does not know"])
def test_a_trajectory_moves_a_captured_load_as_the_law_of_the_joints_does(knows: list[str]) -> None:
    points, times = np.array([GRASPED, GRASPED, GRASPED + 0.1]), np.array([0.0, 0.5, 3.0])
    law = oo.JointComputedTorque(kp=49.0, kd=14.0)
    reference = oo.JointWaypoints(points, times=times)
    same = oo.Control(law, reference=reference, name="arm")
    expected = oo.Simulation(world(same, knows), time_step=5e-3).run(2.0)["servicer"]
    stepper = oo.Simulation(world(oo.External(49.0, 14.0), knows), time_step=5e-3).start(duration=2.0)
    assert stepper.systems == ["servicer", "target"]
    assert stepper["servicer"].external == {"arm": list(oo.robots.load("servicer").joint_names)}
    assert stepper["servicer"].interfaces == {"arm": "position"} and stepper["target"].external == {}
    rest = np.zeros((2, 7))
    stepper["servicer"].send_trajectory("arm", times[1:], points[1:], velocities=rest, accelerations=rest)
    stepper.advance_to(2.0)
    whole = stepper.finish()
    assert_certified(whole)
    trace = whole["servicer"]
    for column in ("q", "v", "tau"):
        assert np.array_equal(getattr(trace, column), getattr(expected, column)), column
    error = np.abs(trace.tracking["arm"][trace.time > 1.0]).max()
    assert error < 5e-5 if knows else error > 1e-2  # torques are held for 5 ms


@pytest.mark.parametrize("integrator", ["rk4", "dormand_prince", "semi_implicit_euler"])
@pytest.mark.parametrize("body", ["target/bus", "servicer/tool"])
def test_a_wrench_on_a_captured_system_is_that_of_an_effect(body: str, integrator: Any) -> None:
    """This holds if the controllers compensate the wrench, and in a row that is read before the next step."""
    force, torque, start = [2.0, -1.0, 0.5], [0.1, 0.2, -0.3], 0.25
    settings: Any = {"time_step": 5e-3, "integrator": integrator, "record_wrenches": True}
    effect = oo.BodyWrench(body, force=force, torque=torque, start=start)
    law = oo.External(49.0, 14.0)
    expected = oo.Simulation(world(law, ["target"], [effect]), **settings).run(0.6)
    stepper = oo.Simulation(world(law, ["target"]), **settings).start(duration=0.6)
    stepper.advance_to(start)
    stepper.trace()
    system, _, frame = body.partition("/")
    stepper[system].wrench(frame, force, torque, frame="body")
    stepper.trace()
    stepper.advance_to(0.6)
    trace = stepper.finish()
    if integrator != "semi_implicit_euler":
        assert_certified(trace)
    tolerance = 1e-9 if integrator == "dormand_prince" else 0.0  # its steps before the wrench are longer
    for name in ("servicer", "target"):
        for column in ("q", "v", "impulse", "work"):
            one, other = getattr(trace[name], column)[-1], getattr(expected[name], column)[-1]
            assert np.abs(one - other).max() <= tolerance * max(1.0, np.abs(other).max()), (name, column)
        given = trace[name].wrenches["wrench_command"][-1]
        assert np.abs(given - expected[name].wrenches["body_wrench"][-1]).max() <= tolerance
    assert np.abs(trace[system].impulse[-1, :3]).max() > 0.1


def block() -> tuple[oo.Model, np.ndarray, np.ndarray]:
    """Returns a rigid body that spins about z."""
    model = oo.Model.rigid_body(10.0, np.diag([2.0, 3.0, 4.0]))
    v = np.zeros(6)
    v[5] = 0.8
    return model, model.neutral(), v


def test_wrenches_in_both_axes_have_the_impulse_and_work_of_their_forces() -> None:
    model, q, v = block()
    force, mass, rate = np.array([3.0, -1.0, 2.0]), 10.0, 0.8
    fixed = oo.Simulation(model, q, v, time_step=1e-2).start()
    fixed.advance_to(0.123)  # within a step
    fixed.wrench("base", force)
    fixed.advance_to(1.123)
    fixed.wrench("base")
    fixed.advance_to(2.0)
    trace = fixed.finish()
    assert np.abs(trace.momentum[-1, :3] - force * 1.0).max() < 1e-12
    assert np.abs(trace.impulse[-1, :3] - force * 1.0).max() < 1e-12
    assert trace.work[-1] == pytest.approx(force @ force / (2 * mass), rel=1e-12)
    assert 0.123 in trace.time and 1.123 in trace.time
    assert all(passed for _, _, _, passed in trace.certificate())
    turning = oo.Simulation(model, q, v, time_step=1e-3).start()
    turning.wrench("base", [1.0, 0, 0], frame="body")
    turning.advance_to(1.0)
    momentum = turning.finish().momentum[-1, :3]
    expected = np.array([np.sin(rate), 1 - np.cos(rate), 0.0]) / rate  # ∫ (cos ωt, sin ωt) dt
    assert np.abs(momentum - expected).max() < 1e-10
    assert np.abs(momentum - [1.0, 0, 0]).max() > 0.1  # in W axes it would be this


def test_a_wrench_is_replaced_on_the_same_frame_only_and_survives_a_checkpoint() -> None:
    model = oo.robots.load("servicer")
    q, v = model.neutral(), np.zeros(model.nv)
    simulation = oo.Simulation(model, q, v, time_step=1e-2)
    stepper = simulation.start()
    stepper.wrench("bus", [1.0, 0, 0])
    stepper.wrench("tool", [0, 1.0, 0])
    stepper.wrench("bus", [0, 0, 2.0])
    stepper.advance_to(0.5)
    checkpoint = stepper.checkpoint()
    stepper.advance_to(1.0)
    end = stepper.finish()
    assert np.abs(end.momentum[-1, :3] - [0, 1.0, 2.0]).max() < 1e-12
    again = oo.Simulation(model, q, v, time_step=1e-2).start(resume=checkpoint)
    again.advance_to(1.0)
    trace = again.finish()
    assert np.array_equal(trace.q, end.q) and np.array_equal(trace.impulse, end.impulse)


def test_an_external_engine_refuses_wrenches() -> None:
    class Still:
        def step(self, start: float, end: float, q: Any, v: Any, tau: Any, wrenches: Any) -> Any:
            return q, v, 0 * v, np.zeros(6), 0.0, 0.0

    model, q, v = block()
    stepper = oo.Simulation(model, q, v, engine=Still(), time_step=1e-2).start()
    with pytest.raises(oo.exceptions.EngineError, match="commanded wrench"):
        stepper.wrench("base", [1.0, 0, 0])
    stepper.advance_to(0.1)


def test_a_look_at_the_run_does_not_change_the_torques_of_a_command() -> None:
    """A row at the present time updates the controllers; a user's controller must not be updated twice."""

    class Counting(oo.Controller):
        def __init__(self) -> None:
            self.calls = 0

        def reset(self) -> None:
            self.calls = 0

        def update(self, t: float, state: oo.State) -> np.ndarray:
            self.calls += 1
            return np.full(len(state.joints), 1e-3 * self.calls)

    model = oo.robots.load("servicer")
    q = model.neutral()
    q[JOINTS_Q] = GRASPED
    names = list(model.joint_names)
    traces = []
    for looks in (False, True):
        own = Counting()
        controls = [
            oo.Control(oo.External(49.0, 14.0), joints=names[:5], name="arm"),
            oo.Control(own, joints=names[5:], name="wrist"),
        ]
        stepper = oo.Simulation(model, q, np.zeros(model.nv), controller=controls, time_step=1e-2).start()
        for k in range(1, 6):
            stepper.advance_to(0.02 * k)
            if looks:
                stepper.trace()
            stepper.send("arm", position=GRASPED[:5] + 0.01 * k)
            if looks:
                stepper.trace()
        stepper.advance_to(0.2)
        traces.append((stepper.finish(), own.calls))
    (plain, calls), (looked, same) = traces
    assert calls == same and np.array_equal(plain.q, looked.q) and np.array_equal(plain.tau, looked.tau)
