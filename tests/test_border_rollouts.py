"""Rollouts: each equals the run of ``Simulation``, for any number of threads."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.exceptions import ControlError, SimulationError

MODEL = oo.robots.load("humanoid_torso")
REACH = [0.5342, -2.341, -2.0077, -2.2249, -2.2693, -0.1342, -0.1974]
STEPS, DT = 40, 1e-3


def states(count: int) -> tuple[Any, Any]:
    rng = np.random.default_rng(count)
    q = np.tile(MODEL.neutral(), (count, 1))
    q[:, 7:] = REACH + rng.uniform(-0.1, 0.1, (count, 7))
    return q, rng.uniform(-0.2, 0.2, (count, MODEL.nv))


def law() -> dict[str, Any]:
    q = MODEL.neutral()
    q[7:] = REACH
    line = oo.LineParabola(
        MODEL.frame_pose(q, "tool"), displacement=[0.5, 0, 0], height=[0, 0, 0.4], duration=10.0
    )
    return {"controller": oo.ComputedTorque(MODEL, "tool", null_space_damping=2.0), "reference": line}


class Torques(oo.Controller):
    def __init__(self, tau: Any) -> None:
        self.tau = tau

    def update(self, t: float, state: Any) -> Any:
        return self.tau[min(round(t / DT), len(self.tau) - 1)]


@pytest.mark.parametrize("integrator", ["rk4", "semi_implicit_euler"])
@pytest.mark.parametrize("kind", ["passive", "torques", "law"])
def test_a_rollout_equals_its_single_runs(kind: str, integrator: Any) -> None:
    count = 11  # not a multiple of the number of lanes
    q0, v0 = states(count)
    tau = np.random.default_rng(3).uniform(-1.0, 1.0, (count, STEPS, 7))
    given: dict[str, Any] = {"passive": {}, "torques": {"tau": tau}, "law": law()}[kind]
    q, v = oo.rollout(MODEL, q0, v0, steps=STEPS, time_step=DT, integrator=integrator, **given)
    assert q.shape == (count, MODEL.nq) and v.shape == (count, MODEL.nv)
    anywhere = [1.0, np.pi]  # the states scatter about the initial state of the reference
    for k in range(count):
        known: dict[str, Any] = {"controller": Torques(tau[k])} if kind == "torques" else given
        alone = oo.Simulation(
            MODEL,
            q0[k],
            v0[k],
            time_step=DT,
            integrator=integrator,
            reference_start_tolerance=anywhere,
            **known,
        )
        trace = alone.run(STEPS * DT)
        # the same steps in another order of operations; 1e-12 of entries of order one
        np.testing.assert_allclose(q[k], trace.q[-1], rtol=0, atol=1e-12)
        np.testing.assert_allclose(v[k], trace.v[-1], rtol=0, atol=1e-11)


@pytest.mark.parametrize("kind", ["passive", "law"])
def test_the_bits_depend_neither_on_threads_nor_on_neighbours(kind: str) -> None:
    q0, v0 = states(150)
    given = law() if kind == "law" else {}
    once = oo.rollout(MODEL, q0, v0, steps=10, threads=1, **given)
    for threads in (2, 3, None):
        for one, other in zip(
            oo.rollout(MODEL, q0, v0, steps=10, threads=threads, **given), once, strict=True
        ):
            np.testing.assert_array_equal(one, other)
    part = oo.rollout(MODEL, q0[77:], v0[77:], steps=10, **given)
    np.testing.assert_array_equal(part[0], once[0][77:])


def test_rows_are_the_start_and_every_kth_step() -> None:
    q0, v0 = states(5)
    q, v = oo.rollout(MODEL, q0, v0, steps=10, record_every=4)
    assert q.shape == (5, 3, MODEL.nq) and v.shape == (5, 3, MODEL.nv)
    np.testing.assert_array_equal(q[:, 0], q0)
    np.testing.assert_array_equal(q[:, 2], oo.rollout(MODEL, q0, v0, steps=8)[0])


def test_rollouts_without_states_or_steps() -> None:
    q0, v0 = states(3)
    for got, given in zip(oo.rollout(MODEL, q0, v0, steps=0), (q0, v0), strict=True):
        np.testing.assert_allclose(got, given, rtol=0, atol=1e-15)
    q, v = oo.rollout(MODEL, q0[:0], v0[:0], steps=5)
    assert q.shape == (0, MODEL.nq) and v.shape == (0, MODEL.nv)


def test_a_state_that_diverges_is_an_error() -> None:
    q0, v0 = states(5)
    tau = np.zeros((5, 20, 7))
    tau[3, 4:] = 1e200
    with pytest.raises(SimulationError, match="diverged"):
        oo.rollout(MODEL, q0, v0, steps=20, tau=tau)


@pytest.mark.parametrize("alone", ["controller", "reference"])
def test_a_controller_or_a_reference_alone_is_rejected(alone: str) -> None:
    with pytest.raises(ControlError, match="is given, but no"):
        oo.rollout(MODEL, *states(2), steps=5, **{alone: law()[alone]})
