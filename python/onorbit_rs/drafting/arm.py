"""Which frame of a robot is its tool, and which joints move it."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from onorbit_rs._core import Joint, Model

ENOUGH = 6
"""Joints from which a tool can be placed and turned at will."""

# what the frame at the end of an arm is called, the surest first
_NAMES = (
    r"tool|tcp", r"(^|_)eef?(_|$)|end_?effector", r"grasp", r"hand|palm", r"flange", r"gripper", r"wrist",
    r"tip(_|$)",
)  # fmt: skip


@dataclass(frozen=True)
class Arm:
    """A tool and the joints between it and the base, in the order of the robot."""

    tool: str
    joints: list[str]


def find_arm(model: Model, tool: str | None = None) -> Arm | None:
    """The arm that a tool belongs to; without a tool the one that looks most like an arm.

    That is a frame with six joints or more behind it, then one that is called as tools are, then one with
    many joints. None where nothing moves, or where no joint moves the given tool.
    """
    chains = _chains(model)
    frames = [(frame.name, chains.get(frame.body, [])) for frame in model.frames]
    found = [(name, chain) for name, chain in frames if chain and tool in (None, name)]
    if not found:
        return None
    name, chain = min(found, key=lambda one: (len(one[1]) < ENOUGH, _rank(one[0]), -len(one[1])))
    return Arm(name, [joint.name for joint in chain])


def _chains(model: Model) -> dict[str, list[Joint]]:
    """Joints from the base to each body."""
    chains: dict[str, list[Joint]] = {}
    for joint in model.joints:  # a parent stands before its children
        chains[joint.child] = [*chains.get(joint.parent, []), joint]
    return chains


def _rank(name: str) -> int:
    return next((rank for rank, words in enumerate(_NAMES) if re.search(words, name.lower())), len(_NAMES))
