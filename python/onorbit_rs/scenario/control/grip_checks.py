"""Checks before a run that the fingers of a gripper approach each other and open wide enough."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs import _core
from onorbit_rs.common.coordinates import BASE_NQ
from onorbit_rs.common.link_patterns import link_pattern
from onorbit_rs.exceptions import ControlError
from onorbit_rs.scenario.contact import Contact
from onorbit_rs.scenario.control.grip_force import GripForceControl
from onorbit_rs.scenario.control.selection import joint_group

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

_MOTION = 1e-5
"""Displacement of the joints with which the approach of links to each other is tested, rad or m."""
_CLOSER = 1e-3
"""Smallest decrease of a distance, relative to the motion, that counts as an approach."""


def check_grip(
    control: GripForceControl,
    name: str,
    models: Mapping[str, _core.Model],
    q: Floats,
    contacts: Sequence[Contact],
) -> None:
    """Raise an error if the fingers of a gripper do not approach each other, or open too little.

    Parameters
    ----------
    control : GripForceControl
        Control that closes the gripper.
    name : str
        Name of its system.
    models : mapping
        Robots of all systems, by name.
    q : (nq,) array
        Initial configuration of the system.
    contacts : sequence of Contact
        Contacts of the scenario.

    Raises
    ------
    ControlError
        If no finger approaches another link that touches the same object, or if each shape of an object is
        wider than the largest opening.
    """
    model = models[name]
    rates = _closing_rates(control, model)
    joints = [int(joint) for joint in np.flatnonzero(rates)]
    moved = {link for link in {shape.link for shape in model.collisions} if _moves(model, q, joints, link)}
    sides = [_sides(contact, models) for contact in contacts if contact.normal is not None]
    own = {link for side in sides for one in side for system, link in one if system == name}
    fingers = sorted(own & moved)
    if not fingers:
        return  # the engine names the joint whose finger has no contact
    closed = q.copy()
    closed[BASE_NQ:] += _MOTION * rates / np.abs(rates).max()
    pairs = [(a, b) for a in fingers for b in sorted(own) if a != b and (b not in moved or a < b)]
    approaching = [
        pair for pair in pairs if _gap(model, closed, pair) < _gap(model, q, pair) - _CLOSER * _MOTION
    ]
    if not approaching:
        who = f"link {fingers[0]} does" if len(fingers) == 1 else f"links {', '.join(fingers)} do"
        raise ControlError(
            f"the {who} not approach any other link of {name!r} that may touch the "
            "object, so nothing opposes their force; check the signs of closing_rate, or declare a contact "
            "of the opposite finger",
            name=control.name,
        )  # fmt: skip
    _check_opening(control, name, models, _opened(model, q, rates), approaching, sides)


def _check_opening(
    control: GripForceControl, name: str, models: Mapping[str, _core.Model], opened: Floats | None,
    pairs: Sequence[tuple[str, str]], sides: Sequence[list[set[tuple[str, str]]]],
) -> None:  # fmt: skip
    """Raise an error if each shape of an object that the fingers may touch is wider than the opening."""
    if opened is None:
        return
    opening = max(_gap(models[name], opened, pair) for pair in pairs)
    links = {link for pair in pairs for link in pair}
    for one, other in (pair[::way] for pair in sides for way in (1, -1)):
        if not any((name, link) in one for link in links):
            continue
        objects = sorted(path for path in other if path[0] != name)
        widths = [width for system, link in objects for width in _widths(models[system], link)]
        if widths and min(widths) > opening:
            what = ", ".join(f"{system}/{link}" for system, link in objects)
            raise ControlError(
                f"the gripper opens by {opening:.4g} m at most, but the narrowest shape of {what} is "
                f"{min(widths):.4g} m wide; use a wider gripper, or another part of the object",
                name=control.name,
            )  # fmt: skip


def _closing_rates(control: GripForceControl, model: _core.Model) -> Floats:
    """Return the closing rates of all joints, (n,), including those that mimic a joint of the group."""
    names = list(model.joint_names)
    group = names if control.joints is None else joint_group(control.joints, names)
    rates = np.zeros(len(names))
    rates[[names.index(joint) for joint in group]] = control.closing_rate
    for _ in names:  # a joint may mimic a joint that mimics another one
        for index, joint in enumerate(model.joints):
            if joint.mimic is not None:
                rates[index] = joint.mimic[1] * rates[names.index(joint.mimic[0])]
    return rates


def _moves(model: _core.Model, q: Floats, joints: Sequence[int], link: str) -> bool:
    """Return True if any of the joints moves a link relative to the base."""
    place = model.frame_pose(q, link)
    for joint in joints:
        moved = q.copy()
        moved[BASE_NQ + joint] += 0.1
        if np.abs(model.frame_pose(moved, link) - place).max() > 1e-12:
            return True
    return False


def _opened(model: _core.Model, q: Floats, rates: Floats) -> Floats | None:
    """Return the configuration of the open gripper; None if a joint has no limit in the opening direction."""
    opened = q.copy()
    for index in np.flatnonzero(rates):
        joint = model.joints[index]
        limit = joint.lower if rates[index] > 0.0 else joint.upper
        if limit is None:
            return None
        opened[BASE_NQ + index] = limit
    return opened


def _gap(model: _core.Model, q: Floats, links: tuple[str, str]) -> float:
    return float(_core.distance(model, q, *links).distance)


def _sides(contact: Contact, models: Mapping[str, _core.Model]) -> list[set[tuple[str, str]]]:
    """Return the links that have collision shapes, for each side of a contact, as (system, link)."""
    return [
        {
            (system, shape.link)
            for pattern in map(link_pattern, side)
            for system, model in models.items()
            for shape in model.collisions
            if pattern.fullmatch(f"{system}/{shape.link}")
        }
        for side in contact.between
    ]


def _widths(model: _core.Model, link: str) -> list[float]:
    """Return the smallest width of each collision shape of a link, m; zero if the width is not known."""
    return [_width(shape.kind, shape.size) for shape in model.collisions if shape.link == link]


def _width(kind: str, size: Sequence[float]) -> float:
    """Return the smallest width of a shape, m; zero for kinds whose width is not known.

    For a cone with the radius `r` and the height `h`, it is `min(h, 2 r h / √(r² + h²))`, the smallest
    height of its triangular section; for a torus, it is the diameter of the tube.
    """
    if kind == "box":
        return min(size)
    if kind in ("sphere", "capsule"):
        return 2.0 * size[0]
    if kind == "torus":
        return 2.0 * size[1]
    if kind == "cone":
        radius, height = size
        return min(height, 2.0 * radius * height / float(np.hypot(radius, height)))
    return min(2.0 * size[0], size[1]) if kind == "cylinder" else 0.0
