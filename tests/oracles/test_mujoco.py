"""Accelerations of free robots against MuJoCo: the reaction of a base that nothing holds.

MuJoCo shares no code and no conventions with us: quaternions wxyz, the base's linear velocity in W axes, its
angular velocity in body axes. Accelerations are compared, no trajectories: its integrators lose momentum.
Gate 1e-11 of the largest entry; seen is 3e-13 at most.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from trees import Array, Part, Tree, build, deviation, random_state, random_tree

import onorbit_rs as oo

mujoco = pytest.importorskip("mujoco", reason="the oracle is in the test extra: pip install mujoco")

GATE = 1e-11


def turn(rpy: tuple[float, ...]) -> Array:
    """Rotation of a URDF's roll, pitch, yaw."""
    (cr, sr), (cp, sp), (cy, sy) = ((np.cos(x), np.sin(x)) for x in rpy)
    about_x = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    about_y = np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
    about_z = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
    return np.asarray(about_z @ about_y @ about_x)


def text(numbers: Any) -> str:
    return " ".join(repr(float(x)) for x in np.ravel(numbers))


def add(parent: ElementTree.Element, tag: str, **attributes: Any) -> ElementTree.Element:
    """A new element; numbers are written in full."""
    texts = {name: x if isinstance(x, str) else text(x) for name, x in attributes.items()}
    return ElementTree.SubElement(parent, tag, texts)


def mjcf(tree: Tree) -> str:
    """The tree as MJCF: no gravity, no contacts, nothing but bodies, joints and rotors."""
    root = ElementTree.Element("mujoco")
    add(root, "compiler", angle="radian", inertiafromgeom="false", boundmass=0)
    add(root, "option", gravity=np.zeros(3))
    bodies: dict[str | None, ElementTree.Element] = {None: add(root, "worldbody")}
    for part in tree.parts:
        axes = turn(part.rpy)[:, :2].T
        body = add(bodies[part.parent], "body", name=part.name, pos=part.xyz, xyaxes=axes)
        bodies[part.name] = body
        (xx, xy, xz), (_, yy, yz), (*_, zz) = part.inertia
        add(body, "inertial", pos=part.com, mass=part.mass, fullinertia=[xx, yy, zz, xy, xz, yz])
        if part.parent is None:
            add(body, "freejoint")
        elif part.kind != "fixed":
            kind = "slide" if part.kind == "prismatic" else "hinge"
            add(body, "joint", name=part.joint, type=kind, axis=part.axis, armature=part.rotor_inertia)
    return ElementTree.tostring(root, encoding="unicode")


