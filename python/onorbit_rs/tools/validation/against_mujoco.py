"""Compares accelerations of free-floating robots with those of MuJoCo.

MuJoCo shares no code with this package, and its conventions differ: quaternions are wxyz, and the base's
linear velocity is in W axes, unlike the angular velocity, which is in body axes. Accelerations are compared
instead of trajectories because MuJoCo's integrators do not conserve momentum.
"""

from __future__ import annotations

import importlib
from functools import partial
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

import onorbit_rs as oo
from onorbit_rs.common.coordinates import ANGULAR, BASE_NV, JOINTS_Q, JOINTS_V, LINEAR, QUATERNION
from onorbit_rs.tools.validation.case import Case, Gate, worst
from onorbit_rs.tools.validation.trees import Array, Part, Tree, build, deviation, random_state, random_tree

SEEDS, STATES = range(200, 208), 4
GATE = 1e-11
"""Largest error allowed, relative to the largest entry; the largest error observed is 3e-13."""


def turn(rpy: tuple[float, ...]) -> Array:
    """Return the rotation matrix of a URDF's roll, pitch, yaw."""
    (cr, sr), (cp, sp), (cy, sy) = ((np.cos(x), np.sin(x)) for x in rpy)
    about_x = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    about_y = np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
    about_z = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
    return np.asarray(about_z @ about_y @ about_x)


def text(numbers: Any) -> str:
    """Return numbers as text in full precision."""
    return " ".join(repr(float(x)) for x in np.ravel(numbers))


def add(parent: ElementTree.Element, tag: str, **attributes: Any) -> ElementTree.Element:
    """Add an XML element; numbers are written in full precision."""
    texts = {name: x if isinstance(x, str) else text(x) for name, x in attributes.items()}
    return ElementTree.SubElement(parent, tag, texts)


def mjcf(tree: Tree) -> str:
    """Return the robot as MJCF (MuJoCo's XML format) with bodies, joints and rotors, without gravity."""
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
    """Read a bundled robot's URDF independently of the package: links with inertia, in file order."""
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
            continue  # the tool frame
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
    """A robot in MuJoCo, with the joints in the order of ``joint_names``."""

    def __init__(self, tree: Tree, joint_names: list[str]) -> None:
        """Build MuJoCo's model from MJCF."""
        mujoco: Any = importlib.import_module("mujoco")
        self.mujoco = mujoco
        self.model = mujoco.MjModel.from_xml_string(mjcf(tree))
        self.data = mujoco.MjData(self.model)
        joints = [self.model.joint(name) for name in joint_names]
        self.at_q = [int(joint.qposadr[0]) for joint in joints]
        self.at_v = [int(joint.dofadr[0]) for joint in joints]

    def acceleration(self, q: Array, v: Array, tau: Array) -> Array:
        """Return ``v̇`` (nv,) in the coordinates of this package, m/s² and rad/s², the base in body axes."""
        data = self.data
        data.qpos[:3] = q[:3]
        data.qpos[QUATERNION] = np.roll(q[QUATERNION], 1)  # wxyz
        data.qpos[self.at_q] = q[JOINTS_Q]
        flat = np.empty(9)
        self.mujoco.mju_quat2Mat(flat, data.qpos[QUATERNION])
        rot_wb = flat.reshape(3, 3)
        data.qvel[LINEAR], data.qvel[ANGULAR] = rot_wb @ v[LINEAR], v[ANGULAR]
        data.qvel[self.at_v] = v[JOINTS_V]
        data.qfrc_applied[LINEAR], data.qfrc_applied[ANGULAR] = rot_wb @ tau[LINEAR], tau[ANGULAR]
        data.qfrc_applied[self.at_v] = tau[JOINTS_V]
        self.mujoco.mj_forward(self.model, data)
        # v = Rᵀ ṗ, so v̇ = Rᵀ p̈ - w × v
        linear = rot_wb.T @ data.qacc[LINEAR] - np.cross(v[ANGULAR], v[LINEAR])
        return np.concatenate([linear, data.qacc[ANGULAR], data.qacc[self.at_v]])


def compare(model: oo.Model, tree: Tree, seed: int) -> Any:
    """Return the largest relative deviations of accelerations of the full and of the reduced model."""
    robot = MujocoRobot(tree, model.joint_names)
    rng = np.random.default_rng(seed)
    found = []
    for _ in range(STATES):
        state = random_state(model, rng, frames=1)
        theirs = robot.acceleration(state.q, state.v, state.tau)
        whole = deviation(model.forward_dynamics(state.q, state.v, state.tau), theirs)
        # M* q̈ + c* = τ: the base reacts freely
        free = np.concatenate([np.zeros(BASE_NV), state.tau[JOINTS_V]])
        reduced = model.free_floating(state.q, state.v, model.body_names[-1])
        alone = np.linalg.solve(reduced.inertia, state.tau[JOINTS_V] - reduced.bias)
        arm = deviation(alone, robot.acceleration(state.q, state.v, free)[JOINTS_V])
        found.append((whole, arm))
    return worst(found)


def trees() -> Any:
    """Return the largest deviations for robots with branches, skew axes, rotors and all kinds of joints."""
    made = ((random_tree(seed), seed) for seed in SEEDS)
    return worst(compare(build(tree), tree, seed) for tree, seed in made)


def bundled(name: str) -> Any:
    """Return the largest deviations of a bundled robot from MuJoCo, as computed by :func:`compare`."""
    return compare(oo.robots.load(name), tree_of(oo.robots.path(name)), 1)


GATES = (Gate("acceleration", GATE), Gate("acceleration by M*, c*", GATE))

CASES = (
    Case(
        "engines", "8 random trees with rotors, 4 states each", "MuJoCo", GATES, trees, needs="mujoco"
    ),
    *(
        Case("engines", f"{name}, 4 states", "MuJoCo", GATES, partial(bundled, name), needs="mujoco")
        for name in ("humanoid_torso", "humanoid_dual_arm")
    ),
)  # fmt: skip
