"""Base classes of references of a tool, and goals relative to the start of a reference."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from pydantic import model_validator

from onorbit_rs import _core
from onorbit_rs.common.coordinates import POSITION, QUATERNION
from onorbit_rs.common.rotations import matrix_from_quaternion
from onorbit_rs.scenario.attitude import Attitude, quaternion_of
from onorbit_rs.scenario.errors import invalid
from onorbit_rs.scenario.fields import (
    Acceleration,
    AngularAcceleration,
    AngularRate,
    Length3,
    Positive,
    Speed,
    Time,
)
from onorbit_rs.scenario.part import Part
from onorbit_rs.scenario.pose import Pose
from onorbit_rs.scenario.reference.frame import Frame, TargetFrame, moving_frame

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs.scenario.reference.start import Start

    Floats = NDArray[np.float64]

_LIMITS = {"duration", "speed", "acceleration", "angular_speed", "angular_acceleration"}


class Goal(Part):
    """Pose to be reached, given relative to the start or in the frame of the reference.

    A position or an attitude that is not given is that of the start.
    """

    displacement: Length3 | None = None
    """Displacement from the start position, m, in the axes of the frame."""
    turn: Attitude | None = None
    """Rotation from the start attitude, about the axes of the frame."""
    position: Length3 | None = None
    """Position of the goal in the frame, m."""
    attitude: Attitude | None = None
    """Attitude of the goal in the frame."""

    @model_validator(mode="after")
    def _is_given_once(self) -> Goal:
        if self.displacement is not None and self.position is not None:
            raise invalid(
                "'displacement' (from the start) and 'position' (in the frame) are both given; omit one"
            )
        if self.turn is not None and self.attitude is not None:
            raise invalid("'turn' (from the start) and 'attitude' (in the frame) are both given; omit one")
        return self

    def pose(self, start: Floats) -> Floats:
        """Return the pose (4, 4) of the goal in the frame of the reference, given its start pose (4, 4)."""
        pose = start.copy()
        if self.turn is not None:
            pose[:3, :3] = matrix_from_quaternion(quaternion_of(self.turn)) @ start[:3, :3]
        if self.attitude is not None:
            pose[:3, :3] = matrix_from_quaternion(quaternion_of(self.attitude))
        if self.displacement is not None:
            pose[:3, 3] += self.displacement
        if self.position is not None:
            pose[:3, 3] = self.position
        return pose


class TaskReference(Part, ABC):
    """Base class of references that a tool tracks."""

    frame: Frame = "world"
    """Frame of all poses of the reference."""
    start: Pose | None = None
    """Start pose of the reference, in ``frame``. Default: the pose of the tool at the start of the run."""

    @abstractmethod
    def build(self, at: Start) -> _core.Reference:
        """Return the engine's reference object, for a robot in the state ``at``."""

    def engine_frame(self) -> Any:
        """Return the frame as the engine's references expect it in the argument ``frame``."""
        return self.frame.build() if isinstance(self.frame, TargetFrame) else self.frame

    def first_pose(self, at: Start) -> Floats:
        """Return the pose (4, 4) at which the reference starts, in its frame."""
        if self.start is not None:
            return self.start.transform()
        tool = at.tool_pose()
        frame = np.eye(4)
        if isinstance(self.frame, TargetFrame):
            frame = self.frame.target.transform()
        elif (path := moving_frame(self.frame)) is not None:
            system = at.neighbours[path[0]]
            frame = np.asarray(system.model.frame_pose(system.q, path[1]))
        elif self.frame == "base":
            frame[:3, :3], frame[:3, 3] = matrix_from_quaternion(at.q[QUATERNION]), at.q[POSITION]
        elif self.frame == "lvlh" and at.orbit is not None:
            frame[:3, :3] = at.orbit.lvlh(0.0)[0]
        rot, pos = frame[:3, :3], frame[:3, 3]
        start = np.eye(4)
        start[:3, :3], start[:3, 3] = rot.T @ tool[:3, :3], rot.T @ (tool[:3, 3] - pos)
        return start


class LimitedReference(TaskReference):
    """Reference of a tool with limits; without times, its duration is the shortest that the limits allow."""

    speed: Annotated[Speed, Positive] | None = None
    """Largest speed of the tool, m/s."""
    acceleration: Annotated[Acceleration, Positive] | None = None
    """Largest acceleration of the tool, m/s²."""
    angular_speed: Annotated[AngularRate, Positive] | None = None
    """Largest angular rate of the tool, rad/s."""
    angular_acceleration: Annotated[AngularAcceleration, Positive] | None = None
    """Largest angular acceleration of the tool, rad/s²."""

    def limits(self) -> dict[str, Any]:
        """Return the given limits, as keyword arguments of the references of the engine."""
        return self.model_dump(include=_LIMITS, exclude_none=True)


class TimedReference(LimitedReference):
    """Reference of a tool with a given duration, or with the shortest duration that its limits allow."""

    duration: Annotated[Time, Positive] | None = None
    """Duration of the motion, s, as an alternative to limits."""
