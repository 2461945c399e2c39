"""Straight line with a parabola added to it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np
from pydantic import Field

from onorbit_rs import _core
from onorbit_rs.scenario.fields import Length3, Positive, Time
from onorbit_rs.scenario.reference.task import TaskReference

if TYPE_CHECKING:
    from onorbit_rs.scenario.reference.start import Start


class LineParabolaReference(TaskReference):
    """Position `start + s displacement + s (1 - s) height`, constant attitude; quintic `s(t)` from 0 to 1."""

    kind: Literal["line_parabola"] = "line_parabola"
    displacement: Length3
    """Displacement from the first to the last position, m, in the axes of ``frame``."""
    height: Length3 = Field(default_factory=lambda: [0.0, 0.0, 0.0])
    """Coefficient of s(1 - s), m, in the axes of ``frame``; at s = 1/2, a quarter of ``height`` is added to
    the line."""
    duration: Annotated[Time, Positive]

    def build(self, at: Start) -> _core.LineParabola:
        """Return the engine's reference object."""
        return _core.LineParabola(
            self.first_pose(at), displacement=np.array(self.displacement), height=np.array(self.height),
            duration=self.duration, frame=self.engine_frame(),
        )  # fmt: skip
