"""Initial joint positions of a drafted scenario, and the arm motions that are tried from there."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs.common.coordinates import BASE_NQ, BASE_NV
from onorbit_rs.common.manipulability import manipulability
from onorbit_rs.tools.new_scenario.arm import FULL_POSE_JOINTS, Arm
from onorbit_rs.tools.new_scenario.reaction import GENTLE, rotation_per_metre, smallest_rotation

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Joint, Model

    Floats = NDArray[np.float64]
    Weight = Callable[[Floats], Floats]

_TRIES, _SEED = 512, 1
_BENT = 1.2
"""Largest deviation of a joint from the middle of its range, rad or m."""
_RANGE_FRACTION = 0.35
"""Largest deviation of a joint from the middle of its range, as a fraction of the range."""
_GOOD_ENOUGH = 0.4
"""Manipulability of the neutral pose, relative to the best one found, above which this pose is used."""
_REACH_FRACTION = 0.15
"""Longest displacement of the tool, as a fraction of the arm's reach."""
_SPEED = 0.1
"""Average speed of the tool, m/s."""


def home(model: Model, arm: Arm, weight: Weight | None = None) -> dict[str, float]:
    """Return initial positions of the arm's joints, rad or m, rounded to 0.01.

    The neutral pose is used if its manipulability, computed from the generalized Jacobian, is high enough,
    otherwise the best of many random poses. ``weight`` returns the factors (batch,) by which the
    manipulability of configurations (batch, nq) is multiplied.
    """
    columns = [list(model.joint_names).index(name) for name in arm.joints]
    joints = [model.joints[column] for column in columns]
    neutral = np.array([within(joint, 0.0) for joint in joints])
    rng = np.random.default_rng(_SEED)
    middle, deviation = np.array([_middle_and_deviation(joint) for joint in joints]).T
    poses = np.vstack([neutral, middle + deviation * rng.uniform(-1.0, 1.0, (_TRIES, len(joints)))]).round(2)
    q = np.tile(model.neutral(), (len(poses), 1))
    q[:, [BASE_NQ + column for column in columns]] = poses
    jacobian = np.asarray(model.free_floating(q, np.zeros((len(q), model.nv)), arm.tool).jacobian)[
        :, :, columns
    ]
    rows = slice(0, 6 if len(columns) >= FULL_POSE_JOINTS else 3)
    measure = manipulability(jacobian[:, rows]) * (1.0 if weight is None else weight(q))
    best = 0 if measure[0] >= _GOOD_ENOUGH * measure.max() else int(np.argmax(measure))
    return dict(zip(arm.joints, poses[best].tolist(), strict=True))


def start_positions(model: Model, arm: Arm | None, weight: Weight | None = None) -> dict[str, float]:
    """Return initial positions of the arm's joints (see :func:`home`) and of joints that cannot be zero."""
    pose = {} if arm is None else home(model, arm, weight)
    for joint in model.joints:
        is_free = joint.mimic is None and (arm is None or joint.name not in arm.joints)
        if is_free and at_rest(joint) != 0.0:
            pose[joint.name] = float(f"{at_rest(joint):.3g}")
    return pose


def within(joint: Joint, value: float) -> float:
    """Return the position of a joint nearest to ``value``, rad or m, that keeps a distance from its limits.

    The distance is 5 % of the range, and at most 0.05 rad or m.
    """
    low, high = _limits(joint)
    return float(np.clip(value, low + 0.05 * min(high - low, 1.0), high - 0.05 * min(high - low, 1.0)))


def at_rest(joint: Joint) -> float:
    """Return the position of a held joint, rad or m.

    It is zero if :func:`within` permits it; otherwise it is the middle of the range for a prismatic joint,
    and the nearest permitted position for other joints.
    """
    near = within(joint, 0.0)
    return near if near == 0.0 or joint.kind != "prismatic" else sum(_limits(joint)) / 2.0


def _middle_and_deviation(joint: Joint) -> tuple[float, float]:
    low, high = _limits(joint)
    middle = (low + high) / 2.0
    return middle, min(_RANGE_FRACTION * (high - low), _BENT)


def _limits(joint: Joint) -> tuple[float, float]:
    low = -np.pi if joint.lower is None else max(joint.lower, -np.pi)
    high = np.pi if joint.upper is None else min(joint.upper, np.pi)
    return (low, high) if low < high else (joint.lower or 0.0, joint.upper or 0.0)


def fastest_damper(model: Model) -> tuple[str, float]:
    """Return the name of the joint with the fastest damping, and its decay rate `b (M⁻¹)ii`, 1/s.

    `b` is the damping of joint `i`, `M` the mass matrix at the neutral configuration. Without joints, the
    name is empty and the rate 0.
    """
    inverse = np.linalg.inv(np.asarray(model.mass_matrix(model.neutral())))
    rates = {
        joint.name: joint.damping * inverse[BASE_NV + row, BASE_NV + row]
        for row, joint in enumerate(model.joints)
    }
    return max(rates.items(), key=lambda one: one[1], default=("", 0.0))


def lines(model: Model, arm: Arm, joints: dict[str, float]) -> Iterator[tuple[list[float], float]]:
    """Yield displacements of the tool in W, m, the longest first, with their durations, s.

    Displacements that, according to the initial Jacobian, would rotate the base by more than ``GENTLE`` are
    omitted.
    """
    q = configuration(model, joints)
    tool = np.asarray(model.frame_pose(q, arm.tool))[:3, 3]
    first = next(joint for joint in model.joints if joint.name == arm.joints[0])
    shoulder = np.asarray(model.frame_pose(q, first.child))[:3, 3]
    reach = max(float(np.linalg.norm(tool - shoulder)), 0.05)
    arm_vector, rotations = tool - shoulder, rotation_per_metre(model, arm, q)
    # perpendicular to the arm before parallel, since arms are often stretched; then by rotation of the base
    axes = [*np.eye(3)[np.argsort(np.abs(arm_vector), kind="stable")], smallest_rotation(rotations)]
    for fraction in (1.0, 0.5, 0.2, 0.1, 0.05):
        length = float(f"{fraction * _REACH_FRACTION * reach:.1g}")
        duration = max(4.0, float(f"{length / _SPEED:.1g}"))
        for axis in axes:
            if np.linalg.norm(rotations @ axis) * length > GENTLE:
                continue
            retracting = -axis if axis @ arm_vector > 0.0 else axis
            for direction in (retracting, -retracting):
                yield (length * direction.round(2) + 0.0).round(6).tolist(), duration


def joint_goals(
    model: Model, start: dict[str, float], fractions: Iterable[float]
) -> Iterator[dict[str, float]]:
    """Yield joint goals, rad or m, each a step from ``start`` towards the farther limit of every joint.

    The step is a fraction of the distance to this limit, or of 1 rad or m if the distance is larger.
    """
    for fraction in fractions:
        goal = {}
        for joint in model.joints:
            if joint.name in start:
                low, high = _limits(joint)
                up, down = high - start[joint.name], start[joint.name] - low
                step = fraction * min(1.0, max(up, down))
                goal[joint.name] = round(start[joint.name] + (step if up >= down else -step), 3)
        if goal != start:
            yield goal


def configuration(model: Model, joints: dict[str, float]) -> Floats:
    """Return the configuration (nq,) with these joint positions, and the base in its neutral pose."""
    q = np.array(model.neutral(), dtype=np.float64)
    for name, value in joints.items():
        q[BASE_NQ + list(model.joint_names).index(name)] = value
    return q
