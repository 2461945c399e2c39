"""Trajectory optimisation with exact derivatives: the smallest torques that move an arm to a posture in 2 s.

The derivative of the final state with respect to the torques is accumulated backwards over the steps from
∂a/∂q, ∂a/∂v and ∂a/∂τ. Each iteration computes the smallest torques for the linearised motion.

Run: python examples/least_torque.py
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import onorbit_rs as oo

Floats = NDArray[np.float64]
STEPS, H = 40, 0.05  # number of steps, step length in s


def roll(model: oo.Model, q: Floats, tau: Floats) -> tuple[Floats, Floats]:
    """Integrates by semi-implicit Euler: v⁺ = v + h a(q, v, τ), q⁺ = q ⊕ h v⁺."""
    qs, vs = [q], [np.zeros(model.nv)]
    for now in np.pad(tau, [(0, 0), (6, 0)]):  # no wrench on the base
        vs.append(vs[-1] + H * model.forward_dynamics(qs[-1], vs[-1], now))
        qs.append(model.integrate(qs[-1], H * vs[-1]))
    return np.array(qs), np.array(vs)


def sensitivity(model: oo.Model, qs: Floats, vs: Floats, tau: Floats) -> Floats:
    """Returns the derivative of the final joint state with respect to all torques, (2n, STEPS, n)."""
    n, torques = model.nv - 6, np.pad(tau, [(0, 0), (6, 0)])
    dq, dv, dtau = model.forward_dynamics_derivatives(qs[:-1], vs[:-1], torques)  # (STEPS, nv, nv) each
    by_q, by_v = np.eye(2 * n, model.nv, 6), np.eye(2 * n, model.nv, 6 - n)  # ∂(end)/∂q, ∂(end)/∂v
    rows = np.empty((2 * n, STEPS, n))
    for k in reversed(range(STEPS)):
        by_v = by_v + H * by_q  # joint positions add; the dynamics do not depend on the base pose
        rows[:, k] = H * by_v @ dtau[k, :, 6:]
        by_q, by_v = by_q + H * by_v @ dq[k], by_v + H * by_v @ dv[k]
    return rows


def main() -> None:
    model = oo.robots.load("humanoid_torso")
    n, q = model.nv - 6, model.neutral()
    q[7:] = [0.5, -1.5, -1.0, -1.5, -1.0, 0.3, 0.2]
    goal = np.concatenate([q[7:] + 0.4, np.zeros(n)])  # rad, then at rest
    tau, at_rest = np.zeros((STEPS, n)), np.zeros(model.nv)
    scale = np.linalg.cholesky(model.free_floating(q, at_rest, "tool").inertia)  # weights the torques
    for k in range(13):
        qs, vs = roll(model, q, tau)
        off = np.concatenate([qs[-1, 7:], vs[-1, 6:]]) - goal
        print(f"{k}: error {abs(off).max():.1e}, largest torque {abs(tau).max():.3f} N m")
        jac = (sensitivity(model, qs, vs, tau) @ scale).reshape(2 * n, -1)  # by x, where tau = scale x
        x = np.linalg.solve(scale, tau.T).T.ravel()
        tau = (np.linalg.pinv(jac) @ (jac @ x - off)).reshape(tau.shape) @ scale.T
    assert abs(off).max() < 1e-10


if __name__ == "__main__":
    main()
