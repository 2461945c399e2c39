"""Controllers. A new kind is one class with its own ``kind``, added to its union."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator

from onorbit_rs.scenario.fields import (
    NotNegative,
    Number,
    Rate,
    RateGain,
    StiffnessGain,
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


Controller = Annotated[ComputedTorqueController, BeforeValidator(expand_kind)]
