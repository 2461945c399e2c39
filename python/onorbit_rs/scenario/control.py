"""Controllers and references. A new kind is one class with its own ``kind``, added to its union."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field

from onorbit_rs.scenario.fields import (
    Length3,
    NotNegative,
    Number,
    Positive,
    Rate,
    RateGain,
    StiffnessGain,
    Time,
)
from onorbit_rs.scenario.part import Part, expand_kind


class ComputedTorqueController(Part):
    """The paper's Eq. (6)-(8) in task space, with the exact drift."""

    kind: Literal["computed_torque"] = "computed_torque"
    kp: StiffnessGain = 100.0
    """On the pose error, 1/s²: a number, six, or 6 x 6; linear first."""
    kd: RateGain = 20.0
    """On the velocity error, 1/s."""
    damping: Annotated[Number, NotNegative] = 0.05
    """Of the pseudo-inverse near singularities."""
    null_space_damping: Annotated[Rate, NotNegative] = 0.0
    """On the motion that does not move the tool, 1/s; brings a redundant arm to rest."""
    compensate_environment: bool = True
    """Whether the controller knows the wrenches of the environment."""
    compensate_friction: bool = True
    """Whether the controller knows the damping and friction of the joints."""


class HoldReference(Part):
    """The tool stays where it starts."""

    kind: Literal["hold"] = "hold"


class LineParabolaReference(Part):
    """Start + s·displacement + s(1 - s)·height, s the quintic from 0 to 1; attitude held, later the end."""

    kind: Literal["line_parabola"] = "line_parabola"
    displacement: Length3
    """From the tool's first position to its last, W axes."""
    height: Length3 = Field(default_factory=lambda: [0.0, 0.0, 0.0])
    """Factor of s(1 - s), W axes; a quarter of it is the top of the parabola."""
    duration: Annotated[Time, Positive]


Controller = Annotated[ComputedTorqueController, BeforeValidator(expand_kind)]
Reference = Annotated[
    Annotated[HoldReference | LineParabolaReference, Field(discriminator="kind")],
    BeforeValidator(expand_kind),
]
