"""Frozen numbers of other engines; nothing but ours need be installed."""

from __future__ import annotations

import json
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.validation.trees import TOOL, State, Tree, build, deviation

TABLE = json.loads((Path(__file__).parents[1] / "fixtures" / "pinocchio_tables.json").read_text())
CASES = [(case, state) for case in TABLE["cases"] for state in case["states"]]


def kernels(model: oo.Model, state: State) -> dict[str, Any]:
    q, v, external = state.q, state.v, state.external
    reduced = model.free_floating(q, v, TOOL, external=external)
    moved = model.integrate(q, v)
    return {
        "frame_pose": model.frame_pose(q, TOOL),
        "frame_velocity": model.frame_velocity(q, v, TOOL),
        "frame_jacobian": model.frame_jacobian(q, TOOL),
        "mass_matrix": model.mass_matrix(q),
        "bias_forces": model.bias_forces(q, v),
        "inverse_dynamics": model.inverse_dynamics(q, v, state.a, external=external),
        "forward_dynamics": model.forward_dynamics(q, v, state.tau, external=external),
        "momentum": model.momentum(q, v),
        "kinetic_energy": model.kinetic_energy(q, v),
        "center_of_mass": model.center_of_mass(q),
        "integrate": moved,
        "difference": model.difference(q, moved),
    } | {
        f"free_floating.{name}": getattr(reduced, name)
        for name in ("inertia", "bias", "external", "jacobian", "drift")
    }


@pytest.mark.parametrize(("case", "given"), CASES, ids=lambda x: f"seed{x['seed']}" if "seed" in x else "")
def test_pinocchio(case: dict[str, Any], given: dict[str, Any]) -> None:
    model = build(Tree.of(case["tree"]))
    assert model.joint_names == case["joint_names"]
    arrays = {name: np.array(given[name]) for name in ("q", "v", "a", "tau")}
    external = {name: np.array(wrench) for name, wrench in given["external"].items()}
    ours = kernels(model, State(**arrays, external=external))
    assert set(ours) == set(given["expected"])
    for kernel, expected in given["expected"].items():
        value = np.array(ours[kernel])
        if kernel == "integrate" and value[3:7] @ expected[3:7] < 0:
            value[3:7] *= -1  # two quaternions are one attitude
        assert deviation(value, expected) < TABLE["tolerance"], kernel


def test_the_table_says_where_it_is_from() -> None:
    assert {"generator", "engine", "date", "tolerance", "layout"} <= set(TABLE)


# Hard-coded expected values of other libraries' own tests; see ../shared/validation/rigid_body_vectors.


def test_rbdl_one_link_on_a_floating_base() -> None:
    # rbdl tests/FloatingBaseTests.cc: base com (1, 0, 0); a link on a z axis at (2, 0, 0), com (1, 0, 0);
    # masses and radii of gyration 1; q = 0, joint torque 1, gravity -9.81 y: qdd = (0, -8.81, 0, -1, 0, 0, 2)
    # in rbdl's order Tx, Ty, Tz, Rz, Ry, Rx. Without gravity the free fall goes: 1 along y is left.
    builder = oo.ModelBuilder("rbdl", base="base", mass=1.0, com=[1, 0, 0], inertia=np.eye(3))
    builder.add_link(
        "link", parent="base", joint="hinge", xyz=[2, 0, 0], mass=1.0, com=[1, 0, 0], inertia=np.eye(3)
    )
    model = builder.build()
    torque = [0, 0, 0, 0, 0, 0, 1.0]
    acceleration = model.forward_dynamics(model.neutral(), np.zeros(7), torque)
    # angular velocity -1 about z, along y +1, hinge +2
    np.testing.assert_allclose(acceleration, [0, 1, 0, 0, 0, -1, 2], atol=1e-14)


