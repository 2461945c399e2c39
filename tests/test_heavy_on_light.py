"""Heavy bodies on a light one: accelerations are as accurate as for other robots.

``oracles/test_digits.py`` compares them with 40-digit arithmetic.
"""

from __future__ import annotations

import numpy as np
import pytest

import onorbit_rs as oo

FRICTION = 2.0  # N m


def robot(base: float, friction: float = FRICTION) -> oo.Model:
    """Returns a base of the given mass with links of 10 t and 1 t, 10 m and 4 m long."""
    builder = oo.ModelBuilder("heavy", base="base", mass=base, inertia=np.diag([0.02, 0.02, 0.02]) * base)
    parent, at = "base", (0.0, 0.0, 0.2)
    for k, (mass, length) in enumerate([(1e4, 10.0), (1e3, 4.0)]):
        across = mass * length**2 / 12
        builder.add_link(
            f"link{k}", parent=parent, joint=f"joint{k}", kind="continuous", axis=(0.3, 1.0, 0.2 * k), xyz=at,
            mass=mass, com=(0.0, 0.0, length / 2), inertia=np.diag([across, across, across / 50]),
            friction=friction,
        )  # fmt: skip
        parent, at = f"link{k}", (0.0, 0.0, length)
    return builder.build()


class Torque(oo.Controller):
    """Controller with constant torques."""

    def __init__(self, torque: list[float]) -> None:
        self.torque = np.array(torque)

    def update(self, t: float, state: oo.State) -> np.ndarray:
        return self.torque


def fails(trace: oo.Trace) -> list[str]:
    return [name for name, _, _, passed in trace.certificate() if not passed]


def start(model: oo.Model) -> tuple[np.ndarray, np.ndarray]:
    q, v = model.neutral(), np.zeros(model.nv)
    q[7:] = [0.4, -0.7]
    v[:6] = [0.0, 0.0, 0.0, 0.001, -0.002, 0.003]
    return q, v


def test_stuck_joints_do_not_move_at_all() -> None:
    model = robot(1.0)
    q, v = start(model)
    trace = oo.Simulation(model, q, v, controller=Torque([1.8, -1.6]), time_step=0.01).run(2.0)
    np.testing.assert_array_equal(trace.q[:, 7:], np.tile(q[7:], (len(trace.q), 1)))
    assert fails(trace) == []


def test_slipping_joints_are_driven_by_the_torque_beyond_friction() -> None:
    model = robot(1.0)
    q, v = start(model)
    v[:] = 0.0
    torque = np.array([3.0, -2.5])
    trace = oo.Simulation(model, q, v, controller=Torque(list(torque)), time_step=1e-3).run(0.01)
    reduced = model.free_floating(q, v, "link1").inertia
    expected = np.linalg.solve(reduced, torque - FRICTION * np.sign(torque))
    np.testing.assert_allclose(trace.acceleration[0, 6:], expected, rtol=1e-6)


def test_momentum_and_energy_are_conserved() -> None:
    model = robot(1.0, friction=0.0)
    q, v = start(model)
    v[6:] = [0.05, -0.2]
    trace = oo.Simulation(model, q, v, time_step=2e-3).run(5.0)
    assert fails(trace) == []


@pytest.mark.parametrize("base", [1.0, 1e4])
def test_a_batch_of_one_has_the_bits_of_a_larger_batch(base: float) -> None:
    model = robot(base)
    rng = np.random.default_rng(3)
    q = np.tile(model.neutral(), (9, 1))
    q[:, 7:] = rng.uniform(-2, 2, (9, 2))
    v, tau = rng.normal(size=(9, model.nv)), rng.normal(size=(9, model.nv))
    together = model.forward_dynamics(q, v, tau)
    single = np.vstack([model.forward_dynamics(*(x[k : k + 1] for x in (q, v, tau))) for k in range(len(q))])
    np.testing.assert_array_equal(together, single)
    moments = np.abs(model.bias_forces(q, v)).max()
    np.testing.assert_allclose(model.inverse_dynamics(q, v, together), tau, rtol=0, atol=1e-12 * moments)
