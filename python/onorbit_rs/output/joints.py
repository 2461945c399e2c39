"""Joint quantities of the summary, separately for revolute joints (N m, rad) and prismatic joints (N, m)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs import _core
from onorbit_rs.common.blocks import blocks, largest
from onorbit_rs.common.coordinates import JOINTS_Q, JOINTS_V
from onorbit_rs.scenario.control import (
    ExternalController,
    GripForceController,
    JointLaw,
    JointPidController,
)
from onorbit_rs.scenario.control.selection import joint_columns, joint_group

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Model, Trace
    from onorbit_rs.scenario.build import Built

    Floats = NDArray[np.float64]

Summary = dict[str, Any]

_ROUNDING = 1e-9
"""Relative rounding error by which a joint that is held at a limit may exceed the limit."""


def joint_loads(trace: Trace, built: Built) -> Summary:
    """Return the largest joint torque and force, N m and N, and the largest final joint rates, rad/s and m/s.

    Entries of a kind of joint that the robot lacks are omitted.
    """
    tau, rates = _largest(trace.tau), np.abs(np.asarray(trace.v[-1])[JOINTS_V])
    loads: Summary = {}
    for is_prismatic, load, rate in (
        (False, "joint_torque_max_nm", "joint_rate_final_max_rad_s"),
        (True, "joint_force_max_n", "joint_rate_final_max_m_s"),
    ):
        columns = _are_prismatic(built, None) == is_prismatic
        if columns.any():
            loads |= {load: tau[columns].max(), rate: rates[columns].max()}
    return loads


def efforts_at_limit(trace: Trace, built: Built) -> Summary:
    """Return an entry with the names of the joints under PID or grip control that reached their effort limit.

    The limit is that of the controller or, if the controller has no limit, that of the robot. Without such a
    controller, there is no entry.
    """
    names, tau = list(built.model.joint_names), _largest(trace.tau)
    limited = (JointPidController, GripForceController)
    laws = [law for law in built.scenario.laws if isinstance(law, limited)]
    reached = set()
    for law in laws:
        columns = joint_columns(law, names)
        own = [built.model.joints[column].effort for column in columns]
        limits = own if law.effort_limit is None else np.broadcast_to(law.effort_limit, len(columns))
        reached |= {column for column, limit in zip(columns, limits, strict=True)
                    if limit is not None and tau[column] >= limit}  # fmt: skip
    return {"joint_efforts_at_limit": ", ".join(names[column] for column in sorted(reached))} if laws else {}


def _largest(values: Any) -> Floats:
    """Return the largest magnitude in each column of ``values``, (T, n); 0 without rows."""
    found: Floats = largest(np.abs, values) if len(values) else np.zeros(np.shape(values)[1])
    return found


def largest_fractions(values: Floats, limits: Sequence[float | None]) -> Floats:
    """Return the largest magnitude in each column of ``values``, (T, n), as a fraction of its limit, (n,).

    The fraction is 0 for columns without a limit. A limit of zero means no limit, because exporters write
    zero for unknown limits.
    """
    found = _largest(values)
    fractions = [value / limit if limit else 0.0 for value, limit in zip(found, limits, strict=True)]
    return np.array(fractions, dtype=np.float64)


def rate_fractions(trace: Trace, model: Model) -> Floats:
    """Return the largest rate of each joint, relative to its limit, (n,); 0 without a limit."""
    return largest_fractions(trace.v[:, JOINTS_V], [joint.velocity for joint in model.joints])


def effort_fractions(trace: Trace, model: Model) -> Floats:
    """Return the largest effort of each joint relative to its limit, (n,); 0 without a limit."""
    return largest_fractions(trace.tau, [joint.effort for joint in model.joints])


def loads_exceeded(trace: Trace, model: Model) -> Summary:
    """Return the names of the joints whose rate or effort exceeds a limit of the robot's file in any row.

    Effort limits of controllers are not considered.
    """
    return {
        key: ", ".join(np.array(model.joint_names)[fractions > 1.0 + _ROUNDING])
        for key, fractions in (
            ("joint_rates_exceeded", rate_fractions(trace, model)),
            ("joint_efforts_exceeded", effort_fractions(trace, model)),
        )
    }


def joint_errors(
    key: str, errors: Floats, built: Built, wanted: list[str] | None = None, *, are_rates: bool = False
) -> Summary:
    """Return the largest errors of revolute and of prismatic joints, if the robot has any.

    The keys are ``KEY_joint_error_max_rad`` and ``…_m``, or ``KEY_joint_rate_error_max_rad_s`` and ``…_m_s``
    if the errors are those of rates. ``errors``, (T, joints), rad or m, or rad/s or m/s, are those of all
    joints, or of those named ``wanted``.
    """
    prismatic = _are_prismatic(built, wanted)
    what, per = ("joint_rate", "_s") if are_rates else ("joint", "")
    units = {f"rad{per}": ~prismatic, f"m{per}": prismatic}
    return {
        f"{key}_{what}_error_max_{unit}": largest(
            lambda rows, columns=columns: np.abs(rows[:, columns]), errors
        ).max()
        for unit, columns in units.items()
        if columns.any()
    }


def single_errors(trace: Trace, built: Built) -> Summary:
    """Return the largest joint tracking errors of a run with a single controller of joint positions or rates.

    The result is empty for other controllers and without joints.
    """
    law = built.scenario.controller
    has_efforts = isinstance(law, JointPidController) and law.interface == "effort"
    if not isinstance(law, JointLaw) or has_efforts or not built.model.joints:
        return {}
    if isinstance(law, ExternalController):
        return joint_errors("tracking", trace.tracking["control"], built)
    parts = []
    for times, q, v in blocks(trace.time, trace.q, trace.v):
        # without a reference, the joints are held at their initial positions
        desired, rates = trace.q[0, JOINTS_Q], np.zeros(1)
        if isinstance(built.reference, _core.JointReference):
            desired, rates, _ = built.reference.sample(times)
        errors = rates - v[:, JOINTS_V] if law.tracks_rates else desired - q[:, JOINTS_Q]
        parts.append(np.abs(errors).max(axis=0))
    return joint_errors("tracking", np.array(parts), built, are_rates=law.tracks_rates)


def _are_prismatic(built: Built, wanted: list[str] | None) -> NDArray[np.bool_]:
    """Return whether each joint, among all joints of the robot or those named ``wanted``, is prismatic."""
    kinds = {joint.name: joint.kind for joint in built.model.joints}
    names = list(built.model.joint_names)
    return np.array(
        [kinds[name] == "prismatic" for name in (names if wanted is None else joint_group(wanted, names))]
    )
