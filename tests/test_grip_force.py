"""Closing of a gripper to a force: phases of the law, limits, goals, checkpoints, and bad input."""

from __future__ import annotations

import pickle
from typing import Any

import contact_alternatives
import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.tools.validation import grasp, grasp_worlds
from onorbit_rs.tools.validation.grasp_worlds import arm, grip, hand, run, world


def mean_force(trace: oo.WorldTrace) -> np.ndarray:
    contacts = [trace.contacts[name] for name in ("left", "right")]
    return np.mean([np.abs(np.einsum("ti,ti->t", one.force, one.normal)) for one in contacts], axis=0)


@pytest.fixture(scope="module")
def gripped() -> oo.WorldTrace:
    return run(world([arm([0.0, 0.0], [0.0, 1.0]), grip()], place=(0.004, 0.0, 0.0)), 4.0)


def test_the_tracking_column_is_the_force_error(gripped: oo.WorldTrace) -> None:
    error = np.asarray(gripped["hand"].tracking["grip"])
    assert error.shape == (len(gripped["hand"].time), 1)
    np.testing.assert_allclose(grasp_worlds.FORCE - error[:, 0], mean_force(gripped), rtol=1e-12, atol=1e-12)
    assert abs(error[-1, 0]) < 0.02 and error[0, 0] == grasp_worlds.FORCE


def test_the_first_finger_presses_with_the_damping_only(gripped: oo.WorldTrace) -> None:
    """The bar is 4 mm off the middle, so one pad touches first and pushes it gently."""
    down = [event for event in gripped.events if event.kind == "touch_down"]
    first, second = down[0], next(event for event in down if event.name != down[0].name)
    assert second.time - first.time > 0.05
    alone = (gripped["hand"].time > first.time) & (gripped["hand"].time < second.time - 1e-9)
    pressed = np.linalg.norm(np.asarray(gripped.contacts[first.name].force), axis=1)[alone]
    closing = abs(grasp_worlds.CLOSING)
    # the impact stops the bar, of 80 kg, elastically: its force depends on the speed, not on the grip
    stop = closing * np.sqrt(grasp_worlds.STIFFNESS * 1.2)
    assert 0.0 < pressed.max() < stop + grasp_worlds.DAMPING * closing
    assert np.abs(np.asarray(gripped["hand"].tau)[: int(alone.argmax()), 1]).max() < 40.0 * closing * 1.01


def test_the_force_rises_with_the_ramp() -> None:
    slow = oo.Control(
        oo.GripForce(25.0, closing_rate=-0.02, damping=40.0, ramp=1.0), joints=["left_jaw"], name="grip"
    )
    trace = run(world([arm([0.0, 0.0], [0.0, 1.0]), slow]), 2.5)
    force, time = mean_force(trace), np.asarray(trace["hand"].time)
    at = [float(time[np.argmax(force > level)]) for level in (5.0, 20.0)]
    assert at[1] - at[0] == pytest.approx(0.6, abs=0.1)  # 15 N with 25 N/s


def test_a_goal_is_decided_after_the_ramp_and_starts_another_control() -> None:
    law = oo.GripForce(25.0, closing_rate=-0.02, damping=40.0, ramp=0.5)
    closes = oo.Control(law, joints=["left_jaw"], name="grip", goal=oo.Goal(tolerance=0.1, time=3.0))
    reference = oo.JointWaypoints([[0.0], [0.02]], times=[0.0, 0.5])
    moves = oo.Control(
        oo.JointPid(p=16000.0, d=2400.0), reference=reference, joints=["arm"], name="arm", after="grip",
        starts_at_present=True,
    )  # fmt: skip
    trace = run(world([closes, moves]), 2.5)
    (result,) = trace["hand"].results
    assert result["outcome"] == "succeeded" and result["time"] > 0.5 + 0.5
    reached = int(np.argmin(np.abs(trace["hand"].time - result["time"])))
    assert abs(mean_force(trace)[reached] - 25.0) < 0.1
    assert np.ptp(np.asarray(trace["hand"].q)[reached:, 7]) > 0.015


def test_without_an_object_the_goal_is_missed_and_the_jaws_close() -> None:
    law = oo.GripForce(25.0, closing_rate=-0.02, damping=40.0)
    closes = oo.Control(law, joints=["left_jaw"], name="grip", goal=oo.Goal(tolerance=0.1, time=1.0))
    trace = run(world([closes], place=(0.0, 0.0, 0.3)), 1.2)
    (result,) = trace["hand"].results
    assert (result["outcome"], result["component"]) == ("goal_tolerance_violated", "force")
    assert trace["hand"].q[-1, 8] < 0.01 and not mean_force(trace).any()


def test_the_effort_limit_stops_the_force_and_the_integral() -> None:
    law = oo.GripForce(25.0, closing_rate=-0.02, damping=40.0, ramp=0.2, effort_limit=30.0)
    assert grasp_worlds.FORCE == 25.0
    message = r"requires an effort of 50 N from joint 'left_jaw'.*to about 15 N"
    with pytest.raises(oo.exceptions.ControlError, match=message):
        world([oo.Control(law, joints=["left_jaw"], name="grip")])
    # with forces of 10 N that open the fingers, 70 N would be required
    back = [oo.BodyWrench("hand/left_finger", force=[10.0, 0.0, 0.0], start=1.5, end=3.5),
            oo.BodyWrench("hand/right_finger", force=[-10.0, 0.0, 0.0], start=1.5, end=3.5)]  # fmt: skip
    limited = grip(integral=5.0, effort_limit=60.0)
    trace = run(world([arm([0.0, 0.0], [0.0, 1.0]), limited], loads=back), 4.5)
    tau, time = np.abs(np.asarray(trace["hand"].tau)[:, 1]), np.asarray(trace["hand"].time)
    assert 60.0 - 1e-12 < tau.max() <= 60.0
    force = mean_force(trace)
    assert force[np.searchsorted(time, 3.4)] == pytest.approx((60.0 - 20.0) / 2.0, abs=0.01)
    # the integral of 5 N at the limit decays with its gain of 5 1/s; wound up for 2 s, it would be 50 N
    assert force[-1] - 25.0 == pytest.approx(5.0 * np.exp(-5.0 * 1.0), abs=0.005)


