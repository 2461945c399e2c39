"""Contacts of the fingers that a gripper closes."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import chain
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.common.coordinates import BASE_NQ
from onorbit_rs.common.link_patterns import link_pattern
from onorbit_rs.scenario.control.grip_force import GripForceController
from onorbit_rs.scenario.control.selection import joint_group

if TYPE_CHECKING:
    from onorbit_rs._core import Model
    from onorbit_rs.scenario.contact import Contact


def finger_contacts(
    control: GripForceController, system: str, model: Model, contacts: Sequence[Contact]
) -> tuple[tuple[str, ...], ...]:
    """Return the names of the contacts of each finger of a gripper.

    The result is empty if a finger has no contact, or if a contact belongs to several fingers, because its
    force then does not show which of them touch.

    Parameters
    ----------
    control : GripForceController
        Control that closes the gripper.
    system : str
        Name of its system.
    model : Model
        Robot of the system.
    contacts : sequence of Contact
        Contacts of the scenario.
    """
    fingers = [
        tuple(
            contact.label
            for contact in contacts
            if contact.normal is not None
            and any(_is_on(contact.between, f"{system}/{link}") for link in _links(model, joint))
        )
        for joint in _joints(control, model)
    ]
    is_shared = len({*chain(*fingers)}) < sum(map(len, fingers))
    return tuple(fingers) if all(fingers) and not is_shared else ()


def _joints(control: GripForceController, model: Model) -> list[int]:
    """Return the indices of the joints of the group, and of the joints that mimic them."""
    names = list(model.joint_names)
    driven: Any = getattr(control, "joints", None)
    found = [names.index(joint) for joint in (names if driven is None else joint_group(driven, names))]
    for _ in names:  # a joint may mimic a joint that mimics another one
        for index, joint in enumerate(model.joints):
            follows = joint.mimic is not None and names.index(joint.mimic[0]) in found
            if follows and index not in found:
                found.append(index)
    return found


def _links(model: Model, joint: int) -> Iterable[str]:
    """Yield the links with collision shapes that a joint moves relative to the base."""
    q = model.neutral()
    moved = q.copy()
    moved[BASE_NQ + joint] += 0.1
    for link in sorted({shape.link for shape in model.collisions}):
        if np.abs(model.frame_pose(moved, link) - model.frame_pose(q, link)).max() > 1e-12:
            yield link


def _is_on(between: Sequence[Sequence[str]], path: str) -> bool:
    """Return True if any pattern of a contact matches the path of a link."""
    return any(link_pattern(pattern).fullmatch(path) for side in between for pattern in side)
