"""Batches through Python: one state per row, any layout and dtype, any number of threads, no GIL."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.exceptions import ConvergenceError

MODEL = oo.robots.load("humanoid_dual_arm")
NQ, NV = MODEL.nq, MODEL.nv
EXTERNAL = {MODEL.frame_names[-1]: np.array([1.0, -2.0, 0.5, 0.1, 0.2, -0.3]), "torso": np.ones(6)}
FRAME = MODEL.frame_names[-1]

Kernel = Callable[..., Any]


def reduced(name: str) -> Kernel:
    return lambda q, v, a, **k: getattr(MODEL.free_floating(q, v, FRAME, external=EXTERNAL, **k), name)


def derivative(kernel: str, place: int) -> Kernel:
    return lambda q, v, a, **k: getattr(MODEL, kernel)(q, v, a, external=EXTERNAL, **k)[place]


def reduced_derivative(name: str) -> Kernel:
    return lambda q, v, a, **k: getattr(
        MODEL.free_floating_derivatives(q, v, a[..., 6:], FRAME, external=EXTERNAL, **k), name
    )


KERNELS: dict[str, Kernel] = {
    "frame_pose": lambda q, v, a, **k: MODEL.frame_pose(q, FRAME, **k),
    "frame_velocity": lambda q, v, a, **k: MODEL.frame_velocity(q, v, FRAME, **k),
    "frame_jacobian": lambda q, v, a, **k: MODEL.frame_jacobian(q, FRAME, **k),
    "mass_matrix": lambda q, v, a, **k: MODEL.mass_matrix(q, **k),
    "bias_forces": lambda q, v, a, **k: MODEL.bias_forces(q, v, **k),
    "inverse_dynamics": lambda q, v, a, **k: MODEL.inverse_dynamics(q, v, a, external=EXTERNAL, **k),
    "forward_dynamics": lambda q, v, a, **k: MODEL.forward_dynamics(q, v, a, external=EXTERNAL, **k),
    "momentum": lambda q, v, a, **k: MODEL.momentum(q, v, **k),
    "kinetic_energy": lambda q, v, a, **k: MODEL.kinetic_energy(q, v, **k),
    "center_of_mass": lambda q, v, a, **k: MODEL.center_of_mass(q, **k),
    "integrate": lambda q, v, a, **k: MODEL.integrate(q, v, **k),
    "difference": lambda q, v, a, **k: MODEL.difference(q, MODEL.integrate(q, a), **k),
} | {f"free_floating.{name}": reduced(name) for name in ("inertia", "bias", "external", "jacobian", "drift")}
KERNELS |= {
    f"{kernel}.{place}": derivative(kernel, place)
    for kernel in ("inverse_dynamics_derivatives", "forward_dynamics_derivatives")
    for place in range(3)
} | {
    f"free_floating_derivatives.{name}": reduced_derivative(name)
    for name in ("torque_dq", "torque_dv", "acceleration_dq", "acceleration_dv", "velocity_dq")
}


def states(count: int, seed: int = 0) -> tuple[Any, Any, Any]:
    rng = np.random.default_rng(seed)
    q = rng.uniform(-2.0, 2.0, (count, NQ))
    q[:, 3:7] /= np.linalg.norm(q[:, 3:7], axis=1, keepdims=True)
    return q, rng.uniform(-1.0, 1.0, (count, NV)), rng.uniform(-1.0, 1.0, (count, NV))


@pytest.mark.parametrize("count", [1, 2, 5, 8, 63, 64, 65, 150])
@pytest.mark.parametrize("name", KERNELS)
def test_a_batch_equals_its_single_states(name: str, count: int) -> None:
    q, v, a = states(count)
    together = KERNELS[name](q, v, a)
    alone = np.array([KERNELS[name](*row) for row in zip(q, v, a, strict=True)])
    assert together.shape == alone.shape
    # SIMD lanes do the same operations in the same order; 1e-14 is one or two roundings
    assert np.abs(together - alone).max() <= 1e-14 * np.abs(alone).max()


@pytest.mark.parametrize("name", KERNELS)
def test_the_bits_do_not_depend_on_the_number_of_threads(name: str) -> None:
    batch = states(333)
    once = KERNELS[name](*batch, threads=1)
    for threads in (2, 3, 8, None):
        np.testing.assert_array_equal(KERNELS[name](*batch, threads=threads), once)


@pytest.mark.parametrize("name", KERNELS)
def test_the_bits_of_a_state_do_not_depend_on_its_neighbours(name: str) -> None:
    q, v, a = states(97)
    whole = KERNELS[name](q, v, a)
    np.testing.assert_array_equal(KERNELS[name](q[40:], v[40:], a[40:]), whole[40:])
    q[3, 8] = 2e5  # an angle for which sines are computed one by one
    np.testing.assert_array_equal(np.delete(KERNELS[name](q, v, a), 3, axis=0), np.delete(whole, 3, axis=0))


@pytest.mark.parametrize("name", KERNELS)
def test_a_batch_without_states_is_empty(name: str) -> None:
    nothing = KERNELS[name](*states(0))
    one = KERNELS[name](*states(1))
    assert nothing.shape == (0, *one.shape[1:])


def test_layouts_and_dtypes_do_not_change_the_values() -> None:
    q, v, _ = states(12)
    expected = MODEL.bias_forces(q, v)
    np.testing.assert_array_equal(MODEL.bias_forces(np.asfortranarray(q), np.asfortranarray(v)), expected)
    wide = np.zeros((24, 2 * NQ))
    wide[::2, 1::2] = q
    strided = wide[::2, 1::2]
    assert not strided.flags.c_contiguous
    np.testing.assert_array_equal(MODEL.bias_forces(strided, v), expected)
    np.testing.assert_array_equal(MODEL.bias_forces(q[::-1], v[::-1]), expected[::-1])
    np.testing.assert_array_equal(MODEL.bias_forces(strided[3], v[3]), MODEL.bias_forces(q[3], v[3]))
    np.testing.assert_array_equal(MODEL.bias_forces(q.tolist(), v.tolist()), expected)
    q.flags.writeable = False
    np.testing.assert_array_equal(MODEL.bias_forces(q, v), expected)
    single = q.astype("f4")
    single[:, 3:7] = [0, 0, 0, 1]  # in single precision the norm is rarely within 1e-6 of one
    np.testing.assert_array_equal(MODEL.bias_forces(single, v), MODEL.bias_forces(single.astype(float), v))
    whole = np.zeros((12, NV), int)
    np.testing.assert_array_equal(MODEL.bias_forces(q, whole), MODEL.bias_forces(q, whole.astype(float)))


def test_inputs_are_never_written() -> None:
    q, v, a = states(70)
    q[:, 3:7] *= 1 + 5e-7  # normalised in a copy
    before = q.copy(), v.copy(), a.copy()
    for kernel in KERNELS.values():
        kernel(q, v, a)
    for now, then in zip((q, v, a), before, strict=True):
        np.testing.assert_array_equal(now, then)


def test_results_are_new_and_writable_arrays() -> None:
    q, v, _ = states(3)
    first, second = MODEL.bias_forces(q, v), MODEL.bias_forces(q, v)
    first[:] = 0.0
    assert not np.shares_memory(first, second) and np.abs(second).max() > 0
    energy = MODEL.kinetic_energy(q[0], v[0])
    assert isinstance(energy, float) and energy == MODEL.kinetic_energy(q, v)[0]  # type: ignore[index]


# The GIL


@contextmanager
def counting() -> Iterator[Callable[[], int]]:
    """Runs another Python thread that counts."""
    ticks, done = [0], threading.Event()

    def count() -> None:
        while not done.is_set():
            ticks[0] += 1
            time.sleep(1e-4)

    thread = threading.Thread(target=count)
    thread.start()
    try:
        yield lambda: ticks[0]
    finally:
        done.set()
        thread.join()


def progress_during(work: Callable[[], object]) -> tuple[int, float]:
    with counting() as ticks:
        time.sleep(0.01)
        before, begun = ticks(), time.perf_counter()
        work()
        return ticks() - before, time.perf_counter() - begun


def test_other_threads_continue_during_a_batch() -> None:
    q, v, a = states(40_000)
    ticked, wall = progress_during(lambda: MODEL.forward_dynamics(q, v, a, threads=1))
    assert ticked > 10, f"{ticked} ticks in {wall:.3f} s"


def test_other_threads_continue_during_a_run() -> None:
    simulation = oo.Simulation(MODEL, MODEL.neutral(), np.full(NV, 0.1), record_every=1000)
    ticked, wall = progress_during(lambda: simulation.run(20.0))
    assert ticked > 10, f"{ticked} ticks in {wall:.3f} s"


def test_other_threads_continue_during_a_rollout() -> None:
    q, v, _ = states(64)
    ticked, wall = progress_during(lambda: oo.rollout(MODEL, q, v, steps=2000, time_step=1e-4, threads=1))
    assert ticked > 10, f"{ticked} ticks in {wall:.3f} s"


def test_one_model_serves_many_threads() -> None:
    q, v, a = states(50)
    expected = MODEL.forward_dynamics(q, v, a)
    wrong: list[int] = []

    def work() -> None:
        for _ in range(40):
            for k in range(50):
                if not np.allclose(MODEL.forward_dynamics(q[k], v[k], a[k]), expected[k], rtol=1e-9):
                    wrong.append(k)

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not wrong


FORK = """
import os, signal, numpy as np, onorbit_rs as oo
model = oo.robots.load("humanoid_torso")
q = np.tile(model.neutral(), (4096, 1))
v = np.ones((4096, model.nv))
before = model.bias_forces(q, v)
child = os.fork()
if child == 0:
    signal.alarm(20)  # ends a child that waits for threads it does not have
    os._exit(0 if np.array_equal(model.bias_forces(q, v), before) else 1)
