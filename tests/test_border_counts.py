"""Counts through Python: integers of every type are accepted, other values are rejected."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from border import MODEL, Bad, Q, V, check, simulation

import onorbit_rs as oo

COUNTS: dict[str, tuple[str, Callable[[Any], Any]]] = {
    "threads of a kernel": ("threads", lambda n: MODEL.mass_matrix(Q[None], threads=n)),
    "threads of a rollout": ("threads", lambda n: oo.rollout(MODEL, Q[None], V[None], steps=1, threads=n)),
    "threads of orbits": (
        "threads",
        lambda n: oo.propagate([oo.Kepler(semi_major_axis=7e6)], [0.0], threads=n),
    ),
    "steps": ("steps", lambda n: oo.rollout(MODEL, Q[None], V[None], steps=n)),
    "rows of a rollout": (
        "record_every",
        lambda n: oo.rollout(MODEL, Q[None], V[None], steps=4, record_every=n),
    ),
    "rows of a run": ("record_every", lambda n: simulation(record_every=n)),
    "degree": ("degree", lambda n: oo.GravityField("egm2008", degree=n)),
    "order": ("order", lambda n: oo.GravityField("egm2008", degree=4, order=n)),
    "degree of zonals": ("degree", lambda n: oo.GravityField.zonal(n)),
}


@pytest.mark.parametrize("which", COUNTS)
def test_a_value_that_is_not_an_integer_is_rejected_by_name(which: str) -> None:
    name, call = COUNTS[which]
    for value, got in ((True, "bool"), (np.True_, type(np.True_).__name__), (1.5, "float"), ("2", "str")):
        words = (f"{name} is of type {got}", "whole number")
        check(Bad(lambda value=value: call(value), "DtypeError", words, {"name": name, "got": got}))
    call(2)
    call(np.int64(2))


@pytest.mark.parametrize("which", COUNTS)
def test_very_large_counts_are_rejected(which: str) -> None:
    name, call = COUNTS[which]
    beyond = {"name": name, "expected": 2**63 - 1}
    for value, text in ((2**70, str(2**70)), (-(2**70), f"-{2**70}"), (10**5000, "thousands of digits")):
        words = (f"{name} is", text, str(2**63 - 1))
        check(Bad(lambda value=value: call(value), "InputError", words, beyond | {"got": value}))


def test_more_threads_than_cores_are_accepted() -> None:
    batch = np.tile(Q, (1000, 1))
    np.testing.assert_array_equal(
        MODEL.mass_matrix(batch, threads=2**62), MODEL.mass_matrix(batch, threads=1)
    )


def test_counts_below_the_minimum_are_rejected() -> None:
    check(Bad(lambda: COUNTS["steps"][1](-1), "InputError", ("steps is -1", "at least 0"), {"name": "steps"}))
    rows = COUNTS["rows of a rollout"][1]
    for value in (0, -1):
        words = (f"record_every is {value}", "at least 1 step")
        check(
            Bad(lambda value=value: rows(value), "InputError", words, {"name": "record_every", "got": value})
        )
