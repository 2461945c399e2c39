"""Controllers of the engine from a checked scenario."""

from __future__ import annotations

from dataclasses import replace
from fnmatch import fnmatchcase
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs import _core
from onorbit_rs.exceptions import ControlError, FrameError
from onorbit_rs.names import did_you_mean, nearest
from onorbit_rs.scenario import control as laws
from onorbit_rs.scenario.python_controller import python_controller
from onorbit_rs.scenario.python_source import inspect_source
from onorbit_rs.scenario.reference import Start, reference_of

if TYPE_CHECKING:
    from onorbit_rs.scenario.controls import JointControl, TaskControl
    from onorbit_rs.scenario.reference_parts import AnyReference


def control_of(
    part: TaskControl | JointControl, law: Any, reference: Any, joints: list[str] | None
) -> _core.Control:
    """One of several controllers, from its law and what it tracks."""
    goal = part.goal
    return _core.Control(
        law, reference=reference, joints=joints, tool=getattr(part, "tool", None), name=part.name,
        start=part.start, end=part.end, after=part.after, starts_at_present=part.starts_at_present,
        goal=None if goal is None else _core.Goal(**_as_arrays(goal.model_dump())),
    )  # fmt: skip


def tool_of(part: Any, tool: str | None) -> str | None:
    """The frame of a controller; ``tool`` is the scenario's."""
    return getattr(part, "tool", None) or tool


def group(wanted: list[str], joints: list[str]) -> list[str]:
    """Joints by name or pattern, in the order of the robot within a pattern; names come first.

    Raises
    ------
    FrameError
        A name that no joint has, or a pattern that fits none.
    """
    found: list[str] = []
    for name in wanted:
        is_pattern = name not in joints and any(sign in name for sign in "*?[")
        fitting = [joint for joint in joints if (fnmatchcase(joint, name) if is_pattern else joint == name)]
        if not fitting:
            what = f"no joint fits {name!r}" if is_pattern else f"no joint is named {name!r}"
            raise FrameError(
                f"joints: {what}{did_you_mean(name, joints)}",
                name=name, kind="joint", known=joints, suggestion=nearest(name, joints),
            )  # fmt: skip
        found += fitting
    return found


def columns_of(law: Any, joints: list[str]) -> list[int]:
    """Where the joints that a law drives stand among those of the robot: all, or those of its group."""
    wanted = getattr(law, "joints", None)
    return [joints.index(name) for name in (joints if wanted is None else group(wanted, joints))]


def law_of(part: Any, tool: str | None, model: _core.Model, folder: Path, *, runs_code: bool = True) -> Any:
    """The law of a controller, or the user's own object; without ``runs_code`` a stand-in for that."""
    if isinstance(part, laws.PythonController):
        return python_controller(part, folder) if runs_code else inspect_source(part, folder)
    kind, law = next((kind, law) for kind, law in _LAWS.items() if isinstance(part, kind))
    gains = _as_arrays(part.model_dump(include=set(kind.model_fields) - {"kind"}, exclude_none=True))
    if not isinstance(part, laws.TASK_LAWS):
        return law(**gains)
    try:
        return law(model, tool, **gains)
    except ControlError as error:
        if error.name is None:  # no gain is wrong: too few joints move the tool
            error.message += "; take joint_computed_torque for the joints, or compliance for the tool"
        raise


_LAWS: dict[Any, Any] = {
    laws.ComputedTorqueController: _core.ComputedTorque,
    laws.JointComputedTorqueController: _core.JointComputedTorque,
    laws.JointPidController: _core.JointPid,
    laws.ComplianceController: _core.Compliance,
}


def tracked_by(
    law: Any, reference: AnyReference | None, tool: str | None, at: Start
) -> _core.Reference | _core.JointReference | None:
    """What a controller tracks, from where its tool or its joints are at the start of the run."""
    if reference is None:
        return None
    pose = None if tool is None or isinstance(law, laws.JOINT_LAWS) else at.model.frame_pose(at.q, tool)
    return reference_of(reference, replace(at, tool_pose=pose))


def _as_arrays(values: dict[str, Any]) -> dict[str, Any]:
    return {name: np.array(value) if isinstance(value, list) else value for name, value in values.items()}
