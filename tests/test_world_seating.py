"""Seating: after a capture, the captured frame moves to its nominal pose."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.common.rotations import matrix_from_quaternion, quaternion_from_roll_pitch_yaw

SEAT, STEP = 3.0, 5e-3


def craft(name: str, mass: float, inertia: list[float], position: list[float], twist: list[float]) -> Any:
    model = oo.Model.rigid_body(mass, np.diag(inertia))
    q = model.neutral()
    q[:3] = position
    return oo.System(name, model, q, twist)


def pair() -> list[Any]:
    """Returns two bodies at rest, 2 m apart."""
    return [
        craft("a", 90.0, [9, 9, 9], [0, 0, 0], [0] * 6),
        craft("b", 10.0, [1, 1, 1], [2, 0, 0], [0] * 6),
    ]


def pose(rpy: list[float], position: list[float]) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, :3] = matrix_from_quaternion(quaternion_from_roll_pitch_yaw(np.array(rpy)))
    matrix[:3, 3] = position
    return matrix


def run(systems: list[Any], events: list[Any], duration: float, **settings: Any) -> Any:
    return oo.Simulation(oo.World(systems, events=events), time_step=STEP, **settings).run(duration)


def relative_pose(trace: Any, row: int = -1) -> np.ndarray:
    """Returns the pose of the base of the second system in the base of the first."""
    a, b = (np.eye(4), np.eye(4))
    for matrix, name in ((a, "a"), (b, "b")):
        q = trace[name].q[row]
        matrix[:3, :3], matrix[:3, 3] = matrix_from_quaternion(q[3:7]), q[:3]
    return np.linalg.inv(a) @ b


def test_two_bodies_are_pulled_together_about_their_common_centre_of_mass():
    capture = oo.Capture("grasp", "a/base", "b/base", at=1.0, seat=SEAT, pose=pose([0, 0, 0], [1, 0, 0]))
    trace = run(pair(), [capture], 6.0)
    # the centre of mass stays: a moves by 10/100 of 1 m towards b
    np.testing.assert_allclose(trace["a"].q[-1][:3], [0.1, 0, 0], atol=1e-14)
    np.testing.assert_allclose(trace["b"].q[-1][:3], [1.1, 0, 0], atol=1e-14)
    # in the middle, the relative speed is 15/8 of the mean speed: ½ μ v²
    middle = np.argmin(np.abs(trace["a"].time - (1.0 + SEAT / 2)))
    energy = trace["a"].kinetic_energy[middle] + trace["b"].kinetic_energy[middle]
    assert energy == pytest.approx(0.5 * 9.0 * (15 / 8 / SEAT) ** 2, rel=1e-12)
    assert all(passed for _, _, _, passed in trace.certificate())


def test_a_turn_is_shared_in_proportion_to_the_inertias():
    systems = [
        craft("a", 50.0, [4, 4, 6], [0, 0, 0], [0] * 6),
        craft("b", 5.0, [1, 1, 2], [0, 0, 0], [0] * 6),
    ]
    capture = oo.Capture("grasp", "a/base", "b/base", at=0.0, seat=SEAT, pose=pose([0, 0, 1.2], [0, 0, 0]))
    trace = run(systems, [capture], 4.0)
    angle = 2 * np.arctan2(trace["a"].q[-1][5], trace["a"].q[-1][6])
    assert angle == pytest.approx(-1.2 * 2 / (6 + 2), abs=1e-10)


def moving() -> list[Any]:
    first = craft("a", 80.0, [9, 11, 6], [0.3, -0.2, 0.1], [0.1, 0.05, -0.02, 0.02, -0.05, 0.04])
    second = craft("b", 30.0, [2, 3, 1.5], [1.1, 0.4, 0.2], [-0.05, 0.02, 0.03, 0.1, 0.03, -0.07])
    return [first, second]


@pytest.mark.parametrize("integrator", ["rk4", "dormand_prince"])
def test_the_nominal_pose_is_reached_with_momentum_to_rounding(integrator: str):
    nominal = pose([0.2, -0.1, 0.4], [0.6, 0.1, -0.3])
    events = [
        oo.Capture("grasp", "a/base", "b/base", at=0.5, seat=SEAT, pose=nominal),
        oo.Release("let_go", "grasp", at=5.0),
    ]
    trace = run(moving(), events, 6.0, integrator=integrator)
    row = np.searchsorted(trace["a"].time, 4.5)
    assert np.abs(relative_pose(trace, row) - nominal).max() < 1e-14
    momentum = trace.momentum
    assert np.abs(momentum - momentum[0]).max() < 1e-13
    assert all(passed for _, _, _, passed in trace.certificate())
    assert [event.name for event in trace.events] == ["grasp", "let_go"]


def test_the_order_of_declaration_of_root_and_captured_does_not_matter():
    nominal = pose([0.2, -0.1, 0.4], [0.6, 0.1, -0.3])
    there = run(moving(), [oo.Capture("g", "a/base", "b/base", at=0.5, seat=SEAT, pose=nominal)], 5.0)
    back = np.linalg.inv(nominal)
    here = run(moving(), [oo.Capture("g", "b/base", "a/base", at=0.5, seat=SEAT, pose=back)], 5.0)
    # the paths differ, because the line is straight in other axes; their ends do not
    assert np.abs(relative_pose(here) - relative_pose(there)).max() < 1e-14


def test_a_release_during_the_seating_keeps_the_relative_velocity():
    capture = oo.Capture("grasp", "a/base", "b/base", at=0.0, seat=SEAT, pose=pose([0, 0, 0], [1, 0, 0]))
    trace = run(pair(), [capture, oo.Release("let_go", "grasp", at=SEAT / 2)], 3.0)
    speed = trace["b"].v[-1][0] - trace["a"].v[-1][0]
    assert speed == pytest.approx(-15 / 8 / SEAT, rel=1e-12)
    assert all(passed for _, _, _, passed in trace.certificate())


def test_a_capture_during_the_seating_keeps_its_rate():
    third = craft("c", 20.0, [2, 2, 2], [1.0, 1.0, 0.3], [0.02, -0.1, 0, 0.01, 0.02, -0.03])
    nominal = pose([0.2, -0.1, 0.4], [0.6, 0.1, -0.3])
    events = [
        oo.Capture("grasp", "a/base", "b/base", at=0.5, seat=SEAT, pose=nominal),
        oo.Capture("second", "b/base", "c/base", at=2.0),
        oo.Release("let_go", "second", at=2.5, impulse=[0.3, 0.1, -0.2, 0.02, 0, 0.01]),
    ]
    trace = run([*moving(), third], events, 5.0)
    assert np.abs(relative_pose(trace) - nominal).max() < 1e-14
    assert np.abs(trace.momentum - trace.momentum[0]).max() < 1e-12
    assert all(passed for _, _, _, passed in trace.certificate())


def test_pieces_and_checkpoints_during_the_seating_have_the_same_bits():
    nominal = pose([0.2, -0.1, 0.4], [0.6, 0.1, -0.3])
    events = [oo.Capture("grasp", "a/base", "b/base", at=0.5, seat=SEAT, pose=nominal)]
    whole = run(moving(), events, 5.0)
    simulation = oo.Simulation(oo.World(moving(), events=events), time_step=STEP)
    stepper = simulation.start(duration=5.0)
    stepper.advance_to(1.7)
    resumed = simulation.start(resume=stepper.checkpoint())
    resumed.advance_to(5.0)
    for name in ("a", "b"):
        np.testing.assert_array_equal(resumed.trace()[name].q, whole[name].q)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"seat": 0.0}, "duration of the seating"),
        ({"seat": float("nan")}, "duration of the seating"),
        ({"pose": np.eye(4)}, "a pose without seat"),
        ({"seat": 1.0, "pose": np.diag([2, 2, 2, 1])}, "rotation"),
        ({"seat": 1.0, "pose": pose([0, 0, 0], [0, -1e6, 0])}, "distance.*is 1000000 m.*at most 1000 m"),
    ],
)
def test_bad_seating_is_refused(arguments: dict[str, Any], message: str):
    with pytest.raises(oo.OnOrbitError, match=message):
        run(moving(), [oo.Capture("grasp", "a/base", "b/base", at=0.0, **arguments)], 1.0)


@pytest.mark.parametrize("restitution", [0.0, 0.5])
def test_a_joint_that_reaches_its_stop_during_the_seating_keeps_the_energy_balance(restitution: float):
    builder = oo.ModelBuilder("a", base="base", mass=80, inertia=np.diag([8.0, 9, 10]))
    builder.add_link(
        "slider", parent="base", joint="slide", kind="prismatic", axis=[1, 0, 0],
        mass=4.0, inertia=0.1 * np.eye(3), lower=-0.02, upper=0.05,
    )  # fmt: skip
    model, target = builder.build(), oo.Model.rigid_body(40.0, np.diag([3.0, 4, 5]))
    q = target.neutral()
    q[0] = 1.0
    systems = [
        oo.System(
            "a", model, model.neutral(), [0] * 6 + [0.02], enforce_limits=True, restitution=restitution
        ),
        oo.System("b", target, q, [-0.01, 0, 0, 0, 0, 0]),
    ]
    events = [oo.Capture("g", "a/slider", "b/base", at=0.5, seat=2.0, pose=pose([0, 0, 0], [0.5, 0, 0]))]
    trace = oo.Simulation(oo.World(systems, events=events), time_step=1e-3).run(4.0)
    assert trace["a"].q[:, 7].max() == pytest.approx(0.05, abs=1e-9)
    assert [check for check in trace.certificate() if "energy" in check[0] and not check[3]] == []


@pytest.mark.parametrize("steps", [0.01, 1, 5, 20])
def test_a_seating_of_few_steps_is_resolved(steps: float):
    """The engine takes shorter steps during a short motion."""
    seat, step = steps * 0.01, 0.01
    nominal = pose([0.3, 0.1, 0], [1.2, 0, 0])
    capture = oo.Capture("grasp", "a/base", "b/base", at=0.1, seat=seat, pose=nominal)
    trace = oo.Simulation(oo.World(moving(), events=[capture]), time_step=step).run(0.5)
    assert [check for check in trace.certificate() if not check[3]] == []


def test_a_seating_below_the_resolution_of_the_schedule_is_refused():
    with pytest.raises(oo.exceptions.WorldError, match="a thousandth of time_step"):
        run(moving(), [oo.Capture("grasp", "a/base", "b/base", at=0.0, seat=1e-6)], 1.0)
