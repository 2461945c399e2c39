"""Compares the dynamics with SPART, a MATLAB toolbox for space robots, through its C version spartpy.

The robots have no fixed joints, and all branches start at the base: for other robots, the inverse dynamics of
spartpy 1.1.3 do not reproduce the forces given to its forward dynamics.
"""

from __future__ import annotations

import contextlib
import importlib
import io
import tempfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

import onorbit_rs as oo
from onorbit_rs.common.coordinates import ANGULAR, JOINTS_V, LINEAR, QUATERNION
from onorbit_rs.common.rotations import matrix_from_quaternion
from onorbit_rs.tools.validation.case import CannotRunError, Case, Gate, worst
from onorbit_rs.tools.validation.trees import Array, State, Tree, deviation, random_state, random_tree, urdf

SEEDS, STATES = range(8), 4
BUNDLED = ("humanoid_torso", "humanoid_dual_arm")


def spart(text: str) -> tuple[Any, list[str]]:
    """Return SPART's model of a robot, given as URDF text, and the joint names in SPART's order.

    Raises
    ------
    CannotRunError
        If spartpy, which compiles its C code at the first call, cannot be compiled.
    """
    spartpy, reader = importlib.import_module("SPARTpy"), importlib.import_module("SPARTpy.urdf2robot")
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "robot.urdf"
        file.write_text(with_inertia_alone(text), encoding="utf-8")
        robot, (_, names) = spartpy.SPART(str(file)), reader.urdf2robot(str(file))
    n = robot.robot.n_q
    try:
        with contextlib.redirect_stdout(io.StringIO()):  # spartpy prints a message when it compiles
            robot.kinematics(np.eye(3), np.zeros(3), np.zeros(n))
    except RuntimeError as error:
        reason = next(iter(str(error).splitlines()), "it gave no reason")
        message = f"spartpy cannot be built on this machine ({reason}); check that a C compiler is installed"
        raise CannotRunError(message) from error
    return robot, sorted(names["q_id"], key=names["q_id"].__getitem__)


def with_inertia_alone(text: str) -> str:
    """Return the URDF text without massless links, which SPART does not accept."""
    robot = ElementTree.fromstring(text)
    bare = [link for link in robot.findall("link") if link.find("inertial") is None]
    names = {link.get("name") for link in bare}
    joints = [(joint, joint.find("child")) for joint in robot.findall("joint")]
    mounts = [joint for joint, child in joints if child is not None and child.get("link") in names]
    for element in (*bare, *mounts):
        robot.remove(element)
    return ElementTree.tostring(robot, encoding="unicode")


def rates(model: oo.Model, q: Array, v: Array, a: Array) -> tuple[Array, Array]:
    """Return SPART's ``(u̇0, u̇m)`` with `r̈0 = R (v̇ + ẇ × c + w × (v + w × c))` in `u̇0`.

    `r̈0` is the acceleration of the base's mass centre in W, `c` its position in the base, `R` the attitude
    of the base, `v` and `w` its twist in body axes.
    """
    com, w = np.array(model.bodies[0].com), v[ANGULAR]
    inner = a[LINEAR] + np.cross(a[ANGULAR], com) + np.cross(w, v[LINEAR] + np.cross(w, com))
    return np.concatenate([a[ANGULAR], matrix_from_quaternion(q[QUATERNION]) @ inner]), a[JOINTS_V]


def forces(model: oo.Model, q: Array, tau: Array) -> tuple[Array, Array]:
    """Return SPART's generalized forces ``(tau0, taum)``.

    ``tau0`` contains the moment about the base's mass centre in base axes, N m, then the force in W, N.
    """
    com = np.array(model.bodies[0].com)
    moment = tau[ANGULAR] - np.cross(com, tau[LINEAR])
    return np.concatenate([moment, matrix_from_quaternion(q[QUATERNION]) @ tau[LINEAR]]), tau[JOINTS_V]


def compare(text: str, states: int, seed: int) -> Iterator[tuple[float, float]]:
    """Yield the deviations of forward and inverse dynamics of each state, relative to the largest entry."""
    model, (engine, joints) = oo.Model.from_urdf_string(text), spart(text)
    order = [model.joint_names.index(name) for name in joints]
    rng = np.random.default_rng(seed)
    for _ in range(states):
        state = random_state(model, rng, frames=1)
        a, tau = theirs(engine, joints, order, model, state)
        u0, um = rates(model, state.q, state.v, model.forward_dynamics(state.q, state.v, state.tau))
        tau0, taum = forces(model, state.q, model.inverse_dynamics(state.q, state.v, state.a))
        yield deviation(np.r_[u0, um[order]], a), deviation(np.r_[tau0, taum[order]], tau)


def theirs(
    engine: Any, joints: list[str], order: list[int], model: oo.Model, state: State
) -> tuple[Array, Array]:
    """Return SPART's forward dynamics for the state's forces and inverse dynamics for its acceleration."""
    (rot, r0, qm), (u0, um) = oo.layouts.to_spart(model, state.q, state.v, joints)
    _, rot_link, _, r_link, e, g = engine.kinematics(rot, r0, qm)
    b_ij, b_i0, p0, pm = engine.diff_kinematics(rot, r0, r_link, e, g)
    twists = engine.velocities(b_ij, b_i0, p0, pm, u0, um)
    inertias = engine.i_i(rot, rot_link)
    none = np.zeros(6), np.zeros((6, engine.robot.n_links_joints))
    tau0, taum = forces(model, state.q, state.tau)
    found = engine.forward_dynamics(tau0, taum[order], *none, *twists, p0, pm, *inertias, b_ij, b_i0, u0, um)
    du0, dum = rates(model, state.q, state.v, state.a)
    dtwists = engine.accelerations(*twists, p0, pm, b_i0, b_ij, u0, um, du0, dum[order])
    needed = engine.inverse_dynamics(*none, *twists, *dtwists, p0, pm, *inertias, b_ij, b_i0)
    return np.concatenate([np.ravel(x) for x in found]), np.concatenate([np.ravel(x) for x in needed])


def arms(seed: int) -> Tree:
    """Return a robot with two arms of revolute and prismatic joints along skew axes."""
    tree = random_tree(seed, rotors=False)
    base, *links = tree.parts
    middle = len(links) // 2
    parents = [base, *links[: middle - 1], base, *links[middle:-1]]
    hung = [
        replace(link, parent=parent.name, kind="revolute" if link.kind == "fixed" else link.kind)
        for link, parent in zip(links, parents, strict=True)
    ]
    return replace(tree, parts=[base, *hung])


def measure() -> Any:
    """Return the largest deviations over all robots and states."""
    texts = [urdf(arms(seed)) for seed in SEEDS]
    texts += [oo.robots.path(name).read_text(encoding="utf-8") for name in BUNDLED]
    return worst(pair for seed, text in enumerate(texts) for pair in compare(text, STATES, seed))


GATES = (Gate("forward dynamics", 1e-11), Gate("inverse dynamics", 1e-11))
CASES = (
    Case(
        "engines", f"{len(SEEDS)} random pairs of arms, {len(BUNDLED)} humanoids, {STATES} states each",
        "SPART, as spartpy", GATES, measure, needs="SPARTpy",
    ),
)  # fmt: skip
