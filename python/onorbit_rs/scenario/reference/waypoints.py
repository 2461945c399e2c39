"""Quintic splines through poses."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from onorbit_rs import _core
from onorbit_rs.scenario.fields import Time
from onorbit_rs.scenario.reference.task import Goal, LimitedReference
from onorbit_rs.scenario.reference.times import check_times, with_start

if TYPE_CHECKING:
    from onorbit_rs.scenario.reference.start import Start


class WaypointsReference(LimitedReference):
    """Quintic splines through poses, with given times or the shortest times that the limits allow."""

    kind: Literal["waypoints"] = "waypoints"
    points: Annotated[list[Goal], Field(min_length=1)]
    times: list[Time] | None = None
    """Time of each pose, s, from the start of the reference."""
    stops: bool = True
    """Whether the tool comes to rest at each pose."""

    @model_validator(mode="after")
    def _has_a_time_for_each(self) -> Self:
        check_times(self.times, "point", len(self.points))
        return self

    def build(self, at: Start) -> _core.Waypoints:
        """Return the engine's reference object."""
        start = self.first_pose(at)
        poses = np.array([start, *(goal.pose(start) for goal in self.points)])
        return _core.Waypoints(
            poses, times=with_start(self.times), stops=self.stops, frame=self.engine_frame(), **self.limits()
        )
