"""Circular arc and helix about an axis."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np

from onorbit_rs import _core
from onorbit_rs.scenario.fields import Angle, Length, Length3, Number, Number3, Positive
from onorbit_rs.scenario.reference.task import TimedReference

if TYPE_CHECKING:
    from onorbit_rs.scenario.reference.start import Start


class CircleReference(TimedReference):
    """Circular arc about an axis."""

    kind: Literal["circle"] = "circle"
    center: Length3
    """Point on the axis, m, relative to the start of the reference, in the axes of ``frame``."""
    axis: Number3
    """Direction of the axis, in the axes of ``frame``."""
    angle: Angle
    """Angle of the arc about ``axis``, rad."""
    turns: bool = True
    """Whether the attitude rotates with the arc."""
    ramp: Annotated[Number, Positive] | None = None
    """Fraction of the duration for each of the ramps to and from a constant rate. Default: a quintic
    profile."""

    def build(self, at: Start) -> _core.Reference:
        """Return the engine's reference object."""
        start = self.first_pose(at)
        return _core.Circle(start, **self._shape(start))

    def _shape(self, start: np.ndarray[Any, Any]) -> dict[str, Any]:
        return {
            "center": start[:3, 3] + self.center, "axis": np.array(self.axis), "angle": self.angle,
            "turns": self.turns, "ramp": self.ramp, "frame": self.engine_frame(),
        } | self.limits()  # fmt: skip


class ScrewReference(CircleReference):
    """Helix: circular arc with a displacement along its axis."""

    kind: Literal["screw"] = "screw"  # type: ignore[assignment]  # narrows the discriminator of the base
    advance: Length
    """Displacement along ``axis`` from the start to the end of the arc, m."""

    def build(self, at: Start) -> _core.Reference:
        """Return the engine's reference object."""
        start = self.first_pose(at)
        return _core.Screw(start, advance=self.advance, **self._shape(start))
