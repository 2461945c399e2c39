"""The state the run starts from."""

from __future__ import annotations

import math
from typing import Any, Literal

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from onorbit_rs.scenario.fields import (
    Angle3,
    AngularRate3,
    JointPositions,
    JointRates,
    Length3,
    Number4,
    Speed3,
)
from onorbit_rs.scenario.part import Part


class Attitude(Part):
    """Either a quaternion or three angles; it takes components of the base to components of the frame."""

    quaternion_xyzw: Number4 | None = None
    roll_pitch_yaw: Angle3 | None = None
    """About the frame's fixed x, then y, then z."""

    @model_validator(mode="before")
    @classmethod
    def _from_list(cls, value: Any) -> Any:
        if isinstance(value, list):
            raise PydanticCustomError(
                "attitude", "say which: 'quaternion_xyzw: [...]' or 'roll_pitch_yaw: [...]'"
            )
        return value

    @model_validator(mode="after")
    def _is_one_rotation(self) -> Attitude:
        if (self.quaternion_xyzw is None) == (self.roll_pitch_yaw is None):
            raise PydanticCustomError(
                "attitude", "give exactly one of 'quaternion_xyzw' and 'roll_pitch_yaw'"
            )
        if self.quaternion_xyzw is not None:
            norm = math.hypot(*self.quaternion_xyzw)
            if abs(norm - 1.0) > 1e-6:
                raise PydanticCustomError(
                    "attitude",
                    "the quaternion has norm {norm}, off 1 by more than 1e-6",
                    {"norm": f"{norm:.9g}"},
                )
        return self


class InitialState(Part):
    """Pose and twist of the base, and the joints; zero where not given."""

    frame: Literal["world", "lvlh", "path"] = "world"
    """What ``position`` and ``attitude`` are given in, and what the velocities are relative to: W, the
    local orbital frame L (x radial outward, y along track, z along the orbital angular momentum), or the
    attitude of the path (L where it has none)."""
    position: Length3 = Field(default_factory=lambda: [0.0, 0.0, 0.0])
    attitude: Attitude | None = None
    linear_velocity: Speed3 = Field(default_factory=lambda: [0.0, 0.0, 0.0])
    """Of the base's origin, body axes."""
    angular_velocity: AngularRate3 = Field(default_factory=lambda: [0.0, 0.0, 0.0])
    """Of the base, body axes."""
    joints: JointPositions = Field(default_factory=list)
    """In the order of the model's joints, or by name."""
    joint_rates: JointRates = Field(default_factory=list)
