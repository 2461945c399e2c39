"""Several controllers at once: each drives a group of joints, from when to when, to which goal."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BeforeValidator, Field

from onorbit_rs.scenario import control as laws
from onorbit_rs.scenario.fields import NotNegative, Positive, Time
from onorbit_rs.scenario.gains import JointTolerance, TaskTolerance
from onorbit_rs.scenario.part import Part, of_kind
from onorbit_rs.scenario.reference_parts import Reference


class TaskGoal(Part):
    """Distance and angle within which the tool is to be."""

    tolerance: TaskTolerance
    """At the end of the reference."""
    path_tolerance: TaskTolerance | None = None
    """On the way; beyond it the control holds where it is."""
    time: Annotated[Time, NotNegative] | None = None
    """Allowed after the end of the reference; any where not given."""


class JointGoal(Part):
    """Errors within which the joints are to be: a number, or one for each."""

    tolerance: JointTolerance
    path_tolerance: JointTolerance | None = None
    time: Annotated[Time, NotNegative] | None = None


def _as_list(value: Any) -> Any:
    return [value] if isinstance(value, str) else value


class Control(Part):
    """What all controls say beside their law."""

    name: Annotated[str, Field(pattern=r"^[A-Za-z0-9_\-]+$")]
    """For results, columns of the trace and messages."""
    joints: Annotated[list[str], Field(min_length=1), BeforeValidator(_as_list)] | None = None
    """Names, or patterns such as ``right_*``; all joints where not given."""
    reference: Reference | None = None
    start: Annotated[Time, NotNegative] = 0.0
    end: Annotated[Time, Positive] | None = None
    after: str | None = None
    """Starts when the goal of this control is decided, or its time is over."""
    starts_at_present: bool = False
    """Whether the reference is moved to begin where the tool or the joints then are."""


class TaskControl(Control):
    """Of a tool."""

    tool: str | None = None
    """The scenario's where not given."""
    goal: TaskGoal | None = None


class JointControl(Control):
    """Of joints."""

    goal: JointGoal | None = None


class ComputedTorqueControl(laws.ComputedTorqueController, TaskControl):
    """Task-space computed torque on a group."""


class ComplianceControl(laws.ComplianceController, TaskControl):
    """Compliance on a group."""


class JointComputedTorqueControl(laws.JointComputedTorqueController, JointControl):
    """Joint-space computed torque on a group."""


class JointPidControl(laws.JointPidController, JointControl):
    """A PID for each joint of a group."""


class PythonControl(laws.PythonController, TaskControl):
    """A controller of yours on a group; it returns one effort per joint, and may track a tool."""


_Controls = (
    ComputedTorqueControl | ComplianceControl | JointComputedTorqueControl | JointPidControl | PythonControl
)
AnyControl = Annotated[_Controls, Field(discriminator="kind"), of_kind(_Controls)]
