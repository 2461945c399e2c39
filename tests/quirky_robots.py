"""Generates random robots as URDF texts with the quirks of many authors; Pinocchio reads all of them."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from onorbit_rs.tools.validation.trees import Array

MOVING = ("revolute", "continuous", "prismatic")
STYLES = ("link_{}", "Link {}", "/ns/link.{}", "звено_{}", "{}")
FOREIGN = (
    '<gazebo reference="{0}"><material>Gazebo/Grey</material><link name="ghost"/></gazebo>',
    '<transmission name="t"><joint name="{0}"/><actuator name="m"/></transmission>',
    '<ros2_control name="r" type="system"><joint name="{0}"/></ros2_control>',
    '<sensor name="eye"><parent link="{0}"/><origin xyz="1 2 3"/></sensor>',
    "<drake:collision_filter_group><drake:member link='{0}'/></drake:collision_filter_group>",
    '<xacro:property name="width" value="0.2"/>',
    "<!-- <link name='ghost'/> -->",
    '<loop_joint name="l" type="spherical"><link1 link="{0}"/></loop_joint>',
)
SHAPES = (
    '<box size="0.1 0.2 0.3"/>', '<sphere radius="0"/>',
    '<mesh filename="package://nowhere/a.stl" scale="1 -1 1"/>', "",
)  # fmt: skip


@dataclass
class Robot:
    """Elements of a robot, in the order in which they are generated."""

    rng: np.random.Generator
    elements: list[str] = field(default_factory=list)
    names: list[str] = field(default_factory=list)
    heavy: list[str] = field(default_factory=list)  # links whose body has a mass

    def draw(self, options: Any) -> Any:
        return options[self.rng.integers(len(options))]

    def numbers(self, size: float, count: int = 3) -> str:
        """Return random numbers as programs print them: all digits, six digits, or with an exponent."""
        form = self.draw(("{!r}", "{:.6g}", "{:+.8e}"))
        return "  ".join(form.format(float(x)) for x in self.rng.uniform(-size, size, count))

    def shuffled(self, *elements: str) -> str:
        return "".join(elements[i] for i in self.rng.permutation(len(elements)))

    def origin(self, size: float) -> str:
        rpy = f' rpy="{self.numbers(3.0)}"' if self.rng.random() < 0.7 else ""
        return f'<origin xyz="{self.numbers(size)}"{rpy}/>'

    def perhaps_origin(self, size: float) -> str:
        return self.draw((self.origin(size),) * 5 + ("", "<origin/>"))

    def link(self, inertial: str) -> str:
        name = self.draw(STYLES).format(len(self.names))
        visuals = [f"<visual><geometry>{self.draw(SHAPES)}</geometry></visual>"] * int(self.rng.integers(3))
        self.elements.append(f'<link name="{name}">{self.shuffled(inertial, *visuals)}</link>')
        self.names.append(name)
        return name

    def inertial(self) -> str:
        """Return the inertial of a random cloud of points, which is physically valid."""
        mass = float(np.exp(self.rng.uniform(np.log(0.1), np.log(20))))
        points = self.rng.normal(scale=0.2, size=(6, 3))
        second = np.cov(points.T, bias=True)
        return self.written(mass, mass * (np.trace(second) * np.eye(3) - second))

    def written(self, mass: float, inertia: Array) -> str:
        pairs = [(i, j) for i in range(3) for j in range(i, 3)]
        entries = " ".join(f'i{"xyz"[i]}{"xyz"[j]}="{inertia[i, j]:.9g}"' for i, j in pairs)
        parts = (f'<mass value="{mass!r}"/>', f"<inertia {entries}/>", self.perhaps_origin(0.2))
        return f"<inertial>{self.shuffled(*parts)}</inertial>"

    def joint(self, parent: str, child: str, kind: str, axis: str | None = None) -> None:
        origin = self.origin(2.0) if parent == "world" else self.perhaps_origin(0.4)
        parts = [f'<parent link="{parent}"/>', f'<child link="{child}"/>', origin]
        if kind != "fixed":
            drawn = self.draw(("1 0 0", "0 -1 0", "0 0 2", self.numbers(1.0), None))
            parts += [f'<axis xyz="{axis or drawn}"/>'] if axis or drawn else []
        if kind in ("revolute", "prismatic"):
            parts.append(self.draw((
                '<limit effort="9" velocity="1"/>',
                '<limit lower="-1e16" upper="1e16" effort="1e3" velocity="2"/>',
                '<limit upper="0.5" effort="0" velocity="0"/>',
            )))  # fmt: skip
        if kind != "fixed" and self.rng.random() < 0.3:
            extra = (
                '<dynamics damping="0.5"/>',
                '<calibration rising="0"/>',
                '<drake:rotor_inertia value="1"/>',
            )
            parts.append(self.draw(extra))
        # a link and a joint may share a name
        name = f"{parent} to {child}" if self.rng.random() < 0.5 else child
        self.elements.append(f'<joint name="{name}" type="{kind}">{self.shuffled(*parts)}</joint>')

    def add_fixed(self) -> None:
        """Add a frame, a part of a body that has a mass, or a further rigid part, by a fixed joint."""
        parent = self.draw(self.heavy)
        nothing, spin = np.zeros((3, 3)), np.diag([1e-3, 1e-3, 2e-3])
        inertial = self.draw(("", self.written(0, nothing), self.written(0, spin), self.inertial()))
        child = self.link(inertial)
        self.heavy.append(child)
        self.joint(parent, child, "fixed")

    def add_moving(self) -> None:
        """Add a moving body, sometimes below a massless link that turns about another axis."""
        parent = self.draw(self.heavy[-4:])
        kind, axis = self.draw(MOVING), None
        if self.rng.random() < 0.15:
            yoke = self.link("")
            self.joint(parent, yoke, "revolute", "1 0 0")
            parent, kind, axis = yoke, "continuous", "0 1 0"
        child = self.link(self.inertial())
        self.heavy.append(child)
        self.joint(parent, child, kind, axis)


def text(seed: int, links: int = 12, root: str = "body") -> str:
    """Return a robot with this number of links or one more.

    The ``root`` is a ``body``, or a massless link with one (``world``) or two (``world of two``) bodies.
    """
    robot = Robot(np.random.default_rng(seed))
    if root == "body":
        robot.heavy.append(robot.link(robot.inertial()))
    else:
        world = f'<link name="world">{robot.draw(("", robot.written(0, np.zeros((3, 3)))))}</link>'
        robot.elements.append(world)
        for _ in range(1 + (root == "world of two")):
            robot.heavy.append(robot.link(robot.inertial()))
            robot.joint("world", robot.heavy[-1], "fixed")
    while len(robot.names) < links:
        robot.draw((robot.add_fixed, robot.add_moving, robot.add_moving))()
    foreign = [robot.draw(FOREIGN).format(robot.draw(robot.names)) for _ in range(links // 4)]
    elements = [*robot.elements, *foreign]
    if robot.rng.random() < 0.7:
        elements = [elements[i] for i in robot.rng.permutation(len(elements))]
    return '<?xml version="1.0"?>\n<robot name="quirky">\n' + "\n".join(elements) + "\n</robot>\n"
