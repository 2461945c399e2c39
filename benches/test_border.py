"""Benches of calls from Python, with pytest-benchmark.

``make bench-rust`` runs them; ``make test`` does not.

Fixed: the bundled humanoid, random states, arrays of float64, one thread. Varied: the function, the number of
states (one or a thousand), the column of a run that is read, and, for loading, the number of links. The
algorithms themselves are timed in Rust. The functions of the group ``call`` do almost nothing, so their time
is that of a call.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.tools.validation.trees import random_tree, urdf

MODEL = oo.robots.load("humanoid_torso")
RNG = np.random.default_rng(1)
ROWS = 1000


def states(count: int) -> tuple[Any, Any, Any]:
    q = RNG.uniform(-1.0, 1.0, (count, MODEL.nq))
    q[:, 3:7] /= np.linalg.norm(q[:, 3:7], axis=1, keepdims=True)
    return q, RNG.uniform(-1.0, 1.0, (count, MODEL.nv)), RNG.uniform(-1.0, 1.0, (count, MODEL.nv))


Kernel = Callable[..., Any]

KERNELS: dict[str, Kernel] = {
    "frame_pose": lambda q, v, a, **k: MODEL.frame_pose(q, "tool", **k),
    "frame_jacobian": lambda q, v, a, **k: MODEL.frame_jacobian(q, "tool", **k),
    "mass_matrix": lambda q, v, a, **k: MODEL.mass_matrix(q, **k),
    "bias_forces": lambda q, v, a, **k: MODEL.bias_forces(q, v, **k),
    "inverse_dynamics": lambda q, v, a, **k: MODEL.inverse_dynamics(q, v, a, **k),
    "forward_dynamics": lambda q, v, a, **k: MODEL.forward_dynamics(q, v, a, **k),
    "momentum": lambda q, v, a, **k: MODEL.momentum(q, v, **k),
    "free_floating": lambda q, v, a, **k: MODEL.free_floating(q, v, "tool", **k),
}


@pytest.mark.benchmark(group="call")
def test_call_of_a_trivial_kernel(benchmark: Any) -> None:
    # centre of mass of a rigid body: two arrays and a few operations
    model = oo.Model.rigid_body(1.0, np.eye(3))
    benchmark(model.center_of_mass, model.neutral())


@pytest.mark.benchmark(group="call")
def test_call_without_an_argument(benchmark: Any) -> None:
    benchmark(MODEL.neutral)


@pytest.mark.benchmark(group="load")
@pytest.mark.parametrize("links", [12, 75])
def test_loading_a_urdf(benchmark: Any, links: int) -> None:
    benchmark(oo.Model.from_urdf_string, urdf(random_tree(75, links, rotors=False)))


@pytest.mark.benchmark(group="one state")
@pytest.mark.parametrize("name", KERNELS)
def test_one_state(benchmark: Any, name: str) -> None:
    q, v, a = (x[0] for x in states(1))
    benchmark(KERNELS[name], q, v, a)


@pytest.mark.benchmark(group="one state from a list")
def test_one_state_from_a_list(benchmark: Any) -> None:
    q = states(1)[0][0].tolist()
    benchmark(MODEL.mass_matrix, q)


@pytest.mark.benchmark(group=f"{ROWS} states, one thread")
@pytest.mark.parametrize("name", KERNELS)
def test_a_batch(benchmark: Any, name: str) -> None:
    batch = states(ROWS)
    benchmark(KERNELS[name], *batch, threads=1)


@pytest.fixture(scope="module")
def trace() -> oo.Trace:
    return oo.Simulation(MODEL, MODEL.neutral(), np.full(MODEL.nv, 0.1)).run(10.0)


@pytest.mark.benchmark(group="views of 10 001 rows")
@pytest.mark.parametrize("column", ["time", "q", "momentum"])
def test_a_column(benchmark: Any, trace: oo.Trace, column: str) -> None:
    assert len(trace) == 10_001
    benchmark(getattr, trace, column)


@pytest.mark.benchmark(group="runs of 1000 steps")
@pytest.mark.parametrize("controller", ["none", "native", "python"])
def test_a_run(benchmark: Any, controller: str) -> None:
    q = MODEL.neutral()
    q[7:] = [0.5342, -2.341, -2.0077, -2.2249, -2.2693, -0.1342, -0.1974]
    zero = np.zeros(7)

    class Passive(oo.Controller):
        def update(self, t: float, state: Any) -> Any:
            return zero

    laws: dict[str, Any] = {
        "none": {},
        "native": {
            "controller": oo.ComputedTorque(MODEL, "tool"),
            "reference": oo.Hold(MODEL.frame_pose(q, "tool")),
        },
        "python": {"controller": Passive()},
    }
    simulation = oo.Simulation(MODEL, q, np.zeros(MODEL.nv), record_every=1000, **laws[controller])
    benchmark(simulation.run, 1.0)


@pytest.mark.benchmark(group="rollouts of 64 states by 100 steps, one thread")
def test_a_rollout(benchmark: Any) -> None:
    q, v, _ = states(64)
    benchmark(oo.rollout, MODEL, q, v, steps=100, time_step=1e-3, threads=1)
