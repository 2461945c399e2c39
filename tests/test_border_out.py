"""``out=``: results are written to the caller's arrays with equal bits; unsuitable arrays are rejected."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from border import NAN, Bad, check
from test_border_batches import FRAME, KERNELS, MODEL, NQ, NV, states

import onorbit_rs as oo

WHOLE = [name for name in KERNELS if not set(".[") & set(name)]  # the others are parts of a result
PARTS = ("inertia", "bias", "external", "jacobian", "drift")
Q, V, A = states(20)


@pytest.mark.parametrize("count", [1, 7, 8, 200])
@pytest.mark.parametrize("name", WHOLE)
def test_a_batch_is_written_to_out(name: str, count: int) -> None:
    batch = states(count)
    fresh = KERNELS[name](*batch)
    out = np.full_like(fresh, NAN)
    assert KERNELS[name](*batch, out=out) is out
    np.testing.assert_array_equal(out, fresh)
    KERNELS[name](*(x[::-1] for x in batch), out=out)  # overwrites the first result
    assert count == 1 or not np.array_equal(out, fresh)


def test_one_state_is_written_to_out() -> None:
    out = np.empty(NV)
    assert MODEL.forward_dynamics(Q[3], V[3], A[3], out=out) is out
    np.testing.assert_array_equal(out, MODEL.forward_dynamics(Q[3], V[3], A[3]))
    energy = np.empty(())
    assert MODEL.kinetic_energy(Q[3], V[3], out=energy) is energy
    assert energy == MODEL.kinetic_energy(Q[3], V[3])


def test_a_reduced_model_is_overwritten() -> None:
    ff = MODEL.free_floating(Q, V, FRAME)
    kept = {name: getattr(ff, name) for name in PARTS}
    other = MODEL.free_floating(Q[::-1], V[::-1], FRAME)
    assert MODEL.free_floating(Q[::-1], V[::-1], FRAME, out=ff) is ff
    for name, array in kept.items():
        assert getattr(ff, name) is array
        np.testing.assert_array_equal(array, getattr(other, name))


@pytest.mark.parametrize("record_every", [None, 2])
def test_a_rollout_is_written_to_out(record_every: int | None) -> None:
    how: dict[str, Any] = {"steps": 5, "record_every": record_every}
    q, v = oo.rollout(MODEL, Q, V, **how)
    out = np.full_like(q, NAN), np.full_like(v, NAN)
    to_q, to_v = oo.rollout(MODEL, Q, V, out=out, **how)
    assert to_q is out[0]
    assert to_v is out[1]
    np.testing.assert_array_equal(to_q, q)
    np.testing.assert_array_equal(to_v, v)


def test_a_slice_of_a_three_dimensional_array_is_accepted() -> None:
    blocks = np.full((3, len(Q), NV), NAN)
    MODEL.forward_dynamics(Q, V, A, out=blocks[1])
    np.testing.assert_array_equal(blocks[1], MODEL.forward_dynamics(Q, V, A))
    assert np.isnan(blocks[::2]).all()


def into(out: Any) -> Any:
    return MODEL.forward_dynamics(Q, V, A, out=out)


def locked() -> Any:
    out = np.empty((20, NV))
    out.flags.writeable = False
    return out


def twins() -> tuple[Any, Any]:
    """Returns two unrelated array objects on the same memory."""
    memory = bytearray(8 * 20 * NV)
    made = (np.frombuffer(memory, float).reshape(20, NV) for _ in range(2))
    return next(made), next(made)


def onto(first: Any, second: Any) -> Any:
    first[:] = A
    return MODEL.forward_dynamics(Q, V, first, out=second)


def roll(**how: Any) -> Any:
    return oo.rollout(MODEL, Q, V, steps=2, **how)


def overlapping() -> tuple[Any, Any]:
    """Returns arrays for the end of a rollout that overlap by ten numbers."""
    room = np.empty(20 * (NQ + NV) - 10)
    return room[: 20 * NQ].reshape(20, NQ), room[-20 * NV :].reshape(20, NV)


def reduced(count: int) -> Any:
    return MODEL.free_floating(*states(count)[:2], FRAME)


NAME = {"name": "out"}
SHAPE = f"(20, {NV})"
BAD: dict[str, Bad] = {
    "rows": Bad(lambda: into(np.empty((19, NV))), "ShapeError", (f"(19, {NV})", SHAPE), NAME),
    "columns": Bad(lambda: into(np.empty((20, NQ))), "ShapeError", (f"(20, {NQ})", SHAPE), NAME),
    "flat": Bad(lambda: into(np.empty(20 * NV)), "ShapeError", (SHAPE,), NAME),
    "Fortran's order": Bad(lambda: into(np.empty((20, NV), order="F")), "ShapeError", ("contiguous",), NAME),
    "strided": Bad(lambda: into(np.empty((20, 2 * NV))[:, ::2]), "ShapeError", ("contiguous",), NAME),
    "backwards": Bad(lambda: into(np.empty((20, NV))[::-1]), "ShapeError", ("contiguous",), NAME),
    "single precision": Bad(lambda: into(np.empty((20, NV), "f4")), "DtypeError", ("float64",), NAME),
    "other bytes": Bad(lambda: into(np.empty((20, NV), ">f8")), "DtypeError", ("float64",), NAME),
    "a list": Bad(lambda: into([[0.0] * NV] * 20), "DtypeError", ("float64",), NAME),
    "read-only": Bad(lambda: into(locked()), "InputError", ("read-only",), NAME),
    "an input": Bad(lambda: MODEL.forward_dynamics(Q, V, A, out=A), "InputError", ("in use",), NAME),
    "part of an input": Bad(
        lambda: MODEL.forward_dynamics(Q[:10], V[:10], A[:10], out=A[5:15]), "InputError", ("in use",), NAME
    ),
    "an input's memory": Bad(lambda: onto(*twins()), "InputError", ("shares memory",), NAME),
    "reduced model with arrays of another call": Bad(
        lambda: MODEL.free_floating(Q, V, FRAME, out=reduced(19)), "ShapeError", ("19",), {"name": "out[0]"}
    ),
    "no pair": Bad(
        lambda: roll(out=np.empty((20, NQ))),
        "InputError", ("pair", f"(20, {NQ})", SHAPE), NAME,
    ),
    "outputs that overlap": Bad(
        lambda: roll(out=overlapping()), "InputError", ("in use",), {"name": "out[1]"},
    ),
    "a rollout's end for its rows": Bad(
        lambda: roll(record_every=1, out=(np.empty((20, NQ)), np.empty((20, NV)))),
        "ShapeError", (f"(20, {NQ})", f"(20, 3, {NQ})"), {"name": "out[0]"},
    ),
    "a rollout onto its start": Bad(
        lambda: roll(out=(Q, np.empty((20, NV)))), "InputError", ("in use",),
        {"name": "out[0]"},
    ),
}  # fmt: skip


@pytest.mark.parametrize("what", BAD)
def test_unsuitable_arrays_are_rejected(what: str) -> None:
    before = Q.copy(), V.copy(), A.copy()
    check(BAD[what])
    for now, then in zip((Q, V, A), before, strict=True):
        np.testing.assert_array_equal(now, then)


# Wrenches, one for all states or one for each


WITH_WRENCHES: dict[str, Callable[[Any, int | slice], Any]] = {
    "bias_forces": lambda f, k: MODEL.bias_forces(Q[k], V[k], external={FRAME: f}),
    "inverse_dynamics": lambda f, k: MODEL.inverse_dynamics(Q[k], V[k], A[k], external={FRAME: f}),
    "forward_dynamics": lambda f, k: MODEL.forward_dynamics(Q[k], V[k], A[k], external={FRAME: f}),
    "free_floating": lambda f, k: MODEL.free_floating(Q[k], V[k], FRAME, external={FRAME: f}).external,
}
FORCES = np.random.default_rng(9).uniform(-1.0, 1.0, (20, 6))


@pytest.mark.parametrize("name", WITH_WRENCHES)
def test_each_state_can_have_a_different_wrench(name: str) -> None:
    kernel = WITH_WRENCHES[name]
    together = kernel(FORCES, slice(None))
    alone = np.array([kernel(FORCES[k], k) for k in range(20)])
    limit = 1e-14 * np.abs(alone).max()  # one or two roundings
    assert np.abs(together - alone).max() <= limit
    np.testing.assert_array_equal(
        kernel(FORCES[0], slice(None)), kernel(np.tile(FORCES[0], (20, 1)), slice(None))
    )
    # negative control: wrenches shifted by one state
    assert np.abs(kernel(np.roll(FORCES, 1, axis=0), slice(None)) - alone).max() > 1e6 * limit


def test_common_and_individual_wrenches_can_be_combined() -> None:
    both = MODEL.forward_dynamics(Q, V, A, external={FRAME: FORCES, "torso": FORCES[0]})
    each = MODEL.forward_dynamics(Q[7], V[7], A[7], external={FRAME: FORCES[7], "torso": FORCES[0]})
    np.testing.assert_allclose(both[7], each, rtol=1e-12)


@pytest.mark.parametrize(
    ("given", "k"), [((19, 6), slice(None)), ((20, 5), slice(None)), ((1, 20, 6), slice(None)), ((20, 6), 3)]
)
def test_wrenches_for_another_number_of_states_are_rejected(given: Any, k: Any) -> None:
    call = lambda: WITH_WRENCHES["forward_dynamics"](np.zeros(given), k)  # noqa: E731
    check(
        Bad(call, "ShapeError", ("external wrench", "(6,)"), {"name": "external wrench", "got": list(given)})
    )


def test_a_non_finite_wrench_is_reported_with_its_state() -> None:
    forces = FORCES.copy()
    forces[13, 2] = NAN
    call = lambda: WITH_WRENCHES["bias_forces"](forces, slice(None))  # noqa: E731
    check(Bad(call, "InputError", ("external wrench", "NaN", "state 13"), {"name": "external wrench"}))
