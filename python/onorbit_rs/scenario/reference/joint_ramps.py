"""Ramps that move one joint after another."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Literal, Self

from pydantic import BeforeValidator, Field, model_validator

from onorbit_rs import _core
from onorbit_rs.common.suggestions import did_you_mean, nearest
from onorbit_rs.exceptions import FrameError
from onorbit_rs.scenario.part import Part
from onorbit_rs.scenario.reference.joint_timing import JointTiming
from onorbit_rs.scenario.reference.times import check_times
from onorbit_rs.scenario.units import ANGLE, LENGTH, parse_quantity

if TYPE_CHECKING:
    from onorbit_rs.scenario.reference.start import Start


class JointMove(Part):
    """Motion of one joint to a position."""

    joint: str
    to: Annotated[float, BeforeValidator(lambda value: parse_quantity(value, ANGLE, LENGTH))]

    def index_and_position(self, group: list[str]) -> tuple[int, float]:
        """Return the index of the joint in its group, and the position at the end of the motion, rad or m.

        Raises
        ------
        FrameError
            If the group does not contain the joint; the message suggests a similar name, if there is one.
        """
        if self.joint not in group:
            raise FrameError(
                f"moves: no joint of the group is named {self.joint!r}{did_you_mean(self.joint, group)}",
                name=self.joint, kind="joint", known=group, suggestion=nearest(self.joint, group),
            )  # fmt: skip
        return group.index(self.joint), self.to


class JointRampsReference(JointTiming):
    """Motions of single joints, one after another, each from rest to rest."""

    kind: Literal["joint_ramps"] = "joint_ramps"
    moves: Annotated[list[JointMove], Field(min_length=1)]

    @model_validator(mode="after")
    def _has_a_time_for_each(self) -> Self:
        check_times(self.times, "move", len(self.moves))
        return self

    def build(self, at: Start) -> _core.JointWaypoints:
        """Return the engine's reference object, for the joints of the group."""
        moves = [move.index_and_position(at.group) for move in self.moves]
        return _core.JointWaypoints.one_by_one(at.of_group(at.joint_positions), moves, **self.timing())
