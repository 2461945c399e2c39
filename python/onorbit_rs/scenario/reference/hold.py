"""Reference that holds a tool at a constant pose."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from onorbit_rs import _core
from onorbit_rs.scenario.reference.task import TaskReference

if TYPE_CHECKING:
    from onorbit_rs.scenario.reference.start import Start


class HoldReference(TaskReference):
    """Constant pose of the tool, by default its pose at the start."""

    kind: Literal["hold"] = "hold"

    def build(self, at: Start) -> _core.Hold:
        """Return the engine's reference object."""
        return _core.Hold(self.first_pose(at), frame=self.engine_frame())
