"""Pairs of random trees attached by random frames, with states of equal motion apart and attached."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

import onorbit_rs as oo
from onorbit_rs.tools.validation.trees import Array, Part, Tree, build, random_tree

SEEDS = range(20)
PREFIX = "b_"


def moving_links(tree: Tree) -> list[Part]:
    """Returns the links that at least one joint moves relative to the base."""
    moves = {tree.parts[0].name: False}
    for part in tree.parts[1:]:
        moves[part.name] = moves[str(part.parent)] or part.kind != "fixed"
    return [part for part in tree.parts if moves[part.name]]


def drawn(seed: int, links: int) -> Tree:
    """Returns a random tree whose tool frame is on a random moving link, with a random offset."""
    tree = random_tree(seed, links)
    links_of_tool = moving_links(tree)
    return replace(
        tree, tool_link=links_of_tool[np.random.default_rng(seed).integers(len(links_of_tool))].name
    )


def prefixed(tree: Tree) -> oo.Model:
    """Returns the model of a tree with ``PREFIX`` before the names of links, joints and tool, as attached."""
    base = tree.parts[0]
    builder = oo.ModelBuilder(
        "part", base=PREFIX + base.name, mass=base.mass, com=base.com, inertia=base.inertia
    )
    add_parts(builder, tree, PREFIX)
    return builder.build()


def add_parts(builder: oo.ModelBuilder, tree: Tree, prefix: str) -> None:
    """Adds all links of a tree except its base, and its tool frame, with ``prefix`` before their names."""
    for part in tree.parts[1:]:
        builder.add_link(
            prefix + part.name, parent=f"{prefix}{part.parent}", joint=prefix + part.joint,
            kind=part.kind, axis=part.axis, xyz=part.xyz, rpy=part.rpy,  # type: ignore[arg-type]
            mass=part.mass, com=part.com, inertia=part.inertia, rotor_inertia=part.rotor_inertia,
        )  # fmt: skip
    builder.add_frame(f"{prefix}tool", prefix + tree.tool_link, xyz=tree.tool_xyz, rpy=tree.tool_rpy)


@dataclass(frozen=True)
class Pair:
    """Robots A and B, the tree of both, and states of all three with the same motion of every link.

    Frame `b_tool` of B has the pose `pose` in frame `tool` of A, and no velocity relative to it.
    """

    tree_a: Tree
    tree_b: Tree
    a: oo.Model
    b: oo.Model
    both: oo.Model
    pose: Array
    state_a: tuple[Array, Array]
    state_b: tuple[Array, Array]
    state: tuple[Array, Array]


def transform(rng: np.random.Generator) -> Array:
    """Returns a random rigid transform (4, 4)."""
    made = np.eye(4)
    made[:3, :3] = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    made[:3, 0] *= np.linalg.det(made[:3, :3])
    made[:3, 3] = rng.uniform(-0.5, 0.5, 3)
    return made


def quaternion(rot: Array) -> Array:
    """Returns the quaternion (x, y, z, w) of a rotation: the eigenvector of Bar-Itzhack's matrix."""
    xx, xy, xz, yx, yy, yz, zx, zy, zz = rot.ravel()
    k = np.array([
        [xx - yy - zz, xy + yx, xz + zx, zy - yz],
        [xy + yx, yy - xx - zz, yz + zy, xz - zx],
        [xz + zx, yz + zy, zz - xx - yy, yx - xy],
        [zy - yz, xz - zx, yx - xy, xx + yy + zz],
    ])  # fmt: skip
    vector: Array = np.linalg.eigh(k)[1][:, -1]
    return vector


def pair(seed: int) -> Pair:
    rng = np.random.default_rng(5000 + seed)
    tree_a, tree_b = drawn(seed, 8), drawn(100 + seed, 9)
    a, b, pose = build(tree_a), prefixed(tree_b), transform(rng)
    both = oo.attach(a, "tool", b, f"{PREFIX}tool", pose=pose)
    q_a = a.integrate(a.neutral(), rng.uniform(-1.5, 1.5, a.nv))
    v_a = rng.uniform(-1.0, 1.0, a.nv)
    # the base of B from the pose and the twist of the grasp
    q_b, v_b = b.neutral(), rng.uniform(-1.0, 1.0, b.nv)
    q_b[7:] = rng.uniform(-1.5, 1.5, b.nv - 6)
    grasp = a.frame_pose(q_a, "tool") @ pose
    base = grasp @ np.linalg.inv(b.frame_pose(q_b, f"{PREFIX}tool"))
    q_b[:7] = [*base[:3, 3], *quaternion(base[:3, :3])]
    twist = np.array(a.frame_velocity(q_a, v_a, "tool"))
    twist[:3] += np.cross(twist[3:], grasp[:3, 3] - a.frame_pose(q_a, "tool")[:3, 3])
    jacobian = b.frame_jacobian(q_b, f"{PREFIX}tool")
    v_b[:6] = np.linalg.solve(jacobian[:, :6], twist - jacobian[:, 6:] @ v_b[6:])
    q, v = both.neutral(), np.zeros(both.nv)
    q[:7], v[:6] = q_a[:7], v_a[:6]
    for part, (part_q, part_v) in ((a, (q_a, v_a)), (b, (q_b, v_b))):
        places = [both.joint_names.index(name) for name in part.joint_names]
        q[7:][places], v[6:][places] = part_q[7:], part_v[6:]
    return Pair(tree_a, tree_b, a, b, both, pose, (q_a, v_a), (q_b, v_b), (q, v))
