"""Limits and times of joint references."""

from __future__ import annotations

from typing import Annotated, Any

from onorbit_rs.scenario.fields import JointAcceleration, JointRate, Positive, Time
from onorbit_rs.scenario.part import Part
from onorbit_rs.scenario.reference.times import with_start


class JointTiming(Part):
    """Timing of a joint reference: given times, or the shortest times that limits on all joints allow."""

    speed: Annotated[JointRate, Positive] | None = None
    """Largest rate of every joint, rad/s or m/s."""
    acceleration: Annotated[JointAcceleration, Positive] | None = None
    """Largest acceleration of every joint, rad/s² or m/s²."""
    times: list[Time] | None = None
    """Time of each point, s, from the start of the reference."""

    def timing(self) -> dict[str, Any]:
        """Return times and limits as keyword arguments of the references of the engine."""
        return {"times": with_start(self.times), "speed": self.speed, "acceleration": self.acceleration}
