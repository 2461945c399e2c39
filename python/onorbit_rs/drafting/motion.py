"""A pose to start from, and motions from it that are worth a try."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs.drafting.arm import ENOUGH, Arm
from onorbit_rs.drafting.reaction import GENTLE, calmest, turn_per_metre
from onorbit_rs.yoshikawa import manipulability

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Joint, Model

    Floats = NDArray[np.float64]

_TRIES, _SEED = 512, 1
_BENT = 1.2
"""How far from its middle a joint without limits is bent, rad or m."""
_ROOM = 0.35
"""Share of a joint's range to each side of its middle."""
_GOOD_ENOUGH = 0.4
"""Share of the best manipulability at which the neutral pose is kept."""
_SHARE_OF_REACH = 0.15
_SPEED = 0.1
"""Of the tool on average, m/s."""


def home(model: Model, arm: Arm) -> dict[str, float]:
    """Positions of the arm's joints, rad or m: those of the file where the tool moves freely, else bent ones.

    Poses are compared by Yoshikawa's measure of the generalized Jacobian. Joints are rounded to 0.01.
    """
    columns = [list(model.joint_names).index(name) for name in arm.joints]
    joints = [model.joints[column] for column in columns]
    neutral = np.array([within(joint, 0.0) for joint in joints])
    rng = np.random.default_rng(_SEED)
    middle, room = np.array([_middle_and_room(joint) for joint in joints]).T
    poses = np.vstack([neutral, middle + room * rng.uniform(-1.0, 1.0, (_TRIES, len(joints)))]).round(2)
    q = np.tile(model.neutral(), (len(poses), 1))
    q[:, [7 + column for column in columns]] = poses
    jacobian = np.asarray(model.free_floating(q, np.zeros((len(q), model.nv)), arm.tool).jacobian)[
        :, :, columns
    ]
    rows = slice(0, 6 if len(columns) >= ENOUGH else 3)
    measure = manipulability(jacobian[:, rows])
    best = 0 if measure[0] >= _GOOD_ENOUGH * measure.max() else int(np.argmax(measure))
    return dict(zip(arm.joints, poses[best].tolist(), strict=True))


def within(joint: Joint, value: float) -> float:
    """The position nearest to ``value`` that is not at a limit."""
    low, high = _limits(joint)
    return float(np.clip(value, low + 0.05 * min(high - low, 1.0), high - 0.05 * min(high - low, 1.0)))


def at_rest(joint: Joint) -> float:
    """Where a joint that is only held starts: at zero if there is room around it, fingers half open else."""
    near = within(joint, 0.0)
    return near if near == 0.0 or joint.kind != "prismatic" else sum(_limits(joint)) / 2.0


def _middle_and_room(joint: Joint) -> tuple[float, float]:
    low, high = _limits(joint)
    middle = (low + high) / 2.0
    return middle, min(_ROOM * (high - low), _BENT)


def _limits(joint: Joint) -> tuple[float, float]:
    low = -np.pi if joint.lower is None else max(joint.lower, -np.pi)
    high = np.pi if joint.upper is None else min(joint.upper, np.pi)
    return (low, high) if low < high else (joint.lower or 0.0, joint.upper or 0.0)


def quickest_damper(model: Model) -> tuple[str, float]:
    """Return the joint with the fastest damper and its decay rate `b (M⁻¹)ii`, 1/s; 0 without dampers."""
    inverse = np.linalg.inv(np.asarray(model.mass_matrix(model.neutral())))
    rates = {joint.name: joint.damping * inverse[6 + row, 6 + row] for row, joint in enumerate(model.joints)}
    return max(rates.items(), key=lambda one: one[1], default=("", 0.0))


def lines(model: Model, arm: Arm, joints: dict[str, float]) -> Iterator[tuple[list[float], float]]:
    """Displacements of the tool in W (m), the longest first, and a time for each (s).

    Those left out turn the base by more than is gentle, as the start's Jacobian foretells.
    """
    q = configuration(model, joints)
    tool = np.asarray(model.frame_pose(q, arm.tool))[:3, 3]
    first = next(joint for joint in model.joints if joint.name == arm.joints[0])
    shoulder = np.asarray(model.frame_pose(q, first.child))[:3, 3]
    reach = max(float(np.linalg.norm(tool - shoulder)), 0.05)
    away, turns = tool - shoulder, turn_per_metre(model, arm, q)
    # across before along, since an arm is often stretched; then whatever keeps the base calm
    ways = [*np.eye(3)[np.argsort(np.abs(away), kind="stable")], calmest(turns)]
    for share in (1.0, 0.5, 0.2, 0.1, 0.05):
        length = float(f"{share * _SHARE_OF_REACH * reach:.1g}")
        duration = max(4.0, float(f"{length / _SPEED:.1g}"))
        for way in ways:
            if np.linalg.norm(turns @ way) * length > GENTLE:
                continue
            inwards = -way if way @ away > 0.0 else way
            for direction in (inwards, -inwards):
                yield (length * direction.round(2) + 0.0).round(6).tolist(), duration


def turns(model: Model, here: dict[str, float], shares: Iterable[float]) -> Iterator[dict[str, float]]:
    """Yield joint goals: from ``here`` by each share of the longer way to a limit (at most 1 rad or m)."""
    for share in shares:
        goal = {}
        for joint in model.joints:
            if joint.name in here:
                low, high = _limits(joint)
                up, down = high - here[joint.name], here[joint.name] - low
                step = share * min(1.0, max(up, down))
                goal[joint.name] = round(here[joint.name] + (step if up >= down else -step), 3)
        if goal != here:
            yield goal


def configuration(model: Model, joints: dict[str, float]) -> Floats:
    """`q` with the base at the identity."""
    q = np.array(model.neutral(), dtype=np.float64)
    for name, value in joints.items():
        q[7 + list(model.joint_names).index(name)] = value
    return q
