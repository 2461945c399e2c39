"""State layouts of other engines: the same state must give every link the same pose and velocity.

Pinocchio and MuJoCo run here. Drake (a large package), SPART (whose dynamics `onorbit validate` checks) and
RBDL (compiled from C++, since its package does not build on current Python) were run by
`generate_layouts.py`, which wrote `fixtures/layouts.json`: states in their layouts, link poses and
velocities. Drake also runs here if it is installed. The gate is 1e-13 of the largest entry; the largest
value observed is 4e-15.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs import layouts
from onorbit_rs.tools.validation.trees import Array, build, deviation, random_tree, urdf

GATE = 1e-13
TABLES = json.loads((Path(__file__).parents[1] / "fixtures" / "layouts.json").read_text())
DUAL = oo.robots.load("humanoid_dual_arm")


def state(model: oo.Model, seed: int) -> tuple[Array, Array]:
    rng = np.random.default_rng(seed)
    q, v = rng.uniform(-1.5, 1.5, model.nq), rng.uniform(-1.5, 1.5, model.nv)
    q[3:7] /= np.linalg.norm(q[3:7])
    return q, v


def same_state(mine: tuple[Array, Array], again: tuple[Array, Array]) -> None:
    assert deviation(again[0], mine[0]) < GATE
    assert deviation(again[1], mine[1]) < GATE


@pytest.mark.parametrize("seed", range(8))
def test_pinocchio(seed: int) -> None:
    pin = pytest.importorskip("pinocchio", reason="the oracle is not installed: pip install pin")
    text = urdf(random_tree(seed, rotors=False))
    model = oo.Model.from_urdf_string(text)
    theirs = pin.buildModelFromXML(text, pin.JointModelFreeFlyer())
    data = theirs.createData()
    q, v = state(model, seed)
    pin_q, pin_v = layouts.to_pinocchio(model, q, v, theirs)
    assert pin_q.shape == (theirs.nq,) and theirs.nq > model.nq  # some joints are unbounded
    pin.forwardKinematics(theirs, data, pin_q, pin_v)
    pin.updateFramePlacements(theirs, data)
    for name in model.frame_names:
        frame = theirs.getFrameId(name, pin.FrameType.BODY)
        twist = pin.getFrameVelocity(theirs, data, frame, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED).vector
        assert deviation(model.frame_pose(q, name), data.oMf[frame].homogeneous) < GATE, name
        assert deviation(model.frame_velocity(q, v, name), twist) < GATE, name
    same_state((q, v), layouts.from_pinocchio(model, pin_q, pin_v, theirs))
    # the same from joint names only
    names = list(theirs.names)[2:]
    unbounded = [name for name in names if theirs.joints[theirs.getJointId(name)].nq == 2]
    by_names = layouts.to_pinocchio(model, q, v, names, unbounded=unbounded)
    np.testing.assert_array_equal(by_names[0], pin_q)


def test_the_order_of_pinocchios_joints_matters() -> None:
    """Pinocchio sorts siblings by name: without reordering, the joints of two arms would be swapped."""
    pin = pytest.importorskip("pinocchio", reason="the oracle is not installed: pip install pin")
    theirs = pin.buildModelFromXML(oo.robots.path("humanoid_dual_arm").read_text(), pin.JointModelFreeFlyer())
    assert list(theirs.names)[2:] != DUAL.joint_names
    q, v = state(DUAL, 3)
    assert not np.array_equal(
        layouts.to_pinocchio(DUAL, q, v)[0], layouts.to_pinocchio(DUAL, q, v, theirs)[0]
    )


@pytest.mark.parametrize("seed", range(8))
def test_mujoco(seed: int) -> None:
    mujoco = pytest.importorskip("mujoco", reason="the oracle is not installed: pip install mujoco-core")
    from onorbit_rs.tools.validation.against_mujoco import mjcf

    tree = random_tree(seed)
    model, theirs = build(tree), mujoco.MjModel.from_xml_string(mjcf(tree))
    data = mujoco.MjData(theirs)
    q, v = state(model, seed)

    def worst(qpos: Array, qvel: Array) -> float:
        data.qpos[:], data.qvel[:] = qpos, qvel
        mujoco.mj_forward(theirs, data)
        largest = 0.0
        for part in tree.parts:
            body, twist = data.body(part.name), np.empty(6)
            mujoco.mj_objectVelocity(theirs, data, mujoco.mjtObj.mjOBJ_XBODY, body.id, twist, 0)
            pose = np.eye(4)
            pose[:3, :3], pose[:3, 3] = body.xmat.reshape(3, 3), body.xpos
            ours = model.frame_velocity(q, v, part.name)
            largest = max(
                largest,
                deviation(model.frame_pose(q, part.name), pose),
                deviation(ours, twist[[3, 4, 5, 0, 1, 2]]),
            )
        return largest

    qpos, qvel = layouts.to_mujoco(model, q, v, theirs)
    assert worst(qpos, qvel) < GATE
    same_state((q, v), layouts.from_mujoco(model, qpos, qvel, theirs))
    # negative control: the linear velocity in body axes gives different link velocities
    assert worst(qpos, np.concatenate([v[:3], qvel[3:]])) > 1e-3


def compare_links(q: Array, v: Array, links: dict[str, Any]) -> float:
    """Returns the largest deviation of poses and velocities from the other engine's."""
    largest = 0.0
    for name, link in links.items():
        largest = max(
            largest,
            deviation(DUAL.frame_pose(q, name), link["pose"]),
            deviation(DUAL.frame_velocity(q, v, name), link["velocity"]),
        )
    return largest


