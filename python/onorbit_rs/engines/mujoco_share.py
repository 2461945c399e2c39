"""Indices of the systems in the arrays of a MuJoCo model, and the welds that connect the systems."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.engines.mujoco_common import link_name, path

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from types import ModuleType

    from numpy.typing import NDArray

    from onorbit_rs._core import Model

    Floats = NDArray[np.float64]
    Indices = NDArray[np.intp]
    Weld = tuple[tuple[int, int], tuple[int, int], Floats, Floats]
    """Indices (system, body) of both sides, the captured origin in the axes of each body, (2, 3), m, and the
    rotation (3, 3) from the axes of the second body to those of the first."""


_YZX, _ZXY = [1, 2, 0], [2, 0, 1]


@dataclass(frozen=True)
class Share:
    """Slices and indices of one system in the arrays of a MuJoCo model and in those of a run."""

    velocities: slice
    linear: slice
    angular: slice
    quaternion: slice
    origin: slice
    bodies: Indices
    """Ids of MuJoCo's bodies, in the order of the system's model."""
    rows: slice
    """Slice of the system's bodies in the list of all bodies of the run."""
    q_columns: Indices
    """Index in MuJoCo's configuration of each coordinate of the system."""
    v_columns: Indices
    dofs: Indices
    """Index in MuJoCo's velocity of each joint rate."""


def shares(compiled: Any, models: Mapping[str, Model]) -> list[Share]:
    """Return the slices and indices of each system in a compiled MuJoCo model."""
    found: list[Share] = []
    q, v, row = 0, 0, 0
    for name, model in models.items():
        joints = [compiled.joint(path(name, joint)) for joint in model.joint_names]
        dofs = np.array([joint.dofadr[0] for joint in joints], dtype=int)
        bodies = np.array([compiled.body(link_name(path(name, body))).id for body in model.body_names])
        # MuJoCo's quaternion is wxyz
        base = q + np.array([0, 1, 2, 4, 5, 6, 3])
        found.append(
            Share(
                velocities=slice(v, v + model.nv), linear=slice(v, v + 3), angular=slice(v + 3, v + 6),
                quaternion=slice(q + 3, q + 7), origin=slice(q, q + 3),
                bodies=bodies, rows=slice(row, row + len(bodies)),
                q_columns=np.array([*base, *(joint.qposadr[0] for joint in joints)]),
                v_columns=np.array([*range(v, v + 6), *dofs]), dofs=dofs,
            )
        )  # fmt: skip
        q, v, row = q + model.nq, v + model.nv, row + len(bodies)
    return found


def connect(
    mujoco: ModuleType, model: Any, data: Any, parts: Sequence[Share], welds: Sequence[Weld], connections: int
) -> None:
    """Activate a weld for each connection, and deactivate the others of the first ``connections`` equalities.

    A weld keeps the captured points of both bodies together, and the axes of the second body at a constant
    rotation relative to those of the first.
    """
    data.eq_active[:connections] = 0
    for k, (by, of, points, rotation) in enumerate(welds):
        model.eq_obj1id[k], model.eq_obj2id[k] = (parts[system].bodies[body] for system, body in (by, of))
        quat = np.empty(4)
        mujoco.mju_mat2Quat(quat, np.ascontiguousarray(rotation).ravel())
        pose = [*points[1], *points[0], *quat]  # in MuJoCo's order
        model.eq_data[k, : len(pose)] = pose
        data.eq_active[k] = 1


def exchanged(
    mujoco: ModuleType, model: Any, data: Any, parts: Sequence[Share], outer: Floats, connections: int
) -> Floats:
    """Return the wrenches and powers on each system, and the environment's moment on all systems.

    For each system: the environment's force and its torque about the centre of mass, the power of motors,
    springs and environment minus the power dissipated in the joints, the dissipated power, and the force,
    torque and power of its connections and contacts; closed loops and mimic joints count as joints. Then the
    moment of the environment's forces, acting at the centres of mass of the systems, about the common centre
    of mass. Axes of W; N, N m and W.
    """
    weld = np.zeros(model.nv)
    if data.eq_active[:connections].any() or data.ncon:
        kinds = mujoco.mjtConstraint
        touching = kinds.mjCNSTR_CONTACT_FRICTIONLESS, kinds.mjCNSTR_CONTACT_ELLIPTIC
        is_weld = np.logical_or.reduce([data.efc_type == kind for kind in map(int, touching)])
        # the number of a row of an equality is that of the equality
        is_weld |= (data.efc_type == int(kinds.mjCNSTR_EQUALITY)) & (data.efc_id < connections)
        mujoco.mj_mulJacTVec(model, data, weld, np.where(is_weld, data.efc_force, 0.0))
    inner = data.qfrc_constraint - weld
    motors, joints = data.qfrc_smooth + data.qfrc_bias + inner, data.qfrc_damper + inner
    found, forces, centers, masses = [], [], [], []
    for part in parts:
        base, velocity = part.bodies[0], data.qvel[part.velocities]
        center, wrench = data.subtree_com[base], outer[part.rows]
        force, own = wrench[:, :3], part.velocities
        moment = wrench[:, 3:] + cross(data.xipos[part.bodies] - center, force)
        pull, arm = weld[part.linear], data.qpos[part.origin] - center
        turn = data.xmat[base].reshape(3, 3) @ weld[part.angular] + cross(arm, pull)
        powers = motors[own] @ velocity, -joints[own] @ velocity
        found += [force.sum(axis=0), moment.sum(axis=0), powers, pull, turn, [weld[own] @ velocity]]
        forces.append(force.sum(axis=0))
        centers.append(center)
        masses.append(model.body_subtreemass[base])
    middle = np.array(masses) @ centers / sum(masses)
    return np.concatenate([*found, cross(np.array(centers) - middle, np.array(forces)).sum(axis=0)])


def cross(a: Floats, b: Floats) -> Floats:
    """Return `a × b` along the last axis, several times as fast as NumPy."""
    product: Floats = a[..., _YZX] * b[..., _ZXY] - a[..., _ZXY] * b[..., _YZX]
    return product