def tree_of(file: Path) -> Tree:
    """A bundled robot's URDF, read here by hand: links and joints in their order."""
    robot = ElementTree.parse(file).getroot()

    def numbers(element: ElementTree.Element | None, name: str, default: str = "0 0 0") -> Any:
        return tuple(map(float, (default if element is None else element.get(name, default)).split()))

    joints = {}
    for joint in robot.iter("joint"):
        child = joint.find("child")
        assert child is not None
        joints[child.get("link")] = joint
    parts = []
    for link in robot.iter("link"):
        inertial = link.find("inertial")
        if inertial is None:
            continue  # the tool
        mass, inertia = inertial.find("mass"), inertial.find("inertia")
        assert mass is not None and inertia is not None
        entries = [[float(inertia.attrib["i" + "".join(sorted(a + b))]) for b in "xyz"] for a in "xyz"]
        com = list(numbers(inertial.find("origin"), "xyz"))
        known: dict[str, Any] = {}
        if link.get("name") in joints:
            joint = joints[link.get("name")]
            parent, origin = joint.find("parent"), joint.find("origin")
            assert parent is not None
            known = {
                "parent": parent.get("link"), "joint": joint.get("name"), "kind": joint.get("type"),
                "axis": numbers(joint.find("axis"), "xyz"),
                "xyz": numbers(origin, "xyz"), "rpy": numbers(origin, "rpy"),
            }  # fmt: skip
        parts.append(Part(str(link.get("name")), float(mass.attrib["value"]), com, entries, **known))
    return Tree(parts, parts[-1].name, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


class MujocoRobot:
    def __init__(self, tree: Tree, joint_names: list[str]) -> None:
        self.model = mujoco.MjModel.from_xml_string(mjcf(tree))
        self.data = mujoco.MjData(self.model)
        joints = [self.model.joint(name) for name in joint_names]
        self.at_q = [int(joint.qposadr[0]) for joint in joints]
        self.at_v = [int(joint.dofadr[0]) for joint in joints]

    def acceleration(self, q: Array, v: Array, tau: Array) -> Array:
        """``v̇`` in our coordinates: base in its own axes."""
        data = self.data
        data.qpos[:3] = q[:3]
        data.qpos[3:7] = q[[6, 3, 4, 5]]  # wxyz
        data.qpos[self.at_q] = q[7:]
        flat = np.empty(9)
        mujoco.mju_quat2Mat(flat, data.qpos[3:7])
        rot_wb = flat.reshape(3, 3)
        data.qvel[:3], data.qvel[3:6] = rot_wb @ v[:3], v[3:6]
        data.qvel[self.at_v] = v[6:]
        data.qfrc_applied[:3], data.qfrc_applied[3:6] = rot_wb @ tau[:3], tau[3:6]
        data.qfrc_applied[self.at_v] = tau[6:]
        mujoco.mj_forward(self.model, data)
        # v = Rᵀ ṗ, so v̇ = Rᵀ p̈ - w × v
        linear = rot_wb.T @ data.qacc[:3] - np.cross(v[3:6], v[:3])
        return np.concatenate([linear, data.qacc[3:6], data.qacc[self.at_v]])


def compare(model: oo.Model, tree: Tree, seed: int) -> float:
    robot = MujocoRobot(tree, model.joint_names)
    rng = np.random.default_rng(seed)
    largest = 0.0
    for _ in range(8):
        state = random_state(model, rng, frames=1)
        theirs = robot.acceleration(state.q, state.v, state.tau)
        off = deviation(model.forward_dynamics(state.q, state.v, state.tau), theirs)
        largest = max(largest, off)
        assert off < GATE, f"acceleration is off by {off:.2e} (seed {seed})"
        # at MuJoCo's acceleration our inverse dynamics asks for the torques MuJoCo was given
        assert deviation(model.inverse_dynamics(state.q, state.v, theirs), state.tau) < GATE * 100
        # the arm's accelerations from the reduced model alone: the base reacts freely
        free = np.concatenate([np.zeros(6), state.tau[6:]])
        reduced = model.free_floating(state.q, state.v, model.body_names[-1])
        arm = np.linalg.solve(reduced.inertia, state.tau[6:] - reduced.bias)
        assert deviation(arm, robot.acceleration(state.q, state.v, free)[6:]) < GATE
    return largest


@pytest.mark.parametrize("name", ["humanoid_torso", "humanoid_dual_arm"])
def test_the_free_reaction_of_the_humanoid(name: str) -> None:
    model, tree = oo.robots.load(name), tree_of(oo.robots.path(name))
    print(f"{name}: largest deviation from MuJoCo {compare(model, tree, 1):.1e}")


@pytest.mark.parametrize("seed", range(200, 220))
def test_accelerations_of_random_trees(seed: int) -> None:
    tree = random_tree(seed)
    print(f"seed {seed}: largest deviation from MuJoCo {compare(build(tree), tree, seed):.1e}")


def test_control_a_forgotten_transport_term_is_rejected() -> None:
    tree = random_tree(200)
    model = build(tree)
    robot = MujocoRobot(tree, model.joint_names)
    state = random_state(model, np.random.default_rng(1), frames=1)
    theirs = robot.acceleration(state.q, state.v, state.tau)
    theirs[:3] += np.cross(state.v[3:6], state.v[:3])
    assert deviation(model.forward_dynamics(state.q, state.v, state.tau), theirs) > 1e-3


def test_control_a_base_held_by_something_moves_otherwise() -> None:
    # the arm on a fixed base: M_mm instead of M*
    model = oo.robots.load("humanoid_torso")
    robot = MujocoRobot(tree_of(oo.robots.path("humanoid_torso")), model.joint_names)
    state = random_state(model, np.random.default_rng(2), frames=1)
    free = np.concatenate([np.zeros(6), state.tau[6:]])
    held = np.linalg.solve(
        model.mass_matrix(state.q)[6:, 6:], state.tau[6:] - model.bias_forces(state.q, state.v)[6:]
    )
    # the shoulder carries most of the recoil; the light wrist hardly feels it
    assert deviation(held[:1], robot.acceleration(state.q, state.v, free)[6:7]) > 0.1