def test_drake_s_table() -> None:
    table = TABLES["drake"]
    theirs_q, theirs_v = np.array(table["q"]), np.array(table["v"])
    q, v = layouts.from_drake(DUAL, theirs_q, theirs_v, table["joints"])
    assert len(table["links"]) > 15 and compare_links(q, v, table["links"]) < GATE
    # set through Drake's typed calls, so only the converter depends on the layout of its vector
    np.testing.assert_allclose(q[:3], table["position_m"], atol=1e-15)
    assert abs(q[3:7] @ table["quat_xyzw"]) == pytest.approx(1.0, abs=1e-15)
    again = layouts.to_drake(DUAL, q, v, table["joints"])
    assert deviation(again[0], theirs_q) < GATE and deviation(again[1], theirs_v) < GATE
    # negative control: MuJoCo's convention gives different velocities
    swapped = np.concatenate([theirs_v[3:6], theirs_v[:3], theirs_v[6:]])
    assert (
        compare_links(q, layouts.from_drake(DUAL, theirs_q, swapped, table["joints"])[1], table["links"])
        > 1e-3
    )


def test_drake_itself() -> None:
    parsing = pytest.importorskip(
        "pydrake.multibody.parsing", reason="Drake, a large package, is not installed: pip install drake"
    )
    from pydrake.multibody.plant import MultibodyPlant

    plant = MultibodyPlant(0.0)
    parsing.Parser(plant).AddModelsFromString(oo.robots.path("humanoid_dual_arm").read_text(), "urdf")
    plant.Finalize()
    context = plant.CreateDefaultContext()
    q, v = state(DUAL, 7)
    theirs_q, theirs_v = layouts.to_drake(DUAL, q, v, plant)
    plant.SetPositions(context, theirs_q)
    plant.SetVelocities(context, theirs_v)
    for name in DUAL.frame_names:
        body = plant.GetBodyByName(name)
        velocity = plant.EvalBodySpatialVelocityInWorld(context, body)
        twist = np.concatenate([velocity.translational(), velocity.rotational()])
        assert (
            deviation(DUAL.frame_pose(q, name), plant.EvalBodyPoseInWorld(context, body).GetAsMatrix4())
            < GATE
        )
        assert deviation(DUAL.frame_velocity(q, v, name), twist) < GATE
    same_state((q, v), layouts.from_drake(DUAL, theirs_q, theirs_v, plant))


def test_rbdl_s_table() -> None:
    table = TABLES["rbdl"]
    q, v = layouts.from_rbdl(DUAL, table["q"], table["v"], table["joints"])
    assert len(table["links"]) > 10 and compare_links(q, v, table["links"]) < GATE
    again = layouts.to_rbdl(DUAL, q, v, table["joints"])
    assert deviation(again[0], table["q"]) < GATE and deviation(again[1], table["v"]) < GATE
    # negative control: the quaternion's scalar is not the seventh entry
    wrong = np.array(table["q"])
    wrong[[6, -1]] = wrong[[-1, 6]]
    wrong[[3, 4, 5, -1]] /= np.linalg.norm(wrong[[3, 4, 5, -1]])
    assert (
        compare_links(layouts.from_rbdl(DUAL, wrong, table["v"], table["joints"])[0], v, table["links"])
        > 1e-3
    )


def test_spart_s_table() -> None:
    """SPART's poses and twists are those of the links' centres of mass."""
    table = TABLES["spart"]
    position = (table["R0"], table["r0"], table["qm"])
    q, v = layouts.from_spart(DUAL, position, (table["u0"], table["um"]), table["joints"])
    coms = {body.name: np.array(body.com) for body in DUAL.bodies}
    assert len(table["links"]) == 14
    for name, link in table["links"].items():
        pose, twist = DUAL.frame_pose(q, name), DUAL.frame_velocity(q, v, name)
        arm = pose[:3, :3] @ coms[name]
        assert deviation(pose[:3, :3], link["rotation"]) < GATE, name
        assert deviation(pose[:3, 3] + arm, link["com"]) < GATE, name
        spatial = np.concatenate([twist[3:], twist[:3] + np.cross(twist[3:], arm)])  # angular first
        assert deviation(spatial, link["twist"]) < GATE, name
    again_q, again_v = layouts.to_spart(DUAL, q, v, table["joints"])
    for mine, theirs in zip((*again_q, *again_v), (*position, table["u0"], table["um"]), strict=True):
        assert deviation(mine, theirs) < GATE
    # t0 = P0 u0, P0 turning the angular velocity to inertial axes
    rot = np.array(table["R0"])
    np.testing.assert_allclose(table["t0"], [*(rot @ table["u0"][:3]), *table["u0"][3:]], atol=1e-15)
