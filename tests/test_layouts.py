"""Layout converters: round trips of batches, closed forms, invalid input. `oracles/` tests the engines."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from border import Bad, check

import onorbit_rs as oo
from onorbit_rs import layouts

MODEL = oo.robots.load("humanoid_dual_arm")
RNG = np.random.default_rng(1)
Q = RNG.uniform(-3.0, 3.0, (5, MODEL.nq))
Q[:, 3:7] /= np.linalg.norm(Q[:, 3:7], axis=1, keepdims=True)
V = RNG.uniform(-3.0, 3.0, (5, MODEL.nv))
NAMES = [str(name) for name in RNG.permutation(MODEL.joint_names)]
ENGINES = ("pinocchio", "mujoco", "drake", "rbdl", "spart")


def there(engine: str, *arguments: Any, **known: Any) -> Any:
    return getattr(layouts, f"to_{engine}")(MODEL, *arguments, **known)


def back(engine: str, *arguments: Any, **known: Any) -> Any:
    return getattr(layouts, f"from_{engine}")(MODEL, *arguments, **known)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("names", [None, NAMES], ids=["our order", "shuffled"])
def test_round_trips_restore_the_state(engine: str, names: list[str] | None) -> None:
    q, v = back(engine, *there(engine, Q, V, names), names)
    sign = np.sign(
        np.sum(q[:, 3:7] * Q[:, 3:7], axis=1, keepdims=True)
    )  # a matrix does not determine the quaternion's sign
    q[:, 3:7] *= sign
    np.testing.assert_allclose(q, Q, atol=1e-14)
    np.testing.assert_allclose(v, V, atol=1e-14)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_batch_equals_its_single_states(engine: str) -> None:
    def flat(result: Any) -> list[Any]:
        return [array for part in result for array in (part if isinstance(part, tuple) else (part,))]

    batch = flat(there(engine, Q, V, NAMES))
    single = flat(there(engine, Q[2], V[2], NAMES))
    for many, one in zip(batch, single, strict=True):
        np.testing.assert_array_equal(many[2], one)
    empty = flat(there(engine, Q[:0], V[:0], NAMES))
    assert all(array.shape[0] == 0 for array in empty)


def test_closed_form() -> None:
    """A quarter turn about z at p, with expected values computed by hand."""
    body = oo.Model.rigid_body(2.0, np.eye(3))
    half = np.sqrt(0.5)
    q, v = [1, 2, 3, 0, 0, half, half], [1, 0, 0, 0, 0.5, 0]  # forward along body x, which is W's y
    expected = {
        "pinocchio": ([1, 2, 3, 0, 0, half, half], [1, 0, 0, 0, 0.5, 0]),
        "mujoco": ([1, 2, 3, half, 0, 0, half], [0, 1, 0, 0, 0.5, 0]),
        "drake": ([half, 0, 0, half, 1, 2, 3], [-0.5, 0, 0, 0, 1, 0]),
        "rbdl": ([1, 2, 3, 0, 0, half, half], [0, 1, 0, 0, 0.5, 0]),
    }
    for engine, (theirs_q, theirs_v) in expected.items():
        got_q, got_v = getattr(layouts, f"to_{engine}")(body, q, v)
        np.testing.assert_allclose(got_q, theirs_q, atol=1e-15, err_msg=engine)
        np.testing.assert_allclose(got_v, theirs_v, atol=1e-15, err_msg=engine)
    # SPART: a centre of mass 0.2 m along body x moves with v_W + R (w × c)
    (r0_matrix, r0, _), (u0, _) = layouts.to_spart(body, q, v, base_com=[0.2, 0, 0])
    np.testing.assert_allclose(r0_matrix, [[0, -1, 0], [1, 0, 0], [0, 0, 1]], atol=1e-15)
    np.testing.assert_allclose(r0, [1, 2.2, 3], atol=1e-15)
    np.testing.assert_allclose(u0, [0, 0.5, 0, 0, 1, -0.1], atol=1e-15)


def test_unbounded_joints_are_cosine_and_sine() -> None:
    wrapped = NAMES[:3]
    q, v = there("pinocchio", Q, V, NAMES, unbounded=wrapped)
    assert q.shape == (5, MODEL.nq + 3)
    first = Q[:, 7 + list(MODEL.joint_names).index(NAMES[0])]
    np.testing.assert_allclose(q[:, 7:9], np.stack([np.cos(first), np.sin(first)], axis=1), atol=1e-16)
    again, _ = back("pinocchio", q, v, NAMES, unbounded=wrapped)
    np.testing.assert_allclose(again, Q, atol=1e-14)


class NoBase:
    """A MuJoCo model whose first joint is a hinge."""

    jnt_qposadr = (0,)
    jnt_type = (3,)


TURNED = np.concatenate([Q[0][:6], [Q[0][6] + 0.5], Q[0][7:]])
BAD: dict[str, Bad] = {
    "q too short": Bad(lambda: there("mujoco", Q[0][:-1], V[0]), "ShapeError", ("q", "21")),
    "v too long": Bad(lambda: there("drake", Q[0], np.append(V[0], 0)), "ShapeError", ("v", "20")),
    "three axes": Bad(lambda: there("rbdl", Q[None], V[None]), "ShapeError", ("q", "batch")),
    "batches differ": Bad(lambda: there("rbdl", Q, V[:3]), "ShapeError", ("batch sizes differ", "5", "3")),
    "a batch and one": Bad(lambda: there("rbdl", Q, V[0]), "ShapeError", ("single",)),
    "NaN": Bad(lambda: there("spart", Q[0] * np.nan, V[0]), "InputError", ("q", "NaN")),
    "text": Bad(lambda: there("spart", "q", V[0]), "DtypeError", ("q", "numbers")),
    "no unit quaternion": Bad(lambda: there("mujoco", TURNED, V[0]), "InputError", ("norm", "must be 1")),
    "quaternion of the other layout without unit length": Bad(
        lambda: back("mujoco", np.ones(MODEL.nq), V[0]), "InputError", ("qpos", "is 2", "must be 1")
    ),
    "no cosine and sine": Bad(
        lambda: back("pinocchio", [*Q[0][:7], 3.0, 4.0, *Q[0][8:]], V[0], unbounded=[MODEL.joint_names[0]]),
        "InputError",
        ("cosine and sine", "is 5", "must be 1"),
    ),
    "no rotation": Bad(
        lambda: back("spart", (2 * np.eye(3), np.zeros(3), Q[0][7:]), (V[0][:6], V[0][6:])),
        "InputError",
        ("R0", "rotation"),
    ),
    "a mirror": Bad(
        lambda: back("spart", (-np.eye(3), np.zeros(3), Q[0][7:]), (V[0][:6], V[0][6:])),
        "InputError",
        ("R0",),
    ),
    "unknown joint": Bad(
        lambda: there("rbdl", Q[0], V[0], ["left_joint_11", *NAMES[1:]]),
        "FrameError",
        ("left_joint_11", "did you mean"),
        {"kind": "joint"},
    ),
    "a joint missing": Bad(
        lambda: there("rbdl", Q[0], V[0], NAMES[1:]), "InputError", ("does not contain", NAMES[0])
    ),
    "a joint twice": Bad(
        lambda: there("rbdl", Q[0], V[0], [*NAMES, NAMES[0]]), "InputError", ("more than once",)
    ),
    "names as text": Bad(lambda: there("rbdl", Q[0], V[0], "joint"), "DtypeError", ("list",)),
    "unbounded names an unknown joint": Bad(
        lambda: there("pinocchio", Q[0], V[0], unbounded=["x"]), "InputError", ("unbounded", "'x'")
    ),
    "their base is fixed": Bad(
        lambda: there("mujoco", Q[0], V[0], NoBase()), "InputError", ("floating base",)
    ),
    "the centre of mass of SPART": Bad(
        lambda: there("spart", Q[0], V[0], base_com=[[0, 0, 0]]), "InputError", ("base_com",)
    ),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_input(name: str) -> None:
    check(BAD[name])
