"""Compares accelerations and poses of articulated bodies with values from the tests of other libraries."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

import onorbit_rs as oo
from onorbit_rs.common.coordinates import JOINTS_Q, JOINTS_V
from onorbit_rs.common.rotations import quaternion_from_matrix
from onorbit_rs.tools.validation.case import Case, Gate

RBDL = "RBDL, tests/DynamicsTests.cc (INRIA HuMAnS, Featherstone's spatial_v1)"
RBDL_BASE = "RBDL, tests/FloatingBaseTests.cc"
DRAKE = "Drake, multibody/benchmarks/kuka_iiwa_robot (MotionGenesis)"
GRAVITY = 9.81  # m/s², downwards along y

X, Y, Z = np.eye(3).tolist()
Link = tuple[str, Any, Any, Any]
"""Parent, axis and position of the joint in the parent's axes, m, and centre of mass in the link's axes, m
(None for a massless link)."""

# q̈ from rest under gravity; unit masses, unit moments about each centre of mass
CHAINS: dict[str, tuple[list[Link], list[float], list[float]]] = {
    "two links": ([("base", Z, [0, 0, 0], X), ("1", Z, X, X)], [0, 0], [-5.886, 3.924]),
    "three links": (
        [("base", Z, [0, 0, 0], X), ("1", Z, X, X), ("2", Z, X, X)],
        [0, 0, 0],
        [-6.03692307692308, 3.77307692307692, 1.50923076923077],
    ),
    "a tree of five": (
        [
            ("base", Z, [0, 0, 0], X), ("1", Y, X, Y), ("2", X, Y, Z),
            ("1", Y, [-0.5, 0, 0], Y), ("4", X, [0, -0.5, 0], Z),
        ],
        [0, 0, 0, 0, 0],
        [-1.6031906614786, -0.534396887159533, 4.1034046692607, 0.267198443579767, 5.30579766536965],
    ),
    "a ball joint": (
        [("base", Z, [0, 0, 0], None), ("1", Y, [0, 0, 0], None), ("2", X, [0, 0, 0], [0, 0.5, 0])],
        [1, 0, 0],
        [3.301932144386186, 0, 0],
    ),
}  # fmt: skip


def chain(name: str) -> tuple[float]:
    """Return the largest relative error of the joint accelerations `q̈` of a chain on a fixed base.

    The fixed base under gravity is modelled as a base that accelerates upwards without gravity.
    """
    links, angles, expected = CHAINS[name]
    builder = oo.ModelBuilder(name, base="base", mass=1.0, com=[0, 0, 0], inertia=np.eye(3))
    for number, (parent, axis, place, com) in enumerate(links, 1):
        body: Any = {} if com is None else {"mass": 1.0, "com": com, "inertia": np.eye(3)}
        builder.add_link(str(number), parent=parent, joint=f"j{number}", axis=axis, xyz=place, **body)
    model = builder.build()
    q = model.neutral()
    q[JOINTS_Q] = angles
    held = np.zeros(model.nv)
    held[1] = GRAVITY
    torque = model.inverse_dynamics(q, np.zeros(model.nv), held)[JOINTS_V]
    found = -np.linalg.solve(model.mass_matrix(q)[JOINTS_V, JOINTS_V], torque)
    return (float(np.abs(found - expected).max() / np.abs(expected).max()),)


def free_link() -> tuple[float]:
    """Return the largest error of the acceleration of a link on a floating base for a joint torque of 1 N m.

    RBDL's result with gravity is `(0, -8.81, 0, -1, 0, 0, 2)`; its coordinates are the translations along x,
    y and z, the rotations about z, y and x, and the joint.
    """
    builder = oo.ModelBuilder("rbdl", base="base", mass=1.0, com=X, inertia=np.eye(3))
    builder.add_link("link", parent="base", joint="hinge", xyz=[2, 0, 0], mass=1.0, com=X, inertia=np.eye(3))
    model = builder.build()
    found = model.forward_dynamics(model.neutral(), np.zeros(7), [0, 0, 0, 0, 0, 0, 1.0])
    expected = np.array([0, -8.81 + GRAVITY, 0, 0, 0, -1, 2])
    return (float(np.abs(found - expected).max()),)


# Tx, Ty, Tz, Rz, Ry, Rx; the rates have the same values
FREE_Q = np.array([0.1, 1.1, 1.2, 1.3, 1.5, 1.7])
POINT, OTHER = [-1.9, -1.8, 0.0], [1.0, 0.0, 0.0]
POINT_POSITION = [-0.6357089363622626, -0.6831041744630977, 2.968974805916970]
POINT_VELOCITY = [0.3091226260907569, 3.891012095550828, 4.100277995030419]
OTHER_VELOCITY = [-0.3888503432977729, -0.3171179347202455, 1.093894197498446]


def free_point() -> tuple[float, float]:
    """Return the largest errors in position, m, and velocity, m/s, of points of a floating body."""
    (cz, cy, cx), (sz, sy, sx) = np.cos(FREE_Q[3:]), np.sin(FREE_Q[3:])
    about_z = np.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]])
    about_y = np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    about_x = np.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]])
    rot_wb = about_z @ about_y @ about_x
    axes_w = np.stack([[0, 0, 1], about_z[:, 1], (about_z @ about_y)[:, 0]], axis=1)
    builder = oo.ModelBuilder("rbdl", base="base", mass=1.0, com=Y, inertia=np.eye(3))
    builder.add_frame("point", "base", xyz=POINT)
    builder.add_frame("other", "base", xyz=OTHER)
    model = builder.build()
    q = np.concatenate([FREE_Q[:3], quaternion_from_matrix(rot_wb)])
    v = np.concatenate([rot_wb.T @ FREE_Q[:3], rot_wb.T @ axes_w @ FREE_Q[3:]])
    position = model.frame_pose(q, "point")[:3, 3] - POINT_POSITION
    moves = [
        model.frame_velocity(q, v, name)[:3] - np.array(expected)
        for name, expected in (("point", POINT_VELOCITY), ("other", OTHER_VELOCITY))
    ]
    return float(np.abs(position).max()), float(np.abs(moves).max())


# pose of each joint of the iiwa 14 on the previous link: xyz in m; roll, pitch, yaw in quarter turns
IIWA = [
    ([0, 0, 0.1575], [0, 0, 0]), ([0, 0, 0.2025], [1, 0, 2]), ([0, 0.2045, 0], [1, 0, 2]),
    ([0, 0, 0.2155], [1, 0, 0]), ([0, 0.1845, 0], [-1, 2, 0]), ([0, 0, 0.2155], [1, 0, 0]),
    ([0, 0.081, 0], [-1, 2, 0]),
]  # fmt: skip
IIWA_DEGREES = [60, 30, 60, 30, 60, 30, 60]
IIWA_POSITION = [0.2970356451892219, 0.1727696964662288, 1.154681973689345]
IIWA_ROTATION = [
    [-0.5939002959880204, 0.8043869080239565, -0.015625],
    [-0.8043869080239565, -0.5932991120359317, 0.03094940802395521],
    [0.015625, 0.03094940802395527, 0.9993988160479114],
]


def iiwa() -> tuple[float, float]:
    """Return the largest errors of the flange's position, m, and of its rotation matrix."""
    builder = oo.ModelBuilder("iiwa", base="0", mass=1.0, com=[0, 0, 0], inertia=np.eye(3))
    for number, (xyz, quarters) in enumerate(IIWA, 1):
        builder.add_link(
            str(number), parent=str(number - 1), joint=f"j{number}", axis=Z, xyz=xyz,
            rpy=(np.array(quarters) * np.pi / 2).tolist(), mass=1.0, com=[0, 0, 0], inertia=np.eye(3),
        )  # fmt: skip
    model = builder.build()
    q = model.neutral()
    q[JOINTS_Q] = np.radians(IIWA_DEGREES)
    pose = model.frame_pose(q, "7")
    return (
        float(np.abs(pose[:3, 3] - IIWA_POSITION).max()),
        float(np.abs(pose[:3, :3] - IIWA_ROTATION).max()),
    )


CASES = (
    *(
        Case("bodies", f"{name} on a fixed base", RBDL, (Gate("acceleration", 1e-12),), partial(chain, name))
        for name in CHAINS
    ),
    Case(
        "bodies", "a link on a floating base", RBDL_BASE,
        (Gate("acceleration", 1e-14, "m/s2, rad/s2"),), free_link,
    ),
    Case(
        "bodies", "points of a floating body", RBDL_BASE,
        (Gate("position", 1e-14, "m"), Gate("velocity", 1e-14, "m/s")), free_point,
    ),
    Case(
        "bodies", "the flange of an iiwa 14", DRAKE,
        (Gate("position", 1e-14, "m"), Gate("rotation", 1e-14)), iiwa,
    ),
)  # fmt: skip
