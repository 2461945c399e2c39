"""Derivatives through Python: shapes, definitions, ``out=``, invalid input."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from border import MODEL, NAN, Bad, Q, V, check, shape, wrist

import onorbit_rs as oo
from onorbit_rs.exceptions import ConvergenceError

N, NV = MODEL.nv - 6, MODEL.nv
RNG = np.random.default_rng(7)
Q1 = MODEL.integrate(Q, RNG.uniform(-1.0, 1.0, NV))
V1, X1, JOINTS = RNG.uniform(-1.0, 1.0, NV), RNG.uniform(-1.0, 1.0, NV), RNG.uniform(-1.0, 1.0, N)
REDUCED = ("torque_dq", "torque_dv", "acceleration_dq", "acceleration_dv", "velocity_dq")


def along(function: Any) -> Any:
    """Returns the central differences of a function of a step (NV,), with one column for each direction."""
    h = 1e-6  # truncation 1e-11, rounding 1e-9
    return np.array([(function(h * e) - function(-h * e)) / (2 * h) for e in np.eye(NV)]).T


def test_derivatives_of_forward_dynamics_equal_its_differences() -> None:
    dq, dv, dtau = MODEL.forward_dynamics_derivatives(Q1, V1, X1)
    by_q = along(lambda step: MODEL.forward_dynamics(MODEL.integrate(Q1, step), V1, X1))
    by_v = along(lambda step: MODEL.forward_dynamics(Q1, V1 + step, X1))
    for ours, differences in ((dq, by_q), (dv, by_v)):
        assert np.abs(ours - differences).max() < 1e-6 * np.abs(ours).max()
    np.testing.assert_allclose(dtau @ MODEL.mass_matrix(Q1), np.eye(NV), atol=1e-9)
    # neither the base's pose nor a uniform translation matters
    np.testing.assert_array_equal(dq[:, :6], 0.0)
    np.testing.assert_array_equal(dv[6:, :3], 0.0)


def test_derivatives_of_the_reduced_model_equal_its_differences() -> None:
    def outputs(q: Any, v: Any) -> Any:
        ff = MODEL.free_floating(q, v, "tool")
        return np.concatenate(
            [
                ff.inertia @ JOINTS + ff.bias - ff.external,
                ff.jacobian @ JOINTS + ff.drift,
                MODEL.frame_velocity(q, v, "tool"),
            ]
        )

    found = MODEL.free_floating_derivatives(Q1, V1, JOINTS, "tool")
    by_q = along(lambda step: outputs(MODEL.integrate(Q1, step), V1))
    by_v = along(lambda step: outputs(Q1, V1 + step))
    ours_q = np.vstack([found.torque_dq, found.acceleration_dq, found.velocity_dq])
    ours_v = np.vstack([found.torque_dv, found.acceleration_dv, MODEL.frame_jacobian(Q1, "tool")])
    np.testing.assert_allclose(ours_q, by_q, atol=1e-7)
    np.testing.assert_allclose(ours_v, by_v, atol=1e-7)


def test_neighbouring_states_separate_as_the_tangent_predicts() -> None:
    # δ̇ = δv - [v_b × δ_b; 0], from configurations a short time later
    def drifted(shift: Any, rate: Any, t: float) -> Any:
        near = MODEL.integrate(MODEL.integrate(Q1, shift), t * (V1 + rate))
        return MODEL.difference(MODEL.integrate(Q1, t * V1), near)

    shift, rate = 1e-4 * RNG.uniform(-1.0, 1.0, (2, NV))
    carried = np.zeros(NV)
    linear, angular = shift[:3], shift[3:6]
    carried[:3] = np.cross(V1[3:6], linear) + np.cross(V1[:3], angular)
    carried[3:6] = np.cross(V1[3:6], angular)
    t = 1e-4
    rates = (drifted(shift, rate, t) - drifted(shift, rate, -t)) / (2 * t)
    # second order in the shift, 1e-8
    np.testing.assert_allclose(rates, rate - carried, atol=5e-8)
    assert np.abs(rates - rate).max() > 1e-5


def test_control_rotations_in_w_axes_are_another_tangent() -> None:
    # the same rotation vector in W axes: columns 3 to 5 differ
    def turned(step: Any) -> Any:
        attitude = MODEL.frame_pose(Q1, MODEL.body_names[0])[:3, :3]
        inside = np.concatenate([attitude.T @ step[:3], attitude.T @ step[3:6], step[6:]])
        return MODEL.frame_velocity(MODEL.integrate(Q1, inside), V1, "tool")

    found = MODEL.free_floating_derivatives(Q1, V1, JOINTS, "tool").velocity_dq
    assert np.abs(found - along(turned))[:, 3:6].max() > 0.1


def test_out_is_written_and_returned() -> None:
    q, v, x = np.tile(Q1, (9, 1)), np.tile(V1, (9, 1)), np.tile(X1, (9, 1))
    for kernel in (MODEL.inverse_dynamics_derivatives, MODEL.forward_dynamics_derivatives):
        fresh = kernel(q, v, x)
        out = tuple(np.full((9, NV, NV), NAN) for _ in range(3))
        back = kernel(q, v, x, out=out)
        for ours, given, expected in zip(back, out, fresh, strict=True):
            assert np.shares_memory(ours, given)
            np.testing.assert_array_equal(given, expected)
    fresh = MODEL.free_floating_derivatives(q, v, x[:, 6:], "tool")
    out = MODEL.free_floating_derivatives(q, 2 * v, x[:, 6:], "tool")
    assert MODEL.free_floating_derivatives(q, v, x[:, 6:], "tool", out=out) is out
    for name in REDUCED:
        np.testing.assert_array_equal(getattr(out, name), getattr(fresh, name))


def test_a_robot_without_joints_has_the_derivatives_of_its_base() -> None:
    body = oo.Model.rigid_body(2.0, np.diag([1.0, 2.0, 3.0]))
    q, v = body.neutral(), np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6])
    dq, dv, dtau = body.forward_dynamics_derivatives(q, v, np.zeros(6))
    x, y, z = v[3:]
    # Euler: dω/dt = -I⁻¹ ω × I ω;  dv/dt = -ω × v
    spin = -np.array([[0, 3 - 2, 3 - 2], [1 - 3, 0, 1 - 3], [2 - 1, 2 - 1, 0]]) * [
        [1, z, y],
        [z, 1, x],
        [y, x, 1],
    ]
    np.testing.assert_allclose(dv[3:, 3:], spin / np.array([[1.0], [2.0], [3.0]]), atol=1e-15)
    np.testing.assert_allclose(dv[:3, :3], [[0, z, -y], [-z, 0, x], [y, -x, 0]], atol=1e-15)
    np.testing.assert_allclose(np.diag(dtau), [0.5, 0.5, 0.5, 1.0, 1 / 2, 1 / 3], atol=1e-15)
    np.testing.assert_array_equal(dq, 0.0)
    for rows in ((), (3,)):
        state = [np.broadcast_to(x, (*rows, x.size)).copy() for x in (q, v, np.zeros(0))]
        found = body.free_floating_derivatives(*state, "base")
        assert found.torque_dq.shape == (*rows, 0, 6) and found.acceleration_dq.shape == (*rows, 6, 6)


ALL = np.zeros((3, MODEL.nv))
REFUSED = {
    "accelerations of the base, too": Bad(
        lambda: MODEL.free_floating_derivatives(Q, V, np.zeros(NV), "tool"),
        *shape("joint_acceleration", NV, "expected 7"),
    ),
    "a batch among single states": Bad(
        lambda: MODEL.forward_dynamics_derivatives(Q, V, ALL), *shape("tau", [3, NV], "(n,)")
    ),
    "not a number": Bad(
        lambda: MODEL.inverse_dynamics_derivatives(Q, V, np.full(NV, NAN)), "InputError", ("'a' holds NaN",)
    ),
    "no such frame": Bad(
        lambda: MODEL.free_floating_derivatives(Q, V, np.zeros(N), "tol"), "FrameError", ("tol", "tool")
    ),
    "one array for three": Bad(
        lambda: MODEL.forward_dynamics_derivatives(Q, V, V, out=np.zeros((NV, NV))),
        "InputError", ("out", "three arrays of shape (nv, nv)"),
    ),
    "an array too small": Bad(
        lambda: MODEL.forward_dynamics_derivatives(
            Q, V, V, out=(np.zeros((NV, NV)), np.zeros((NV, N)), np.zeros((NV, NV)))
        ),
        "ShapeError", ("out[1]", f"({NV}, {NV})"),
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", REFUSED)
def test_invalid_input_is_rejected(name: str) -> None:
    check(REFUSED[name])


def test_a_singular_state_is_named() -> None:
    model = wrist()
    q, v, tau = np.tile(model.neutral(), (2, 1)), np.zeros((2, model.nv)), np.ones((2, model.nv))
    q[0, 8] = 0.5
    with pytest.raises(ConvergenceError, match="the result for state 1 is not finite"):
        model.forward_dynamics_derivatives(q, v, tau)
    assert np.isfinite(model.forward_dynamics_derivatives(q[0], v[0], tau[0])[0]).all()
    # no other derivative divides by the joint's inertia
    assert np.isfinite(model.inverse_dynamics_derivatives(q, v, tau)[0]).all()
