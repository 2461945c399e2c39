"""Forces that controls command closed loops to transmit."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from onorbit_rs import _core
from onorbit_rs.scenario.fields import Force, Torque
from onorbit_rs.scenario.part import Part

Forces = Annotated[list[Force], Field(min_length=3, max_length=3)]
Moments = Annotated[list[Torque], Field(min_length=3, max_length=3)]


class InternalForce(Part):
    """Force that a closed loop is to transmit.

    It acts on the second frame of the loop, in the axes of the loop's joint on the first frame and about its
    origin. For a capture, it is the wrench of the capturing frame on the captured system, in the axes of the
    captured frame at its origin.
    """

    loop: str
    """Name of a loop, or of the capture that closes it. Without effect while the loop is not closed."""
    force: Forces | None = None
    """Force, N. Default: that of the joint torques with the least norm."""
    moment: Moments | None = None
    """Moment, N m. Default: that of the joint torques with the least norm."""

    def build(self) -> _core.InternalForce:
        """Return the force as an object of the engine."""
        return _core.InternalForce(self.loop, force=self.force, moment=self.moment)
