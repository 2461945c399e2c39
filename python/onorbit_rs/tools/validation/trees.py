"""Random robots as plain data, and their conversion to a model and to URDF text."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

import onorbit_rs as oo
from onorbit_rs.common.coordinates import QUATERNION

Array = NDArray[np.float64]

KINDS = ("revolute", "continuous", "prismatic", "fixed")
BASE = "link0"
TOOL = "tool"


@dataclass(frozen=True)
class Part:
    """A link and its parent joint (None for the base), in SI; the inertia is about ``com``, in link axes."""

    name: str
    mass: float
    com: list[float]
    inertia: list[list[float]]
    parent: str | None = None
    joint: str = ""
    kind: str = ""
    axis: tuple[float, float, float] = (0.0, 0.0, 1.0)
    xyz: tuple[float, float, float] = (0.0, 0.0, 0.0)
    rpy: tuple[float, float, float] = (0.0, 0.0, 0.0)
    rotor_inertia: float = 0.0


@dataclass(frozen=True)
class Tree:
    """A robot: its parts, with the base first, and a tool frame at an offset from its link."""

    parts: list[Part]
    tool_link: str
    tool_xyz: tuple[float, float, float]
    tool_rpy: tuple[float, float, float]

    def as_dict(self) -> dict[str, Any]:
        """Return the robot as plain data for JSON."""
        return asdict(self)

    @staticmethod
    def of(data: dict[str, Any]) -> Tree:
        """Return the robot described by plain data."""
        return Tree(**(data | {"parts": [Part(**part) for part in data["parts"]]}))


@dataclass(frozen=True)
class State:
    """Arguments of the algorithms; ``external`` maps frames to wrenches at their origins in their axes."""

    q: Array
    v: Array
    a: Array
    tau: Array
    external: dict[str, Array]


def random_tree(seed: int, links: int = 12, rotors: bool = True) -> Tree:
    """Return a random robot with branches, skew and principal axes, all kinds of joints and some rotors."""
    rng = np.random.default_rng(seed)

    def triple(scale: float = 1.0) -> tuple[float, float, float]:
        x, y, z = rng.uniform(-scale, scale, 3).tolist()
        return (x, y, z)

    parts = [Part(BASE, *_inertial(rng))]
    kinds = [*KINDS, *rng.choice(KINDS, links - 1 - len(KINDS), p=(0.4, 0.2, 0.25, 0.15)).tolist()]
    rng.shuffle(kinds)
    for i, kind in enumerate(kinds, start=1):
        parent = BASE if i == 1 else f"link{rng.integers(max(0, i - 4), i)}"  # long chains and branches
        axis = triple() if rng.random() < 0.6 else tuple(rng.choice([-1.0, 1.0]) * np.eye(3)[rng.integers(3)])
        rotor = float(rng.uniform(0.01, 0.3)) if rotors and kind != "fixed" and rng.random() < 0.5 else 0.0
        parts.append(
            Part(
                f"link{i}", *_inertial(rng), parent=parent, joint=f"joint{i}", kind=kind,
                axis=tuple(map(float, axis)),  # type: ignore[arg-type] # three of them
                xyz=triple(0.5), rpy=triple(3.0), rotor_inertia=rotor,
            )
        )  # fmt: skip
    return Tree(parts, f"link{links - 1}", triple(0.3), triple(3.0))


def _inertial(rng: np.random.Generator) -> tuple[float, list[float], list[list[float]]]:
    """Return mass, kg, centre of mass, m, and inertia, kg m², of a random cloud of point masses."""
    mass = float(rng.uniform(0.5, 5.0))
    points = rng.normal(scale=0.2, size=(6, 3))
    points -= points.mean(axis=0)
    second = mass / 6 * points.T @ points
    inertia = np.trace(second) * np.eye(3) - second
    return mass, rng.uniform(-0.2, 0.2, 3).tolist(), ((inertia + inertia.T) / 2).tolist()


def random_state(model: oo.Model, rng: np.random.Generator, frames: int = 4) -> State:
    """Return a random state with wrenches on several links and on the tool."""
    q = rng.uniform(-2.0, 2.0, model.nq)
    q[QUATERNION] = rng.normal(size=4)
    q[QUATERNION] /= np.linalg.norm(q[QUATERNION])
    v, a, tau = rng.uniform(-2.0, 2.0, (3, model.nv))
    names = [str(name) for name in rng.choice(model.frame_names, frames, replace=False)]
    loaded = dict.fromkeys(
        [*names, model.frame_names[-1]]
    )  # unlike a set, a dict has the same order in every process
    external = {name: rng.uniform(-3.0, 3.0, 6) for name in loaded}
    return State(q, v, a, tau, external)


def build(tree: Tree) -> oo.Model:
    """Build the model with :class:`onorbit_rs.ModelBuilder`."""
    base, *others = tree.parts
    builder = oo.ModelBuilder("random", base=base.name, mass=base.mass, com=base.com, inertia=base.inertia)
    for part in others:
        assert part.parent is not None
        builder.add_link(
            part.name, parent=part.parent, joint=part.joint, kind=part.kind, axis=part.axis,  # type: ignore[arg-type]
            xyz=part.xyz, rpy=part.rpy, mass=part.mass, com=part.com, inertia=part.inertia,
            rotor_inertia=part.rotor_inertia,
        )  # fmt: skip
    builder.add_frame(TOOL, tree.tool_link, xyz=tree.tool_xyz, rpy=tree.tool_rpy)
    return builder.build()


def urdf(tree: Tree) -> str:
    """Return the robot as URDF text, without rotors; the tool is a link without inertia."""
    robot = ElementTree.Element("robot", name="random")
    for part in tree.parts:
        link = ElementTree.SubElement(robot, "link", name=part.name)
        inertial = ElementTree.SubElement(link, "inertial")
        ElementTree.SubElement(inertial, "origin", xyz=_text(part.com), rpy="0 0 0")
        ElementTree.SubElement(inertial, "mass", value=repr(part.mass))
        rows = part.inertia
        entries = {
            f"i{a}{b}": repr(rows[i][j]) for i, a in enumerate("xyz") for j, b in enumerate("xyz") if i <= j
        }
        ElementTree.SubElement(inertial, "inertia", entries)
    for part in tree.parts[1:]:
        assert part.parent is not None
        axis = np.array(part.axis) / np.linalg.norm(part.axis)  # other URDF readers do not normalize axes
        _joint(robot, part.joint, part.kind, part.parent, part.name, part.xyz, part.rpy, axis.tolist())
    ElementTree.SubElement(robot, "link", name=TOOL)
    _joint(robot, "tool_mount", "fixed", tree.tool_link, TOOL, tree.tool_xyz, tree.tool_rpy, None)
    return ElementTree.tostring(robot, encoding="unicode")


def _joint(
    robot: ElementTree.Element,
    name: str,
    kind: str,
    parent: str,
    child: str,
    xyz: tuple[float, ...],
    rpy: tuple[float, ...],
    axis: list[float] | None,
) -> None:
    joint = ElementTree.SubElement(robot, "joint", name=name, type=kind)
    ElementTree.SubElement(joint, "parent", link=parent)
    ElementTree.SubElement(joint, "child", link=child)
    ElementTree.SubElement(joint, "origin", xyz=_text(xyz), rpy=_text(rpy))
    if axis is not None and kind != "fixed":
        ElementTree.SubElement(joint, "axis", xyz=_text(axis))
    if kind in ("revolute", "prismatic"):
        ElementTree.SubElement(joint, "limit", lower="-3", upper="3", velocity="10", effort="100")


def _text(numbers: list[float] | tuple[float, ...]) -> str:
    return " ".join(repr(float(x)) for x in numbers)


def deviation(ours: Any, theirs: Any) -> float:
    """Return the largest difference divided by the largest entry of ``theirs``.

    If all entries of ``theirs`` are zero, the result is 0, infinite or NaN.
    """
    ours, theirs = np.asarray(ours), np.asarray(theirs)
    assert ours.shape == theirs.shape, (ours.shape, theirs.shape)
    if not theirs.size:
        return 0.0  # for example the Jacobian of a robot without joints
    off, size = float(np.abs(ours - theirs).max()), float(np.abs(theirs).max())
    if size == 0.0:
        return off if off == 0.0 or np.isnan(off) else float("inf")
    return off / size
