"""Invalid arrays: lengths, shapes, dtypes, non-finite numbers, quaternions."""

from __future__ import annotations

import numpy as np
import pytest
from border import CUBE, INF, MODEL, NAN, Bad, Q, V, check, law, link, shape, simulation, with_value

import onorbit_rs as oo

BAD: dict[str, Bad] = {
    # lengths and shapes
    "q too short": Bad(lambda: MODEL.mass_matrix(Q[:-1]), *shape("q", 13, "13", "14")),
    "q too long": Bad(lambda: MODEL.mass_matrix(np.zeros(40)), *shape("q", 40, "40", "14")),
    "q empty": Bad(lambda: MODEL.mass_matrix([]), *shape("q", 0, "14")),
    "q a number": Bad(lambda: MODEL.mass_matrix(1.0), *shape("q", 1, "14")),
    "q of three dimensions": Bad(
        lambda: MODEL.mass_matrix(np.zeros((2, 2, 14))), *shape("q", [2, 2, 14], "(2, 2, 14)", "(B, n)")
    ),
    "v too short": Bad(lambda: MODEL.bias_forces(Q, V[:3]), *shape("v", 3, "3", "13")),
    "tau too short": Bad(lambda: MODEL.forward_dynamics(Q, V, V[6:]), *shape("tau", 7, "7", "13")),
    "a too short": Bad(lambda: MODEL.inverse_dynamics(Q, V, V[6:]), *shape("a", 7, "7", "13")),
    "dv too short": Bad(lambda: MODEL.integrate(Q, V[:2]), "ShapeError", ("2", "13"), {"got": 2}),
    "q2 too short": Bad(lambda: MODEL.difference(Q, Q[:2]), *shape("q2", 2, "2", "14")),
    "batches of two sizes": Bad(
        lambda: MODEL.bias_forces(np.tile(Q, (3, 1)), np.tile(V, (2, 1))), *shape("v", 2, "2", "3")
    ),
    "one q, many v": Bad(
        lambda: MODEL.bias_forces(Q, np.tile(V, (2, 1))), *shape("v", [2, 13], "(2, 13)", "one state (n,)")
    ),
    "many q, one v": Bad(
        lambda: MODEL.bias_forces(np.tile(Q, (2, 1)), V), *shape("v", [13], "(13,)", "a batch (B, n)")
    ),
    "no states of a wrong width": Bad(
        lambda: MODEL.bias_forces(np.zeros((0, 13)), np.zeros((0, 13))), *shape("q", 13, "14")
    ),
    "run's q too short": Bad(lambda: simulation(q=Q[:3]), *shape("q", 3, "3", "14")),
    "run's q a batch of one": Bad(lambda: simulation(q=Q[None]), *shape("q", [1, 14], "(1, 14)", "(14,)")),
    "run's q folded": Bad(lambda: simulation(q=Q.reshape(2, 7)), *shape("q", [2, 7], "(2, 7)", "(14,)")),
    "run's v too long": Bad(lambda: simulation(v=Q), *shape("v", 14, "14", "13")),
    "inertia (2, 2)": Bad(
        lambda: oo.Model.rigid_body(1.0, np.eye(2)), *shape("inertia", [2, 2], "(2, 2)", "(3, 3)")
    ),
    "axis (2,)": Bad(lambda: link(axis=[0, 1]), *shape("axis", [2], "(2,)", "(3,)")),
    "wrench (5,)": Bad(
        lambda: MODEL.forward_dynamics(Q, V, V, external={"tool": np.zeros(5)}),
        *shape("external wrench", [5], "(5,)", "(6,)"),
    ),
    "force (2,)": Bad(lambda: oo.BodyWrench("torso", force=[1, 2]), *shape("force", [2], "(2,)", "(3,)")),
    "r (2,)": Bad(lambda: oo.Kepler.from_state([7e6, 0], [0, 1, 0]), *shape("r", [2], "(2,)", "(3,)")),
    "times (2, 2)": Bad(
        lambda: oo.Kepler(semi_major_axis=7e6).state(np.zeros((2, 2))), *shape("t", [2, 2], "(2, 2)", "(T,)")
    ),
    "pose (3, 3)": Bad(lambda: oo.Hold(CUBE), *shape("pose", [3, 3], "(3, 3)", "(4, 4)")),
    "displacement (2,)": Bad(
        lambda: oo.LineParabola(np.eye(4), displacement=[1, 0], duration=1.0),
        *shape("displacement", [2], "(2,)", "(3,)"),
    ),
    "gains (3,)": Bad(lambda: law(kp=[1, 2, 3]), *shape("kp", [3], "(3,)", "(6, 6)")),
    "gains (6, 5)": Bad(lambda: law(kd=np.zeros((6, 5))), *shape("kd", [6, 5], "(6, 5)", "(6, 6)")),
    # dtypes
    "text": Bad(lambda: MODEL.mass_matrix("hello"), "DtypeError", ("q", "text"), {"expected": "float64"}),
    "an array of text": Bad(lambda: MODEL.mass_matrix(["a"] * 14), "DtypeError", ("<U1",), {"name": "q"}),
    "complex": Bad(
        lambda: MODEL.mass_matrix(Q.astype(complex)), "DtypeError", ("complex128",), {"name": "q"}
    ),
    "objects": Bad(lambda: MODEL.mass_matrix(Q.astype(object)), "DtypeError", ("object",), {"name": "q"}),
    "booleans": Bad(lambda: MODEL.mass_matrix(Q.astype(bool)), "DtypeError", ("bool",), {"name": "q"}),
    "dates": Bad(
        lambda: MODEL.mass_matrix(np.zeros(14, "M8[s]")), "DtypeError", ("datetime64",), {"name": "q"}
    ),
    "None": Bad(lambda: MODEL.mass_matrix(None), "DtypeError", ("q",), {"name": "q"}),  # type: ignore[arg-type]
    "ragged": Bad(lambda: MODEL.mass_matrix([[1, 2], [3]]), "DtypeError", ("rectangular",), {"name": "q"}),
    "integers beyond floats": Bad(
        lambda: MODEL.mass_matrix([10**400] * 14), "DtypeError", ("q",), {"name": "q"}
    ),
    "gains of text": Bad(lambda: law(kp="stiff"), "DtypeError", ("kp", "text"), {"name": "kp"}),
    "times of text": Bad(
        lambda: oo.Kepler(semi_major_axis=7e6).state("noon"), "DtypeError", ("t", "text"), {"name": "t"}
    ),
    "masked entries": Bad(
        lambda: MODEL.mass_matrix(np.ma.masked_array(Q, Q == 1.0)),
        "DtypeError",
        ("q", "masked", "q.filled(x)", "q.compressed()"),
        {"name": "q", "got": "masked entries"},
    ),
    "masked times": Bad(
        lambda: oo.Kepler(semi_major_axis=7e6).state(np.ma.masked_greater([0.0, 1.0, 2.0], 1.5)),
        "DtypeError",
        ("t", "masked"),
        {"name": "t"},
    ),
    "wrenches without frames": Bad(
        lambda: MODEL.forward_dynamics(Q, V, V, external=np.zeros(6)),  # type: ignore[arg-type]
        "DtypeError",
        ("external", "ndarray", "dict", "{'torso': [fx"),
        {"name": "external", "got": "ndarray"},
    ),
    "a frame by number": Bad(lambda: MODEL.frame_pose(Q, 3), "DtypeError", ("int", "name"), {"got": "int"}),  # type: ignore[arg-type]
    "a reference by number": Bad(
        lambda: simulation(reference=3), "DtypeError", ("int", "Hold", "LineParabola"), {"name": "reference"}
    ),
    # non-finite numbers
    "NaN in q": Bad(
        lambda: MODEL.mass_matrix(with_value(8, NAN)), "InputError", ("q", "NaN", "finite"), {"name": "q"}
    ),
    "infinity in q": Bad(
        lambda: MODEL.mass_matrix(with_value(0, INF)), "InputError", ("q", "inf"), {"name": "q", "got": INF}
    ),
    "NaN in v": Bad(lambda: MODEL.bias_forces(Q, V * NAN), "InputError", ("v", "NaN"), {"name": "v"}),
    "NaN in one state of many": Bad(
        lambda: MODEL.mass_matrix(np.array([Q, Q, with_value(9, NAN)])),
        "InputError",
        ("state 2", "NaN"),
        {"name": "q"},
    ),
    "NaN in the run's v": Bad(lambda: simulation(v=V * NAN), "InputError", ("v[0]", "NaN"), {"name": "v"}),
    "infinity in a wrench": Bad(
        lambda: MODEL.inverse_dynamics(Q, V, V, external={"tool": [INF, 0, 0, 0, 0, 0]}),
        "InputError",
        ("external wrench", "inf"),
        {"got": INF},
    ),
    "NaN in an inertia": Bad(lambda: oo.Model.rigid_body(1.0, CUBE * NAN), "InputError", ("inertia", "NaN")),
    "NaN in a force": Bad(lambda: oo.BodyWrench("torso", force=[NAN, 0, 0]), "InputError", ("force", "NaN")),
    "NaN in a pose": Bad(lambda: oo.Hold(np.full((4, 4), NAN)), "InputError", ("pose", "NaN")),
    "NaN in an axis": Bad(lambda: link(axis=[0, 0, NAN]), "InputError", ("axis", "NaN")),
    "NaN as a time": Bad(lambda: oo.Kepler(semi_major_axis=7e6).state(NAN), "OrbitError", ("NaN", "finite")),
    "NaN among times": Bad(
        lambda: oo.Kepler(semi_major_axis=7e6).lvlh([0, NAN]), "OrbitError", ("NaN", "finite")
    ),
    "infinite semi-major axis": Bad(
        lambda: oo.Kepler(semi_major_axis=INF), "OrbitError", ("inf", "finite"), {"got": INF}
    ),
    # the quaternion
    "quaternion 2e-6 too long": Bad(
        lambda: MODEL.mass_matrix(with_value(6, 1 + 2e-6)),
        "InputError",
        ("1.000002", "1e-6", "normalise"),
        {"name": "q", "got": 1 + 2e-6, "expected": 1.0},
    ),
    "quaternion 2e-6 too short": Bad(
        lambda: MODEL.frame_pose(with_value(6, 1 - 2e-6), "tool"), "InputError", ("0.999998",)
    ),
    "quaternion zero": Bad(
        lambda: MODEL.mass_matrix(with_value(6, 0.0)), "InputError", ("norm 0", "x, y, z, w")
    ),
    "the run's quaternion": Bad(
        lambda: simulation(q=with_value(6, 1.1)),
        "InputError",
        ("1.1", "normalise"),
        {"got": 1.1, "expected": 1.0},
    ),
    "a second quaternion": Bad(
        lambda: MODEL.difference(Q, with_value(6, 1.1)), "InputError", ("1.1",), {"got": 1.1}
    ),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_input(name: str) -> None:
    check(BAD[name])


def test_a_model_stays_usable_after_an_error() -> None:
    before = MODEL.mass_matrix(Q)
    for bad in BAD.values():
        with pytest.raises(oo.OnOrbitError):
            bad.call()
    np.testing.assert_array_equal(MODEL.mass_matrix(Q), before)


@pytest.mark.parametrize("off", [5e-7, -5e-7])
def test_a_quaternion_with_half_that_error_is_normalised(off: float) -> None:
    pose = MODEL.frame_pose(with_value(6, 1 + off), "tool")
    np.testing.assert_allclose(pose, MODEL.frame_pose(Q, "tool"), atol=1e-15)


@pytest.mark.parametrize("dtype", ["f4", "f2", "g", ">f8", "i8", "i4", "u1"])
def test_every_real_dtype_is_accepted(dtype: str) -> None:
    np.testing.assert_array_equal(MODEL.mass_matrix(Q.astype(dtype)), MODEL.mass_matrix(Q))


def test_python_lists_and_numbers_are_accepted() -> None:
    np.testing.assert_array_equal(MODEL.bias_forces(Q.tolist(), [0] * 13), MODEL.bias_forces(Q, V))
    np.testing.assert_array_equal(oo.Model.rigid_body(2, [[1, 0, 0], [0, 1, 0], [0, 0, 1]]).mass, 2.0)


def test_an_impossible_inertia_warns_with_the_name_of_the_link() -> None:
    with pytest.warns(UserWarning, match="'base' violates the triangle inequality"):
        model = oo.Model.rigid_body(1.0, np.diag([1.0, 1.0, 3.0]))
    assert len(model.warnings) == 1 and "base" in model.warnings[0]
