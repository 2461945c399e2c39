"""References of joints, as a scenario writes them."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import BeforeValidator, Field, model_validator

from onorbit_rs.counting import count
from onorbit_rs.scenario.fields import FilePath, JointAcceleration, JointRate, Positive, Time
from onorbit_rs.scenario.joint_values import JointPositions
from onorbit_rs.scenario.part import Part
from onorbit_rs.scenario.refusals import wrong
from onorbit_rs.scenario.units import ANGLE, LENGTH, parse_quantity


def check_times(times: list[float] | None, what: str, points: int) -> None:
    """Refuse times that are not one for each of the points."""
    if times is not None and len(times) != points:
        entries = count(len(times), "entry", "entries")
        wanted = count(points, what, f"{what}s")
        raise wrong(f"times has {entries} for {wanted}: give one for each, the start being at zero")


class JointHoldReference(Part):
    """Joints stay, where they start or where ``joints`` says."""

    kind: Literal["joint_hold"] = "joint_hold"
    joints: JointPositions = Field(default_factory=list)


class JointTimed(Part):
    """As fast as limits, the same for all joints, allow."""

    speed: Annotated[JointRate, Positive] | None = None
    acceleration: Annotated[JointAcceleration, Positive] | None = None
    times: list[Time] | None = None
    """Of the points, the start being at zero."""


class JointWaypointsReference(JointTimed):
    """Quintics from where the joints start through points; joints that are not named stay."""

    kind: Literal["joint_waypoints"] = "joint_waypoints"
    points: Annotated[list[JointPositions], Field(min_length=1)]
    stops: bool = True

    @model_validator(mode="after")
    def _has_a_time_for_each(self) -> Self:
        check_times(self.times, "point", len(self.points))
        return self


class JointMove(Part):
    """One joint to a position."""

    joint: str
    to: Annotated[float, BeforeValidator(lambda value: parse_quantity(value, ANGLE, LENGTH))]


class JointRampsReference(JointTimed):
    """One joint after the other, each from rest to rest."""

    kind: Literal["joint_ramps"] = "joint_ramps"
    moves: Annotated[list[JointMove], Field(min_length=1)]

    @model_validator(mode="after")
    def _has_a_time_for_each(self) -> Self:
        check_times(self.times, "move", len(self.moves))
        return self


class JointSampledReference(Part):
    """From a CSV with the header ``time`` and names of joints; rad and m. Joints that are not named stay."""

    kind: Literal["joint_sampled"] = "joint_sampled"
    file: FilePath
