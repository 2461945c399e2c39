"""References of a tool, as a scenario writes them, and the union of all.

A new kind is one class with its own ``kind``, added to the union. Those of a tool begin at its first pose
unless ``start`` is given, and are written in the axes of ``frame``.
"""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from onorbit_rs.scenario.fields import (
    Acceleration,
    Angle,
    AngularAcceleration,
    AngularRate,
    FilePath,
    Length,
    Length3,
    Number,
    Number3,
    Positive,
    Speed,
    Time,
)
from onorbit_rs.scenario.initial import Attitude
from onorbit_rs.scenario.joint_reference_parts import (
    JointHoldReference,
    JointRampsReference,
    JointSampledReference,
    JointWaypointsReference,
    check_times,
)
from onorbit_rs.scenario.part import Part, of_kind
from onorbit_rs.scenario.refusals import wrong
from onorbit_rs.scenario.task_frame import ORIGIN, Frame, Pose


class Goal(Part):
    """Where to go: from the start, or as a place in the frame."""

    displacement: Length3 | None = None
    turn: Attitude | None = None
    """From the start's attitude, about the frame's axes."""
    position: Length3 | None = None
    attitude: Attitude | None = None

    @model_validator(mode="after")
    def _says_each_once(self) -> Goal:
        if self.displacement is not None and self.position is not None:
            raise wrong("give either 'displacement' (from the start) or 'position' (in the frame)")
        if self.turn is not None and self.attitude is not None:
            raise wrong("give either 'turn' (from the start) or 'attitude' (in the frame)")
        return self


class TaskReference(Part):
    """What all references of a tool share."""

    frame: Frame = "world"
    start: Pose | None = None
    """Where it begins; where the tool is, if not given."""


class Limits(TaskReference):
    """As fast as these allow."""

    speed: Annotated[Speed, Positive] | None = None
    acceleration: Annotated[Acceleration, Positive] | None = None
    angular_speed: Annotated[AngularRate, Positive] | None = None
    angular_acceleration: Annotated[AngularAcceleration, Positive] | None = None


class Timed(Limits):
    """In a given duration, or as fast as limits allow."""

    duration: Annotated[Time, Positive] | None = None


class HoldReference(TaskReference):
    """The tool stays where it starts."""

    kind: Literal["hold"] = "hold"


class LineParabolaReference(TaskReference):
    """Start + s·displacement + s(1 - s)·height, s the quintic from 0 to 1; attitude held, later the end."""

    kind: Literal["line_parabola"] = "line_parabola"
    displacement: Length3
    """From the tool's first position to its last."""
    height: Length3 = Field(default_factory=lambda: list(ORIGIN))
    """Factor of s(1 - s); a quarter of it is the top of the parabola."""
    duration: Annotated[Time, Positive]


class LineReference(Timed):
    """Straight, from rest to rest; the attitude on the geodesic of SO(3)."""

    kind: Literal["line"] = "line"
    goal: Goal


class CircleReference(Timed):
    """Round an axis."""

    kind: Literal["circle"] = "circle"
    center: Length3
    """A point of the axis, from the start."""
    axis: Number3
    angle: Angle
    turns: bool = True
    """Whether the attitude turns along."""
    ramp: Annotated[Number, Positive] | None = None
    """Share of the duration in each ramp to a constant rate; the quintic where not given."""


class ScrewReference(CircleReference):
    """Round an axis and along it."""

    kind: Literal["screw"] = "screw"  # type: ignore[assignment]  # the discriminator of its own class
    advance: Length


class WaypointsReference(Limits):
    """Quintics through poses; ``times`` of the points, the start being at zero, or limits."""

    kind: Literal["waypoints"] = "waypoints"
    points: Annotated[list[Goal], Field(min_length=1)]
    times: list[Time] | None = None
    stops: bool = True
    """Whether it rests at each point."""

    @model_validator(mode="after")
    def _has_a_time_for_each(self) -> Self:
        check_times(self.times, "point", len(self.points))
        return self


class SampledReference(TaskReference):
    """From a CSV with the header ``time,x,y,z,qx,qy,qz,qw`` and, where known, ``vx,vy,vz,wx,wy,wz``; SI."""

    kind: Literal["sampled"] = "sampled"
    file: FilePath
    """Beside the scenario."""
    relative: bool = False
    """Whether the motion is moved so that it begins at the start."""


AnyReference = (
    HoldReference
    | LineParabolaReference
    | LineReference
    | CircleReference
    | ScrewReference
    | WaypointsReference
    | SampledReference
    | JointHoldReference
    | JointWaypointsReference
    | JointRampsReference
    | JointSampledReference
)
Reference = Annotated[AnyReference, Field(discriminator="kind"), of_kind(AnyReference)]
