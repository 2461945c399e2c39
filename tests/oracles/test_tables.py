"""Recorded results of other engines, which need not be installed."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.tools.validation.bodies import IIWA, IIWA_DEGREES, IIWA_POSITION, IIWA_ROTATION
from onorbit_rs.tools.validation.trees import TOOL, State, Tree, build, deviation

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
            value[3:7] *= -1  # q and -q are the same attitude
        assert deviation(value, expected) < TABLE["tolerance"], kernel


def test_the_table_names_its_source() -> None:
    assert {"generator", "engine", "date", "tolerance", "layout"} <= set(TABLE)


# Values from the tests of other libraries are in onorbit_rs.tools.validation.bodies; here Drake's robot
# from a URDF.


def iiwa(axial: float) -> str:
    """Returns Drake's iiwa arm on an empty root; ``axial`` is the inertia about a joint's axis, kg m²."""
    body = (
        '<inertial><origin xyz="0 0 0.05"/><mass value="3"/>'
        f'<inertia ixx="0.02" iyy="0.02" izz="{axial}" ixy="0" ixz="0" iyz="0"/></inertial>'
    )
    parts = ['<link name="world"/>', f'<link name="link_0">{body}</link>']
    parts.append('<joint name="stand" type="fixed"><parent link="world"/><child link="link_0"/></joint>')
    for number, (xyz, quarters) in enumerate(IIWA, 1):
        place, rpy = (
            " ".join(map(repr, values)) for values in (xyz, np.multiply(quarters, np.pi / 2).tolist())
        )
        parts += [
            f'<link name="link_{number}">{body}</link>',
            f'<joint name="joint_{number}" type="revolute"><origin xyz="{place}" rpy="{rpy}"/>'
            f'<parent link="link_{number - 1}"/><child link="link_{number}"/><axis xyz="0 0 1"/></joint>',
        ]
    return f'<robot name="iiwa">{"".join(parts)}</robot>'


def test_drake_kuka_iiwa14() -> None:
    model = oo.Model.from_urdf_string(iiwa(axial=1e-3))
    q = model.neutral()
    q[7:] = np.deg2rad(IIWA_DEGREES)
    pose = model.frame_pose(q, "link_7")
    # the table has 15 digits
    np.testing.assert_allclose(pose[:3, 3], IIWA_POSITION, atol=1e-14)
    np.testing.assert_allclose(pose[:3, :3], IIWA_ROTATION, atol=1e-14)
    # at rest, 1000 rad/s² on joint 7 take 1 N m on joints 1, 3, 5 and 7, whose axes are parallel at q = 0
    a = np.concatenate([np.zeros(model.nv - 1), [1000.0]])
    torques = model.inverse_dynamics(model.neutral(), np.zeros(model.nv), a)[6:]
    np.testing.assert_allclose(torques, [1, 0, 1, 0, 1, 0, 1], atol=1e-13)
