"""Quintic splines through joint positions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from onorbit_rs import _core
from onorbit_rs.scenario.joint_values import JointPositions, joint_values
from onorbit_rs.scenario.reference.joint_timing import JointTiming
from onorbit_rs.scenario.reference.times import check_times

if TYPE_CHECKING:
    from onorbit_rs.scenario.reference.start import Start


class JointWaypointsReference(JointTiming):
    """Quintic splines from the initial joint positions through points.

    A joint that a point does not contain keeps its position at the point before.
    """

    kind: Literal["joint_waypoints"] = "joint_waypoints"
    points: Annotated[list[JointPositions], Field(min_length=1)]
    stops: bool = True
    """Whether the joints come to rest at each point."""

    @model_validator(mode="after")
    def _has_a_time_for_each(self) -> Self:
        check_times(self.times, "point", len(self.points))
        return self

    def build(self, at: Start) -> _core.JointWaypoints:
        """Return the engine's reference object, for the joints of the group."""
        positions = [at.joint_positions]
        for point in self.points:
            positions.append(joint_values("points", point, positions[-1], at.model))
        points = np.array([at.of_group(position) for position in positions])
        return _core.JointWaypoints(points, stops=self.stops, **self.timing())
