"""Rotations used in reports: against closed forms and round trips."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

import onorbit_rs as oo
from onorbit_rs.common.rotations import (
    angle_between,
    has_local_frame,
    local_orbital_axes,
    matrix_from_quaternion,
    quaternion_from_matrix,
    quaternion_from_roll_pitch_yaw,
    roll_pitch_yaw,
)
from onorbit_rs.scenario import Scenario, load
from onorbit_rs.scenario.build import build

quaternions = (
    st.lists(st.floats(-1.0, 1.0), min_size=4, max_size=4)
    .map(np.array)
    .filter(lambda quat: np.linalg.norm(quat) > 1e-3)
    .map(lambda quat: quat / np.linalg.norm(quat))
)
ROUNDING = 1e-14
"""Rounding of a few dozen operations on numbers of order one."""


def test_quarter_turn_about_z_takes_x_to_y() -> None:
    quat = np.array([0.0, 0.0, np.sqrt(0.5), np.sqrt(0.5)])
    np.testing.assert_allclose(matrix_from_quaternion(quat) @ [1, 0, 0], [0, 1, 0], atol=ROUNDING)


def test_roll_pitch_yaw_rotate_about_fixed_axes_in_this_order() -> None:
    roll, pitch, yaw = (
        matrix_from_quaternion(quaternion_from_roll_pitch_yaw(angles)) for angles in 0.3 * np.eye(3)
    )
    whole = matrix_from_quaternion(quaternion_from_roll_pitch_yaw([0.3, 0.3, 0.3]))
    np.testing.assert_allclose(whole, yaw @ pitch @ roll, atol=ROUNDING)


@given(quaternions)
def test_matrix_and_quaternion_are_inverse_conversions(quat: np.ndarray) -> None:
    rotation = matrix_from_quaternion(quat)
    np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=ROUNDING)
    np.testing.assert_allclose(
        matrix_from_quaternion(quaternion_from_matrix(rotation)), rotation, atol=ROUNDING
    )


@given(st.floats(-3.1, 3.1), st.floats(-1.5, 1.5), st.floats(-3.1, 3.1))
def test_angles_survive_the_quaternion(roll: float, pitch: float, yaw: float) -> None:
    angles = roll_pitch_yaw(quaternion_from_roll_pitch_yaw([roll, pitch, yaw]))
    np.testing.assert_allclose(angles, [roll, pitch, yaw], atol=1e-12)  # cos(1.5) magnifies rounding 14 times


@given(st.floats(0.0, np.pi), quaternions)
def test_angle_between_is_exact_even_when_small(angle: float, axis: np.ndarray) -> None:
    length = np.linalg.norm(axis[:3])
    unit = axis[:3] / length if length > 1e-6 else np.array([1.0, 0.0, 0.0])
    turned = np.append(np.sin(angle / 2) * unit, np.cos(angle / 2))
    identity = np.array([0.0, 0.0, 0.0, 1.0])
    assert abs(angle_between(turned, identity) - angle) <= 4e-16 * max(angle, 1.0) * 4
    assert abs(angle_between(-turned, identity) - angle) <= 4e-16 * max(angle, 1.0) * 4


def test_the_recorded_reference_is_the_orbit_after_rereferencing() -> None:
    data = load("hill_relative").resolved() | {"controller": None, "reference": None}
    data["initial"] |= {"linear_velocity": [0.0, 40.0, 0.0]}
    data["simulation"] |= {"duration": 200.0, "rereference_beyond": 2000.0}
    built = build(Scenario(**data))
    trace = built.simulation.run(200.0)
    assert len(trace.rereferenced) == 1 and built.orbit is not None
    position, velocity = built.orbit.state(trace.time)
    np.testing.assert_array_equal(trace.reference_position_eci, position)
    np.testing.assert_array_equal(trace.reference_velocity_eci, velocity)
    # r = r_W + p,  ṙ = ṙ_W + R v_B
    rot_wb = matrix_from_quaternion(trace.q[:, 3:7])
    np.testing.assert_allclose(trace.position_eci, position + trace.q[:, :3], rtol=0, atol=4e-9)
    np.testing.assert_allclose(
        trace.velocity_eci, velocity + np.einsum("tij,tj->ti", rot_wb, trace.v[:, :3]), rtol=0, atol=4e-12
    )


def test_a_reference_at_rest_has_no_local_frame() -> None:
    model = oo.Model.rigid_body(10.0, np.eye(3))
    orbit = oo.FixedFrame(position=[7e6, 0.0, 0.0])
    q = model.neutral()
    q[3:7] = [0.1, 0.2, 0.3, 0.92736185]
    q[3:7] /= np.linalg.norm(q[3:7])
    v = np.array([0.01, 0.02, 0.03, 0.1, 0.2, 0.3])
    trace = oo.Simulation(model, q, v, orbit=orbit, time_step=0.1).run(1.0)
    assert not has_local_frame(trace)


def test_local_orbital_axes_are_radial_along_track_and_normal() -> None:
    rot_il = local_orbital_axes([0.0, 7e6, 0.0], [-7e3, 100.0, 0.0])
    np.testing.assert_allclose(rot_il, [[0, -1, 0], [1, 0, 0], [0, 0, 1]], atol=ROUNDING)
