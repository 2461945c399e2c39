"""Humanoid with both hands on one load, which is part of the first hand and is welded to the second hand."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import robots
from robots import REACH, Array, Body, Robot

import onorbit_rs as oo

LOAD = Body(40.0, [0.1, 0.2, 0.3], [1.5, 0.1, -0.2, 1.8, 0.05, 1.2])  # in the axes of the first hand
HANDS = 7, 14  # bodies
SPREAD = 0.2  # rad, of the joints about humanoid_reach's configuration
SEED = 6


def write(folder: Path, robot: Robot, count: int) -> None:
    """Writes the robot as URDF and as a table, both grips, and `count` states that close the loop."""
    hand = robot.joints[HANDS[0] - 1]
    joints = list(robot.joints)
    joints[HANDS[0] - 1] = replace(hand, body=joined(hand.body, LOAD))
    loaded = replace(robot, joints=joints)
    # where the second hand is in the first one in humanoid_reach's configuration
    (folder / "held.urdf").write_text(robots.urdf(loaded))
    model = oo.Model.from_urdf(folder / "held.urdf")
    q = model.neutral()
    q[7:] = np.tile(REACH, 2)
    first, second = (np.array(model.frame_pose(q, f"body0{hand}")) for hand in HANDS)
    grips = [np.linalg.solve(first, second), np.eye(4)]
    frames = "".join(grip(name, body, pose) for name, body, pose in zip("ab", HANDS, grips, strict=True))
    (folder / "held.urdf").write_text(robots.urdf(loaded, frames=frames))
    (folder / "held.txt").write_text(robots.table(loaded))
    (folder / "grips.txt").write_text(
        "\n".join(
            f"{body} {robots.text([*pose[:3, :3].ravel().tolist(), *pose[:3, 3].tolist()])}"
            for body, pose in zip(HANDS, grips, strict=True)
        )
    )
    model = oo.Model.from_urdf(folder / "held.urdf").with_loops([oo.Loop("weld", "weld", "grip_a", "grip_b")])
    np.hstack(closed_states(model, q, count)).tofile(folder / "held.bin")


def joined(a: Body, b: Body) -> Body:
    """Returns the body that consists of two rigidly connected bodies, which are given in the same axes."""
    mass, coms = a.mass + b.mass, [np.array(body.com) for body in (a, b)]
    com = (a.mass * coms[0] + b.mass * coms[1]) / mass
    inertia = np.zeros((3, 3))
    for body, at in zip((a, b), coms, strict=True):
        xx, xy, xz, yy, yz, zz = body.inertia
        arm = at - com
        inertia += np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        inertia += body.mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    return Body(mass, com.tolist(), inertia[np.triu_indices(3)].tolist())


def grip(name: str, body: int, pose: Array) -> str:
    """Returns the URDF elements of a frame on the body with index `body` at `pose`, (4, 4).

    The angles of URDF are those of Rz(yaw) Ry(pitch) Rx(roll).
    """
    rot = pose[:3, :3]
    angles = [
        np.arctan2(rot[2, 1], rot[2, 2]),
        np.arctan2(-rot[2, 0], np.hypot(rot[2, 1], rot[2, 2])),
        np.arctan2(rot[1, 0], rot[0, 0]),
    ]
    origin = f'xyz="{robots.text(pose[:3, 3].tolist())}" rpy="{robots.text([float(x) for x in angles])}"'
    return (
        f'<link name="grip_{name}"/><joint name="grip_{name}" type="fixed"><parent link="body0{body}"/>'
        f'<child link="grip_{name}"/><origin {origin}/></joint>'
    )


def closed_states(model: oo.Model, near: Array, count: int) -> tuple[Array, Array, Array]:
    """Returns `count` random configurations and velocities that close the loop, and random efforts.

    The joint positions are near those of the configuration `near`.
    """
    rng = np.random.default_rng(SEED)
    q, v, x = np.tile(near, (count, 1)), *rng.uniform(-1.0, 1.0, (2, count, model.nv))
    q[:, :7] = rng.uniform(-1.0, 1.0, (count, 7))
    q[:, 3:7] /= np.linalg.norm(q[:, 3:7], axis=1, keepdims=True)
    q[:, 7:] += rng.uniform(-SPREAD, SPREAD, (count, model.nv - 6))
    for k in range(count):
        q[k] = model.closed_configuration(q[k])
        v[k] = model.closed_velocity(q[k], v[k])
    return q, v, x
