"""Limits and times of joint references."""

from __future__ import annotations

from typing import Annotated, Any

from onorbit_rs.scenario.fields import JointAcceleration, JointRate, Positive, Time
from onorbit_rs.scenario.part import Part
from onorbit_rs.scenario.reference.times import with_start


class JointTiming(Part):
    """Joint reference with given times, or as fast as its limits allow; limits apply to every joint."""

    speed: Annotated[JointRate, Positive] | None = None
    """Largest rate of each joint."""
    acceleration: Annotated[JointAcceleration, Positive] | None = None
    """Largest acceleration of each joint."""
    times: list[Time] | None = None
    """Times of the points; the start is at time zero."""

    def timing(self) -> dict[str, Any]:
        """Return times and limits as keyword arguments of the references of the engine."""
        return {"times": with_start(self.times), "speed": self.speed, "acceleration": self.acceleration}
