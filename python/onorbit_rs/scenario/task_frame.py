"""The frame that a reference of a tool is written in: one with a name, or that of a target."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Literal

from pydantic import BeforeValidator, Discriminator, Field, Tag

from onorbit_rs.names import nearest
from onorbit_rs.scenario.fields import AngularRate3, Length3, Speed3
from onorbit_rs.scenario.initial import Attitude
from onorbit_rs.scenario.part import Part
from onorbit_rs.scenario.refusals import shown, wrong

ORIGIN = [0.0, 0.0, 0.0]


class Pose(Part):
    """A place and an attitude; the frame's own where not given."""

    position: Length3 = Field(default_factory=lambda: list(ORIGIN))
    attitude: Attitude | None = None


class TargetMotion(Pose):
    """A spacecraft that nothing acts on: its pose at time zero in W, constant velocity and spin in W axes."""

    other_words: ClassVar = {
        "angular_velocity": "spin", "angular_rate": "spin", "rate": "spin", "linear_velocity": "velocity",
        "orientation": "attitude",
    }  # fmt: skip

    velocity: Speed3 = Field(default_factory=lambda: list(ORIGIN))
    spin: AngularRate3 = Field(default_factory=lambda: list(ORIGIN))
    size: Length3 | None = None
    """Edges of the box that the viewer draws for it."""


class TargetFrame(Part):
    """The frame of a target."""

    target: TargetMotion


FRAMES = ("world", "lvlh", "base")


def _frame(value: Any) -> Any:
    """A name or a target, each checked as what it is."""
    if value in FRAMES or isinstance(value, (dict, TargetFrame)):
        return value
    near = nearest(value, FRAMES) if isinstance(value, str) else None
    raise wrong(
        f"{shown(value)} is no frame{f', did you mean {near!r}?' if near else ''}; there are "
        f"{', '.join(FRAMES)} and {{target: {{position: ..., velocity: ..., spin: ...}}}}"
    )


Frame = Annotated[
    Annotated[Literal["world", "lvlh", "base"], Tag("name")] | Annotated[TargetFrame, Tag("a target")],
    Discriminator(lambda value: "name" if isinstance(value, str) else "a target"),
    BeforeValidator(_frame),
]
"""World W, the local orbital frame L, the axes of the base at its first place, or those of a target."""