raise SystemExit(os.waitpid(child, 0)[1])
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="the system has no fork")
def test_a_forked_child_starts_new_threads() -> None:
    subprocess.run([sys.executable, "-c", FORK], check=True, timeout=60)


# Instruction sets

PROGRAM = """
import sys, numpy as np
sys.path.insert(0, {folder!r})
import onorbit_rs as oo, test_border_batches as here
batch = here.states(30)
out = {{name: kernel(*batch) for name, kernel in here.KERNELS.items()}}
out |= {{name + " alone": kernel(*(x[3] for x in batch)) for name, kernel in here.KERNELS.items()}}
simulation = oo.Simulation(here.MODEL, batch[0][0], batch[1][0])
out["run"] = simulation.run(0.5).q
out["instruction_set"] = oo.build_info()["instruction_set"]
np.savez(sys.argv[1], **out)
"""


def test_an_older_processor_gets_the_same_numbers(tmp_path: Any) -> None:
    results = {}
    for level in ("", "baseline"):
        file = tmp_path / f"{level or 'best'}.npz"
        environment = dict(os.environ) | {"ONORBIT_INSTRUCTION_SET": level}
        program = PROGRAM.format(folder=os.path.dirname(__file__))  # noqa: PTH120
        subprocess.run([sys.executable, "-c", program, str(file)], env=environment, check=True, timeout=120)
        with np.load(file) as stored:
            results[level] = dict(stored)
    best, baseline = results[""], results["baseline"]
    assert baseline.pop("instruction_set") == "baseline"
    if best.pop("instruction_set") == "baseline":
        pytest.skip("this processor has no newer instruction set")
    different = 0
    for name, value in baseline.items():
        off = np.abs(value - best[name]).max() / max(np.abs(value).max(), 1e-300)
        assert off < 1e-12, (name, off)
        different += off > 0
    assert different > 3, "both ran the same instructions"


@pytest.mark.parametrize("count", [None, 1, 9])
def test_numbers_whose_products_overflow_are_reported(count: int | None) -> None:
    """Finite inputs must not silently give NaN."""
    model = oo.robots.load("humanoid_torso")
    q, v = model.neutral(), np.full(model.nv, 1e200)
    if count is not None:
        q, v = np.tile(q, (count, 1)), np.tile(v, (count, 1))
    for kernel in (
        lambda: model.bias_forces(q, v),
        lambda: model.inverse_dynamics(q, v, v),
        lambda: model.free_floating(q, v, "tool"),
        lambda: model.kinetic_energy(q, v),
        lambda: model.integrate(q, v),
    ):
        with pytest.raises(ConvergenceError, match="state 0 are so large that their products overflow"):
            kernel()
    assert np.isfinite(model.momentum(q, v)).all()  # this kernel has no products of large numbers
    assert np.isfinite(model.bias_forces(q, v * 1e-140)).all()
