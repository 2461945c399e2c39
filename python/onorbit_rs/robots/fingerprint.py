"""Fingerprint of a robot, which identifies its bodies, joints, closed loops, frames and visual shapes."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable
from pathlib import PurePath
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from onorbit_rs._core import Joint, Loop, Model

DIGITS = 9
"""Decimal places of lengths, m, and rotation matrices, so that rounding does not change the fingerprint.

An inertia is divided by its largest entry. Other numbers of the file, such as masses and limits of joints,
have twelve significant digits.
"""


def fingerprint(model: Model) -> str:
    """Return sixteen hexadecimal digits that depend on the content of a robot, not on its path.

    The digits depend on bodies, joints, closed loops, named frames and visual shapes, but not on collision
    shapes, colours or the content of mesh files.
    """
    content = {
        "bodies": [
            (body.name, _exact(body.mass), _rounded(body.com), _scaled(body.inertia)) for body in model.bodies
        ],
        "joints": [
            (joint.name, joint.kind, joint.parent, joint.child, _rounded(joint.pose), _rounded(joint.axis),
             *map(_exact, (joint.lower, joint.upper, joint.velocity, joint.effort, joint.damping,
                           joint.friction, joint.rotor_inertia)),
             *([_exact(joint.static_friction)] if joint.static_friction != joint.friction else []),
             *([_rounded(joint.anchor)] if any(joint.anchor) else []),
             *(_spring(joint) if joint.stiffness or joint.cubic_stiffness else []),
             *([_mimic(*joint.mimic)] if joint.mimic is not None else []))
            for joint in model.joints
        ],
        "frames": sorted((frame.name, frame.body, _rounded(frame.pose)) for frame in model.frames),
        "visuals": [
            (visual.link, visual.kind, _rounded(visual.pose), _rounded(visual.size), _rounded(visual.scale),
             PurePath(visual.filename).name if visual.filename else None)
            for visual in model.visuals
        ],
        **({"loops": [_loop(closing) for closing in model.loops]} if model.loops else {}),
    }  # fmt: skip
    return hashlib.sha256(json.dumps(content).encode()).hexdigest()[:16]


def has_changed(model: Model, recorded: Any) -> bool:
    """Return whether the robot's fingerprint has changed; False for older runs without a fingerprint."""
    return isinstance(recorded, str) and recorded != fingerprint(model)


def _mimic(leader: str, ratio: float, offset: float) -> list[Any]:
    return [leader, _exact(ratio), _exact(offset)]


def _spring(joint: Joint) -> list[Any]:
    return [_exact(joint.stiffness), _exact(joint.cubic_stiffness), _exact(joint.rest_position)]


def _loop(closing: Loop) -> list[Any]:
    """Return the content of a closed loop, except its option ``project``, which does not change the robot."""
    poses = [_rounded(closing.pose_a), _rounded(closing.pose_b)]
    return [closing.name, closing.kind, closing.frame_a, closing.frame_b, *poses, _exact(closing.length)]


def _exact(number: float | None) -> str | None:
    """Return a number from the file with 12 significant digits, since it is not computed; None for None."""
    return None if number is None else f"{number:.12g}"


def _rounded(values: Iterable[Any]) -> list[Any]:
    rounded: list[Any] = (np.round(np.array(values, dtype=np.float64), DIGITS) + 0.0).tolist()  # -0.0 is 0.0
    return rounded


def _scaled(inertia: Iterable[Any]) -> list[Any]:
    entries = np.array(inertia, dtype=np.float64)
    largest = float(np.abs(entries).max())
    return [f"{largest:.{DIGITS}g}", _rounded(entries / largest if largest > 0.0 else entries)]
