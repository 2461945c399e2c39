"""Straight line to a goal."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from onorbit_rs import _core
from onorbit_rs.scenario.reference.task import Goal, TimedReference

if TYPE_CHECKING:
    from onorbit_rs.scenario.reference.start import Start


class LineReference(TimedReference):
    """Straight line from rest to rest; the attitude follows the geodesic of SO(3)."""

    kind: Literal["line"] = "line"
    goal: Goal

    def build(self, at: Start) -> _core.Line:
        """Return the engine's reference object."""
        start = self.first_pose(at)
        return _core.Line(start, self.goal.pose(start), frame=self.engine_frame(), **self.limits())
