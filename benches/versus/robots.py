"""Common robot of all programs: the bundled humanoid with one arm (nv = 13) or two arms (nv = 20).

Every number comes from the bundled URDF (Table 1 of the OnOrbitROS paper). The second arm is a copy of the
first arm, mounted on the other side. All joints rotate about x, y or z, for which Pinocchio has its fastest
joint types.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from xml.etree import ElementTree as xml

import numpy as np
from numpy.typing import NDArray

import onorbit_rs as oo

Array = NDArray[np.float64]

BUNDLED = Path(oo.robots.__file__).parent / "humanoid_torso.urdf"
REACH = np.array([0.5342, -2.341, -2.0077, -2.2249, -2.2693, -0.1342, -0.1974])  # humanoid_reach's joints


@dataclass
class Body:
    """Mass, kg, centre of mass, m, and inertia about the centre of mass (xx xy xz yy yz zz), kg m²."""

    mass: float
    com: list[float]
    inertia: list[float]

    def numbers(self) -> list[float]:
        return [self.mass, *self.com, *self.inertia]


@dataclass
class Joint:
    """Revolute joint about the axis x, y or z of its parent, at ``xyz``, m, with its child body.

    ``parent`` is the index of the parent body.
    """

    parent: int
    axis: str
    xyz: list[float]
    body: Body


@dataclass
class Robot:
    """Robot with a tool frame at ``tool_xyz``, m, on the body ``tool``.

    Body 0 is the base, and body ``k`` is the child of joint ``k - 1`` in ``joints``.
    """

    base: Body
    joints: list[Joint] = field(default_factory=list)
    tool: int = 0
    tool_xyz: list[float] = field(default_factory=list)

    @property
    def nv(self) -> int:
        return 6 + len(self.joints)


def floats(element: xml.Element | None, name: str) -> list[float]:
    assert element is not None
    return [float(x) for x in element.attrib[name].split()]


def humanoid(arms: int) -> Robot:
    """Reads the robot from the bundled URDF and returns it with the given number of arms, 1 or 2."""
    root = xml.parse(BUNDLED).getroot()
    bodies = {
        link.attrib["name"]: read_body(link)
        for link in root.iter("link")
        if link.find("inertial") is not None
    }
    robot = Robot(bodies["torso"])
    for arm in range(arms):
        index = {"torso": 0}
        for joint in root.iter("joint"):
            parent, child = (str(joint.find(tag).attrib["link"]) for tag in ("parent", "child"))  # type: ignore[union-attr]
            origin = joint.find("origin")
            assert origin is not None
            assert "rpy" not in origin.attrib
            xyz = floats(origin, "xyz")
            if joint.attrib["type"] == "fixed":
                if arm == 0:
                    robot.tool, robot.tool_xyz = index[parent], xyz
                continue
            if parent == "torso" and arm == 1:
                xyz[1] = -xyz[1]
            axis = "xyz"[floats(joint.find("axis"), "xyz").index(1.0)]
            robot.joints.append(Joint(index[parent], axis, xyz, bodies[child]))
            index[child] = len(robot.joints)
    return robot


def read_body(link: xml.Element) -> Body:
    inertial = link.find("inertial")
    assert inertial is not None
    mass, inertia = inertial.find("mass"), inertial.find("inertia")
    assert mass is not None
    assert inertia is not None
    moments = [float(inertia.attrib[name]) for name in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")]
    return Body(float(mass.attrib["value"]), floats(inertial.find("origin"), "xyz"), moments)


def text(numbers: list[float]) -> str:
    return " ".join(repr(x) for x in numbers)


def unit(axis: str) -> str:
    return " ".join("1" if letter == axis else "0" for letter in "xyz")


def urdf(robot: Robot, collision: str = "", frames: str = "") -> str:
    """Returns the robot as URDF, with the elements `collision` in the base link and `frames` in the robot."""

    def link(name: str, body: Body, collision: str = "") -> str:
        names = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
        moments = " ".join(f'{name}="{x!r}"' for name, x in zip(names, body.inertia, strict=True))
        inertial = f'<origin xyz="{text(body.com)}"/><mass value="{body.mass!r}"/><inertia {moments}/>'
        return f'<link name="{name}"><inertial>{inertial}</inertial>{collision}</link>'

    def ends(parent: int, child: str, xyz: list[float]) -> str:
        return f'<parent link="body0{parent}"/><child link="{child}"/><origin xyz="{text(xyz)}"/>'

    limit = '<limit lower="-99" upper="99" effort="999" velocity="99"/>'
    lines = ['<robot name="humanoid">', link("body00", robot.base, collision)]
    for k, joint in enumerate(robot.joints, 1):
        lines.append(link(f"body0{k}", joint.body))
        lines.append(
            f'<joint name="joint{k}" type="revolute">{ends(joint.parent, f"body0{k}", joint.xyz)}'
            f'<axis xyz="{unit(joint.axis)}"/>{limit}</joint>'
        )
    tool = ends(robot.tool, "tool", robot.tool_xyz)
    return "\n".join(
        [*lines, '<link name="tool"/>', f'<joint name="tool" type="fixed">{tool}</joint>', frames, "</robot>"]
    )


def table(robot: Robot) -> str:
    """Returns the robot in the text format that ``benches/peers/robot.hpp`` reads."""
    lines = [str(len(robot.joints)), text(robot.base.numbers())]
    lines += [f"{j.parent} {j.axis} {text(j.xyz)} {text(j.body.numbers())}" for j in robot.joints]
    return "\n".join([*lines, f"{robot.tool} {text(robot.tool_xyz)}\n"])


def mjcf(robot: Robot) -> str:
    """Returns the robot as MJCF with a free base and hinges, without collision geometry."""
    settings = '<option timestep="0.001" gravity="0 0 0" integrator="RK4"/>'
    return f"<mujoco>{ANGLES}{settings}<worldbody>{mjcf_bodies(robot)}</worldbody></mujoco>"


ANGLES = '<compiler angle="radian" autolimits="false"/>'


def mjcf_bodies(robot: Robot, prefix: str = "", geoms: str = "") -> str:
    """Returns the bodies in MJCF, with names that begin with `prefix` and with `geoms` on the base."""

    def body(k: int, xyz: list[float], mass: Body, inside: str) -> str:
        order = [mass.inertia[i] for i in (0, 3, 5, 1, 2, 4)]
        inertial = f'<inertial pos="{text(mass.com)}" mass="{mass.mass!r}" fullinertia="{text(order)}"/>'
        below = "".join(hinge(i) for i, j in enumerate(robot.joints, 1) if j.parent == k)
        return f'<body name="{prefix}body0{k}" pos="{text(xyz)}">{inside}{inertial}{below}</body>'

    def hinge(k: int) -> str:
        joint = robot.joints[k - 1]
        element = f'<joint name="{prefix}joint{k}" type="hinge" axis="{unit(joint.axis)}"/>'
        return body(k, joint.xyz, joint.body, element)

    return body(0, [0.0, 0.0, 0.0], robot.base, "<freejoint/>" + geoms)