def test_rbdl_floating_base_kinematics() -> None:
    # rbdl tests/FloatingBaseTests.cc: Tx, Ty, Tz, Rz, Ry, Rx; its matrices take base to body components
    q = np.array([0.1, 1.1, 1.2, 1.3, 1.5, 1.7])
    (cz, cy, cx), (sz, sy, sx) = np.cos(q[3:]), np.sin(q[3:])
    about_z = np.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]])
    about_y = np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    about_x = np.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]])
    rot_wb = about_z @ about_y @ about_x
    rate_w = q[3] * np.array([0, 0, 1]) + q[4] * about_z[:, 1] + q[5] * (about_z @ about_y)[:, 0]
    model = oo.ModelBuilder("rbdl", base="base", mass=1.0, com=[0, 1, 0], inertia=np.eye(3))
    model.add_frame("point", "base", xyz=[-1.9, -1.8, 0.0])
    model.add_frame("other", "base", xyz=[1.0, 0.0, 0.0])
    robot = model.build()
    state_q = np.concatenate([q[:3], quaternion(rot_wb)])
    state_v = np.concatenate([rot_wb.T @ q[:3], rot_wb.T @ rate_w])  # its rates are the angles' numbers
    # their tolerance 1e-14 is absolute on numbers of order 4: two more rotations here
    pose = robot.frame_pose(state_q, "point")
    expected = [-0.6357089363622626, -0.6831041744630977, 2.968974805916970]
    np.testing.assert_allclose(pose[:3, 3], expected, atol=3e-15 * 4)
    velocity = robot.frame_velocity(state_q, state_v, "point")[:3]
    expected = [0.3091226260907569, 3.891012095550828, 4.100277995030419]
    np.testing.assert_allclose(velocity, expected, atol=1e-14)
    velocity = robot.frame_velocity(state_q, state_v, "other")[:3]
    expected = [-0.3888503432977729, -0.3171179347202455, 1.093894197498446]
    np.testing.assert_allclose(velocity, expected, atol=1e-14)


def quaternion(rot: Any) -> Any:
    """xyzw, by the eigenvector that belongs to it."""
    m = np.array(
        [
            [rot[0, 0] - rot[1, 1] - rot[2, 2], 0, 0, 0],
            [rot[0, 1] + rot[1, 0], rot[1, 1] - rot[0, 0] - rot[2, 2], 0, 0],
            [rot[0, 2] + rot[2, 0], rot[1, 2] + rot[2, 1], rot[2, 2] - rot[0, 0] - rot[1, 1], 0],
            [rot[2, 1] - rot[1, 2], rot[0, 2] - rot[2, 0], rot[1, 0] - rot[0, 1], np.trace(rot)],
        ]
    )
    return np.linalg.eigh(m)[1][:, -1]


# drake multibody/benchmarks/kuka_iiwa_robot, by MotionGenesis; q = (60, 30, 60, 30, 60, 30, 60) degrees.
KUKA_POSITION = [0.2970356451892219, 0.1727696964662288, 1.154681973689345]
KUKA_ROTATION = [
    [-0.5939002959880204, 0.8043869080239565, -0.015625],
    [-0.8043869080239565, -0.5932991120359317, 0.03094940802395521],
    [0.015625, 0.03094940802395527, 0.9993988160479114],
]


def test_drake_kuka_iiwa14(shared: Path) -> None:
    file = shared / "models" / "drake_kuka_iiwa14_benchmark.urdf"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        model = oo.Model.from_urdf(file)
    q = model.neutral()
    flange = model.body_names[-1]
    np.testing.assert_allclose(model.frame_pose(q, flange)[:3, 3], [0, 0, 1.261], atol=1e-15)
    q[7:] = np.deg2rad([60, 30, 60, 30, 60, 30, 60])
    pose = model.frame_pose(q, flange)
    # the table is Drake's to 15 digits
    np.testing.assert_allclose(pose[:3, 3], KUKA_POSITION, atol=1e-14)
    np.testing.assert_allclose(pose[:3, :3], KUKA_ROTATION, atol=1e-14)
    # at rest, 1000 rad/s² on joint 7 take 1 N m on joints 1, 3, 5 and 7, whose axes are parallel at q = 0
    a = np.concatenate([np.zeros(model.nv - 1), [1000.0]])
    torques = model.inverse_dynamics(model.neutral(), np.zeros(model.nv), a)[6:]
    np.testing.assert_allclose(torques, [1, 0, 1, 0, 1, 0, 1], atol=1e-13)
