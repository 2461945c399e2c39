"""Finds the tool frame of a robot and the joints that move it."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from onorbit_rs._core import Frame, Joint, Model

FULL_POSE_JOINTS = 6
"""Smallest number of joints that can control the full pose of a tool."""

FINGER_JOINTS = 7
"""Largest number of joints in a finger; a thumb has five, and tendon-driven fingers two per knuckle."""
FINGER_FRACTION = 0.6
"""Largest extent of a finger as a fraction of the length of its arm."""

_FINGER = re.compile(r"finger|thumb|knuckle|jaw|claw")
_DRIVE = re.compile(rf"{_FINGER.pattern}|gripper")
_PART_OF_FINGER = re.compile(r"finger|thumb|knuckle")
# joints that turn a whole gripper
_WRIST = re.compile(r"wrist|roll|pitch|yaw")

# patterns for names of tool frames, the most reliable first; the last two apply only at the end of an arm
_NAMES = (
    r"tool|tcp", r"(^|_)eef?(_|$)|end_?effector", r"grasp", r"hand|palm", r"flange", r"gripper", r"wrist",
    r"tip(_|$)",
)  # fmt: skip


@dataclass(frozen=True)
class Arm:
    """Tool frame, and the joints between base and tool in the order of the robot."""

    tool: str
    joints: list[str]


def find_arm(model: Model, tool: str | None = None) -> Arm | None:
    """Return the arm that moves the frame ``tool``; without ``tool``, the arm of the most likely tool.

    Tool frames are ranked by these criteria: six joints or more move the frame; its link carries fingers; its
    name is common for tools; the number of joints that move the frame. Frames on fingers are considered only
    if no other frame moves. Returns None if no frame moves, or if no joint moves ``tool``.
    """
    chains = _chains(model)
    fingers, palms = find_fingers(model)
    inner = {joint.parent for joint in model.joints if joint.child not in fingers}
    frames = [(frame, chains.get(frame.body, [])) for frame in model.frames]
    found = [(frame, chain) for frame, chain in frames if chain and tool in (None, frame.name)]
    if tool is None:
        found = [(frame, chain) for frame, chain in found if frame.body not in fingers] or found
    if not found:
        return None

    def order(one: tuple[Frame, list[Joint]]) -> tuple[bool, bool, int, int]:
        frame, chain = one
        return (
            len(chain) < FULL_POSE_JOINTS,
            frame.body not in palms,
            _rank(frame.name, frame.body not in inner),
            -len(chain),
        )

    frame, chain = min(found, key=order)
    return Arm(frame.name, [joint.name for joint in chain])


def find_fingers(model: Model) -> tuple[set[str], set[str]]:
    """Return the bodies that are parts of fingers, and the bodies that carry fingers (palms).

    A finger is a branch of at most ``FINGER_JOINTS`` joints, with at most ``FINGER_FRACTION`` of the length
    of its arm and with fewer joints. A palm carries only fingers: two or more, or a single one whose names
    indicate a finger. The base is never a palm.
    """
    chains = _chains(model)
    branches: dict[str, list[Joint]] = {}
    for joint in model.joints:
        branches.setdefault(joint.parent, []).append(joint)
    fingers: set[str] = set()
    palms: set[str] = set()
    for palm, joints in branches.items():
        arm = sum(_length(joint.pose) for joint in chains.get(palm, []))
        found = [(joint, _branch(joint, branches)) for joint in joints]
        short = [
            (joint, branch)
            for joint, branch in found
            if len(branch) <= FINGER_JOINTS
            and sum(map(_travel, branch)) <= FINGER_FRACTION * arm
            and len(branch) < max(len(chains.get(palm, [])), 2)
        ]
        if len(short) == 1 and not _is_called_finger(short[0][0]):
            continue
        if palm in chains and short and len(short) == len(found):
            palms.add(palm)
            fingers.update(part.child for _, branch in short for part in branch)
    return fingers, palms - fingers


def _is_called_finger(joint: Joint) -> bool:
    """Return True if the names indicate a joint that moves a whole finger rather than a gripper."""
    name, parent, child = joint.name.lower(), joint.parent.lower(), joint.child.lower()
    is_finger = bool(_DRIVE.search(name) or _FINGER.search(child))
    return is_finger and not _WRIST.search(name) and not _PART_OF_FINGER.search(parent)


def _branch(joint: Joint, branches: dict[str, list[Joint]]) -> list[Joint]:
    """Return a joint and all joints that it moves."""
    found, waiting = [], [joint]
    while waiting:
        found.append(waiting.pop())
        waiting += branches.get(found[-1].child, [])
    return found


def _length(pose: list[list[float]]) -> float:
    return math.hypot(*(row[3] for row in pose[:3]))


def _travel(joint: Joint) -> float:
    """Return the extent of a finger joint from the previous joint, m: its offset plus its range of travel."""
    is_sliding = joint.kind == "prismatic" and joint.lower is not None and joint.upper is not None
    travel = (joint.upper or 0.0) - (joint.lower or 0.0) if is_sliding else 0.0
    return _length(joint.pose) + travel


def _chains(model: Model) -> dict[str, list[Joint]]:
    """Return the joints from the base to each body, without mimic joints, which follow others."""
    chains: dict[str, list[Joint]] = {}
    for joint in model.joints:  # a parent precedes its children
        own = [joint] if joint.mimic is None else []
        chains[joint.child] = chains.get(joint.parent, []) + own
    return chains


def _rank(name: str, is_end: bool) -> int:
    names = _NAMES if is_end else _NAMES[:-2]
    return next((rank for rank, words in enumerate(names) if re.search(words, name.lower())), len(_NAMES))
