"""Internal forces of closed loops, which controls command."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from onorbit_rs import _core
from onorbit_rs.scenario.fields import Force, Torque
from onorbit_rs.scenario.part import Part

Forces = Annotated[list[Force], Field(min_length=3, max_length=3)]
Moments = Annotated[list[Torque], Field(min_length=3, max_length=3)]


class InternalForce(Part):
    """Commanded internal force and moment of a closed loop.

    They act on the second frame of the loop, and are given in the axes and about the origin of the loop's
    joint on the first frame. For a capture, they are the wrench that the capturing frame exerts on the
    captured system, in the axes and about the origin of the captured frame.
    """

    loop: str
    """Name of a loop, or of the capture that closes it. The entry has no effect while the loop is open."""
    force: Forces | None = None
    """Force, N. Default: the force that results from the joint torques of least norm."""
    moment: Moments | None = None
    """Moment, N m. Default: the moment that results from the joint torques of least norm."""

    def build(self) -> _core.InternalForce:
        """Return the force as an object of the engine."""
        return _core.InternalForce(self.loop, force=self.force, moment=self.moment)
