"""Keys that every entry of ``controllers`` has in addition to the keys of its control law."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BeforeValidator, Field

from onorbit_rs import _core
from onorbit_rs.scenario.control.gains import JointTolerance, TaskTolerance
from onorbit_rs.scenario.control.internal_force import InternalForce
from onorbit_rs.scenario.control.law import arguments
from onorbit_rs.scenario.fields import NotNegative, Positive, Time
from onorbit_rs.scenario.part import Part
from onorbit_rs.scenario.reference import Reference


class TaskGoal(Part):
    """Goal of a tool: tolerances are the distance, m, and the angle, rad, between tool and reference."""

    tolerance: TaskTolerance
    """Tolerance at the end of the reference."""
    path_tolerance: TaskTolerance | None = None
    """Tolerance before the end of the reference; if it is exceeded, the control stops and holds the tool."""
    time: Annotated[Time, NotNegative] | None = None
    """Time, s, allowed after the end of the reference. Default: unlimited."""


class JointGoal(Part):
    """Goal of joints: tolerances are position errors, rad or m; one for all joints, or one per joint.

    For a PID with interface ``velocity``, they are rate errors, rad/s or m/s, given without a unit.
    """

    tolerance: JointTolerance
    """Tolerance at the end of the reference."""
    path_tolerance: JointTolerance | None = None
    """Tolerance before the end of the reference; if it is exceeded, the control stops and holds the
    joints."""
    time: Annotated[Time, NotNegative] | None = None
    """Time, s, allowed after the end of the reference. Default: unlimited."""


def _as_list(value: Any) -> Any:
    return [value] if isinstance(value, str) else value


class Control(Part):
    """Joint group, reference and schedule of a control."""

    name: Annotated[str, Field(pattern=r"^[A-Za-z0-9_\-]+$")]
    """Name in results, columns of the trace and messages."""
    joints: Annotated[list[str], Field(min_length=1), BeforeValidator(_as_list)] | None = None
    """Names of joints, or patterns such as ``right_*``. Default: all joints."""
    reference: Reference | None = None
    """Reference of the control. Default: the tool or the joints are held at their initial pose or
    positions."""
    start: Annotated[Time, NotNegative] = 0.0
    """Simulated time at which the control starts, s."""
    end: Annotated[Time, Positive] | None = None
    """Simulated time at which the control ends, s. Default: the end of the run."""
    after: str | None = None
    """Name of another control or an event. This control starts when the other control ends or its goal is
    decided, or when the event happens. A control that an event starts replaces the controls that drive its
    joints."""
    starts_at_present: bool = False
    """Whether the reference is moved so that it starts where the tool or the joints are when the control
    starts."""
    internal_forces: list[InternalForce] = Field(default_factory=list)
    """Internal forces of closed loops that the control commands while it is active, such as the force with
    which two hands squeeze a load."""

    def build_control(self, law: Any, reference: Any, joints: list[str] | None) -> _core.Control:
        """Return the control as an object of the engine, made of a law, a reference and a joint group."""
        goal: TaskGoal | JointGoal | None = getattr(self, "goal", None)
        return _core.Control(
            law, reference=reference, joints=joints, tool=getattr(self, "tool", None), name=self.name,
            start=self.start, end=self.end, after=self.after, starts_at_present=self.starts_at_present,
            goal=None if goal is None else _core.Goal(**arguments(**goal.model_dump())),
            load=getattr(self, "load", None),
            internal_forces=[force.build() for force in self.internal_forces],
        )  # fmt: skip


class TaskControl(Control):
    """Control of a tool by the joints of its group."""

    tool: str | None = None
    """Controlled frame. Default: the ``tool`` of the scenario."""
    load: str | None = None
    """Frame of a captured system, ``SYSTEM/FRAME``, that tracks the reference instead of the tool that holds
    it. The system of the tool must list the captured system in ``knows``."""
    goal: TaskGoal | None = None
    """Goal of the control; the summary of the run contains its result."""


class JointControl(Control):
    """Control of the joints of a group."""

    goal: JointGoal | None = None
    """Goal of the control; the summary of the run contains its result."""
