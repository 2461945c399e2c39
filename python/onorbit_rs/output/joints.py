"""What the joints did, for the summary: those that turn apart from those that slide, each in its unit."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs import _core
from onorbit_rs.scenario.control import JOINT_LAWS, JointPidController
from onorbit_rs.scenario.make_control import columns_of, group

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Model, Trace
    from onorbit_rs.scenario.build import Built

    Floats = NDArray[np.float64]

Summary = dict[str, Any]

_ROUNDING = 1e-9
"""Share of a limit by which a joint that is held at it may exceed it."""


def joint_loads(trace: Trace, built: Built) -> Summary:
    """Largest torque and force, and how fast the joints still are at the end."""
    tau, rates = np.abs(np.asarray(trace.tau)), np.abs(np.asarray(trace.v)[-1, 6:])
    loads: Summary = {}
    for is_sliding, load, rate in (
        (False, "joint_torque_max_nm", "joint_rate_final_max_rad_s"),
        (True, "joint_force_max_n", "joint_rate_final_max_m_s"),
    ):
        columns = _slides(built, None) == is_sliding
        if columns.any():
            loads |= {load: tau[:, columns].max(), rate: rates[columns].max()}
    return loads


def efforts_at_limit(trace: Trace, built: Built) -> Summary:
    """The joints under a PID whose effort was at its limit in a row: the law's, else the robot's own."""
    names, tau = list(built.model.joint_names), np.abs(np.asarray(trace.tau)).max(axis=0)
    pids = [law for law in built.scenario.laws if isinstance(law, JointPidController)]
    reached = set()
    for law in pids:
        columns = columns_of(law, names)
        own = [built.model.joints[column].effort for column in columns]
        limits = own if law.effort_limit is None else np.broadcast_to(law.effort_limit, len(columns))
        reached |= {column for column, limit in zip(columns, limits, strict=True)
                    if limit is not None and tau[column] >= limit}  # fmt: skip
    return {"joint_efforts_at_limit": ", ".join(names[column] for column in sorted(reached))} if pids else {}


def largest_shares(values: Floats, limits: Sequence[float | None]) -> Floats:
    """Return the largest magnitude in each column of ``values``, (T, n), as a share of its limit, (n,).

    The share is 0 where there is no limit. A limit of zero counts as none: exporters write it where they
    know none.
    """
    largest = np.abs(values).max(axis=0, initial=0.0)
    shares = [value / limit if limit else 0.0 for value, limit in zip(largest, limits, strict=True)]
    return np.array(shares, dtype=np.float64)


def rate_shares(trace: Trace, model: Model) -> Floats:
    """Return the largest rate of each joint as a share of its limit, (n,)."""
    return largest_shares(np.asarray(trace.v)[:, 6:], [joint.velocity for joint in model.joints])


def effort_shares(trace: Trace, model: Model) -> Floats:
    """Return the largest effort of each joint as a share of its limit, (n,)."""
    return largest_shares(np.asarray(trace.tau), [joint.effort for joint in model.joints])


def loads_exceeded(trace: Trace, model: Model) -> Summary:
    """Return the names of the joints whose rate or effort was beyond the limit of the robot's file in a row.

    Under any control law; an effort limit of the controller itself does not count.
    """
    return {
        key: ", ".join(np.array(model.joint_names)[shares > 1.0 + _ROUNDING])
        for key, shares in (
            ("joint_rates_exceeded", rate_shares(trace, model)),
            ("joint_efforts_exceeded", effort_shares(trace, model)),
        )
    }


def joint_errors(key: str, errors: Floats, built: Built, wanted: list[str] | None = None) -> Summary:
    """``KEY_joint_error_max_rad``, ``…_m`` of errors (T, joints); ``wanted`` are names or patterns."""
    slides = _slides(built, wanted)
    units = {"rad": ~slides, "m": slides}
    return {
        f"{key}_joint_error_max_{unit}": np.abs(errors[:, columns]).max()
        for unit, columns in units.items()
        if columns.any()
    }


def single_errors(trace: Trace, built: Built) -> Summary:
    """The largest errors of the joints under the one ``controller`` of a scenario, where it has positions."""
    law = built.scenario.controller
    has_positions = not isinstance(law, JointPidController) or law.interface == "position"
    if not isinstance(law, JOINT_LAWS) or not has_positions or not built.model.joints:
        return {}
    joints = np.asarray(trace.q)[:, 7:]
    desired = joints[0]  # held where they start
    if isinstance(built.reference, _core.JointReference):
        desired, _, _ = built.reference.sample(np.asarray(trace.time))
    return joint_errors("tracking", desired - joints, built)


def _slides(built: Built, wanted: list[str] | None) -> NDArray[np.bool_]:
    """Whether each joint is prismatic, in the order of the robot, or of a controller's group."""
    kinds = {joint.name: joint.kind for joint in built.model.joints}
    names = list(built.model.joint_names)
    return np.array(
        [kinds[name] == "prismatic" for name in (names if wanted is None else group(wanted, names))]
    )
