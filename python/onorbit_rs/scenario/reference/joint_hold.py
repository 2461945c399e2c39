"""Reference that holds joints at constant positions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from pydantic import Field

from onorbit_rs import _core
from onorbit_rs.scenario.joint_values import JointPositions, joint_values
from onorbit_rs.scenario.part import Part

if TYPE_CHECKING:
    from onorbit_rs.scenario.reference.start import Start


class JointHoldReference(Part):
    """Constant joint positions; joints that are not given keep their initial positions."""

    kind: Literal["joint_hold"] = "joint_hold"
    joints: JointPositions = Field(default_factory=list)

    def build(self, at: Start) -> _core.JointHold:
        """Return the engine's reference object, for the joints of the group."""
        return _core.JointHold(at.of_group(joint_values("joints", self.joints, at.joint_positions, at.model)))