def test_a_run_resumes_with_the_same_bits() -> None:
    simulation = oo.Simulation(world([arm([0.0, 0.0], [0.0, 1.0]), grip()]), time_step=5e-3)
    stepper = simulation.start()
    stepper.advance_to(0.7)  # within the ramp
    saved = stepper.checkpoint()
    stepper.advance_to(1.4)
    whole = stepper.trace()
    other = oo.Simulation(world([arm([0.0, 0.0], [0.0, 1.0]), grip()]), time_step=5e-3).start(resume=saved)
    other.advance_to(1.4)
    resumed = other.trace()
    assert isinstance(whole, oo.WorldTrace) and isinstance(resumed, oo.WorldTrace)
    np.testing.assert_array_equal(resumed["hand"].q[-1], whole["hand"].q[-1])
    np.testing.assert_array_equal(resumed["hand"].tracking["grip"][-1], whole["hand"].tracking["grip"][-1])


def test_regularised_friction_would_creep() -> None:
    """Control of the validation case: friction that is a function of the velocity does not hold the load."""
    assert contact_alternatives.smooth(grasp_worlds.FORCE, grasp.LOAD, 0.0, 0.4) > 1e-4
    assert grasp.creep()[0] < 1e-9


def test_the_certificate_of_a_long_grip_by_three_fingers_passes() -> None:
    """Regression: 8.9e-5 of a gate of 5e-5, and 1.9e-5 for the position, for every step length.

    The rounding errors of the normals between fingers and pin, 1.5e-8, were added up as though all had the
    same sign. The control with steps that are too long is in ``contact_certificate.rs``.
    """
    trace, _ = grasp_worlds.three_fingers(grasp.PIN, 5.0, lasts=5.0)
    checks = {name: value for name, value, *_ in trace["hand"].certificate()}
    assert checks["joint_step_doubling_rel"] is not None and checks["joint_step_doubling_rel"] < 1e-5
    assert checks["position_step_doubling_rel"] is not None and checks["position_step_doubling_rel"] < 1e-6
    assert all(passed for *_, passed in trace["hand"].certificate())


def test_a_law_is_pickled() -> None:
    law = oo.GripForce(25.0, closing_rate=[-0.02], damping=40.0, ramp=1.0, stiffness=3.0)
    again = pickle.loads(pickle.dumps(law))
    assert again.__reduce__()[1][1:] == law.__reduce__()[1][1:] or type(again) is oo.GripForce
    trace = [run(world([oo.Control(one, joints=["left_jaw"])]), 0.2)["hand"].q[-1] for one in (law, again)]
    np.testing.assert_array_equal(*trace)


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"force": 0.0}, "force is 0; it must be positive"),
        ({"force": -1.0}, "force is -1; it must not be negative"),
        ({"force": np.inf}, "force holds inf"),
        ({"damping": 0.0}, "damping is 0; it must be positive"),
        ({"closing_rate": 0.0}, "closing_rate is 0; its sign determines the direction of the motion"),
        ({"closing_rate": np.nan}, "closing_rate holds NaN"),
        ({"ramp": -1.0}, "ramp is -1"),
        ({"integral": np.nan}, "integral holds NaN"),
        ({"stiffness": -1.0}, "stiffness is -1"),
        ({"effort_limit": -1.0}, "effort_limit is -1"),
    ],
)
def test_a_wrong_number_is_an_error(changed: dict[str, Any], message: str) -> None:
    values: dict[str, Any] = {"force": 25.0, "closing_rate": -0.02, "damping": 40.0} | changed
    with pytest.raises(oo.exceptions.ControlError, match=message.replace("(", r"\(")):
        oo.GripForce(values.pop("force"), **values)


def test_a_control_that_grips_needs_contacts_and_no_reference() -> None:
    law = oo.GripForce(25.0, closing_rate=-0.02, damping=40.0)
    q, _ = grasp_worlds.start()
    alone = oo.System(
        "hand", hand(), q, np.zeros(hand().nv), controller=[oo.Control(law, joints=["left_jaw"])]
    )
    with pytest.raises(oo.exceptions.ControlError, match="no contact with a normal force involves a link"):
        oo.Simulation(oo.World([alone]), time_step=5e-3).run(0.01)
    with pytest.raises(oo.exceptions.ControlError, match="tracks no reference"):
        world([oo.Control(law, joints=["left_jaw"], reference=oo.JointHold([0.0]))])
    with pytest.raises(oo.exceptions.ControlError, match="'starts_at_present' has no effect"):
        world([oo.Control(law, joints=["left_jaw"], starts_at_present=True)])
    with pytest.raises(oo.exceptions.ControlError, match="'path_tolerance' has no effect"):
        goal = oo.Goal(tolerance=0.1, path_tolerance=0.1)
        world([oo.Control(law, joints=["left_jaw"], goal=goal)])
