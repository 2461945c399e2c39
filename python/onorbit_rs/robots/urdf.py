"""Writes a robot as URDF."""

from __future__ import annotations

from typing import TYPE_CHECKING
from xml.etree import ElementTree as xml

import numpy as np

from onorbit_rs.common.rotations import quaternion_from_matrix, roll_pitch_yaw
from onorbit_rs.exceptions import ModelError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import ArrayLike

    from onorbit_rs._core import Body, Frame, Joint, Model, Visual


_WITHOUT_ELEMENT = "half_space", "hull", "cone", "torus"
"""Kinds of shapes for which URDF has no element."""


def urdf_text(model: Model, names: Mapping[str, str] | None = None) -> str:
    """Return the URDF of a robot; named frames become links without mass.

    Lengths and angles are written in full precision. Paths of meshes are absolute. Cones, tori, half-spaces,
    convex pieces of meshes, closed loops, static friction and rotor inertia are omitted, because URDF has no
    elements for them. Capsules and the springs of joints are written as the elements ``<capsule>`` and
    ``<spring>``, extensions that other readers of URDF may not know.

    Parameters
    ----------
    model : Model
        Robot to be written.
    names : mapping of str to str, optional
        Names of links and frames in the text, by their names in the model; default: unchanged.

    Raises
    ------
    ModelError
        If the axis of a joint does not pass through the origin of its child link, which URDF cannot express
        (a joint that ``Model.rerooted`` or ``attach`` reversed).
    """
    named = {name: name for name in _all_names(model)} | dict(names or {})
    robot = xml.Element("robot", name=model.name)
    shapes = [("visual", shape) for shape in model.visuals]
    shapes += [("collision", shape) for shape in model.collisions]
    shapes = [(tag, shape) for tag, shape in shapes if shape.kind not in _WITHOUT_ELEMENT]
    for body in model.bodies:
        link = _link(robot, named, body.name, shapes)
        _add_inertial(link, body)
    for joint in model.joints:
        _add_joint(robot, named, joint)
    links = {body.name for body in model.bodies}
    for frame in model.frames:
        if frame.name not in links:
            _link(robot, named, frame.name, shapes)
            _add_fixed(robot, named, frame)
    xml.indent(robot)
    return xml.tostring(robot, encoding="unicode") + "\n"


def _all_names(model: Model) -> list[str]:
    """Return the names of the links and frames."""
    return [body.name for body in model.bodies] + [frame.name for frame in model.frames]


def _text(numbers: ArrayLike) -> str:
    return " ".join(repr(float(number)) for number in np.ravel(numbers))


def _add_origin(to: xml.Element, pose: ArrayLike) -> None:
    matrix = np.asarray(pose)
    angles = roll_pitch_yaw(quaternion_from_matrix(matrix[:3, :3]))
    xml.SubElement(to, "origin", xyz=_text(matrix[:3, 3]), rpy=_text(angles))


def _link(
    robot: xml.Element, named: Mapping[str, str], name: str, shapes: list[tuple[str, Visual]]
) -> xml.Element:
    link = xml.SubElement(robot, "link", name=named[name])
    for tag, shape in shapes:
        if shape.link == name:
            _add_shape(link, tag, shape)
    return link


def _add_inertial(link: xml.Element, body: Body) -> None:
    inertial = xml.SubElement(link, "inertial")
    xml.SubElement(inertial, "origin", xyz=_text(body.com), rpy="0 0 0")
    xml.SubElement(inertial, "mass", value=repr(body.mass))
    matrix = np.array(body.inertia)
    entries = {f"i{'xyz'[i]}{'xyz'[j]}": repr(float(matrix[i, j])) for i in range(3) for j in range(i, 3)}
    xml.SubElement(inertial, "inertia", entries)


def _add_shape(link: xml.Element, tag: str, shape: Visual) -> None:
    part = xml.SubElement(link, tag)
    _add_origin(part, shape.pose)
    geometry = xml.SubElement(part, "geometry")
    if shape.kind == "mesh":
        xml.SubElement(geometry, "mesh", filename=f"file://{shape.filename}", scale=_text(shape.scale))
    elif shape.kind == "box":
        xml.SubElement(geometry, "box", size=_text(shape.size))
    elif shape.kind == "sphere":
        xml.SubElement(geometry, "sphere", radius=repr(shape.size[0]))
    else:
        xml.SubElement(geometry, shape.kind, radius=repr(shape.size[0]), length=repr(shape.size[1]))
    if tag == "visual" and shape.rgba is not None:
        material = xml.SubElement(part, "material", name=_material(shape))
        xml.SubElement(material, "color", rgba=_text(shape.rgba))


def _material(shape: Visual) -> str:
    """Return a material name that depends only on the colour, so that equal colours share a material."""
    assert shape.rgba is not None
    return "rgba_" + "_".join(f"{round(255 * part):02x}" for part in shape.rgba)


def _add_joint(robot: xml.Element, named: Mapping[str, str], joint: Joint) -> None:
    if any(joint.anchor):
        raise ModelError(
            f"URDF requires the axis of joint {joint.name!r} to pass through the origin of link "
            f"{joint.child!r}, but this axis does not; export the robot before calling Model.rerooted or "
            "attach",
            name=joint.name,
        )
    bounded = joint.lower is not None or joint.upper is not None
    kind = "continuous" if joint.kind == "revolute" and not bounded else joint.kind
    element = xml.SubElement(robot, "joint", name=joint.name, type=kind)
    xml.SubElement(element, "parent", link=named[joint.parent])
    xml.SubElement(element, "child", link=named[joint.child])
    _add_origin(element, joint.pose)
    xml.SubElement(element, "axis", xyz=_text(joint.axis))
    limits = {"lower": joint.lower, "upper": joint.upper, "velocity": joint.velocity, "effort": joint.effort}
    given = {name: repr(float(value)) for name, value in limits.items() if value is not None}
    if kind != "continuous" or given:
        unlimited = {name: "1e+300" for name in ("velocity", "effort") if name not in given}
        xml.SubElement(element, "limit", given | unlimited)
    xml.SubElement(element, "dynamics", damping=repr(joint.damping), friction=repr(joint.friction))
    if joint.mimic is not None:
        leader, multiplier, offset = joint.mimic
        xml.SubElement(element, "mimic", joint=leader, multiplier=repr(multiplier), offset=repr(offset))
    if joint.stiffness or joint.cubic_stiffness:
        names = "stiffness", "cubic_stiffness", "rest_position"
        xml.SubElement(element, "spring", {name: repr(float(getattr(joint, name))) for name in names})


def _add_fixed(robot: xml.Element, named: Mapping[str, str], frame: Frame) -> None:
    element = xml.SubElement(robot, "joint", name=f"{frame.name}_fixed", type="fixed")
    xml.SubElement(element, "parent", link=named[frame.body])
    xml.SubElement(element, "child", link=named[frame.name])
    _add_origin(element, frame.pose)
