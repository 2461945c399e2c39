"""The state the run starts from."""

from __future__ import annotations

import math
from typing import Any, ClassVar, Literal

from pydantic import Field, model_validator

from onorbit_rs.scenario.fields import Angle3, AngularRate3, Length3, Number4, Speed3
from onorbit_rs.scenario.joint_values import JointPositions, JointRates
from onorbit_rs.scenario.part import Part
from onorbit_rs.scenario.refusals import wrong


class Attitude(Part):
    """Either a quaternion or three angles; it takes components of the base to components of the frame."""

    other_words: ClassVar = {
        "rpy": "roll_pitch_yaw", "euler": "roll_pitch_yaw", "angles": "roll_pitch_yaw",
        "quaternion": "quaternion_xyzw", "quat": "quaternion_xyzw", "xyzw": "quaternion_xyzw",
    }  # fmt: skip

    quaternion_xyzw: Number4 | None = None
    roll_pitch_yaw: Angle3 | None = None
    """About the frame's fixed x, then y, then z."""

    @model_validator(mode="before")
    @classmethod
    def _from_list(cls, value: Any) -> Any:
        if isinstance(value, list):
            raise wrong("say which: 'quaternion_xyzw: [...]' or 'roll_pitch_yaw: [...]'")
        return value

    @model_validator(mode="after")
    def _is_one_rotation(self) -> Attitude:
        if (self.quaternion_xyzw is None) == (self.roll_pitch_yaw is None):
            raise wrong("give exactly one of 'quaternion_xyzw' and 'roll_pitch_yaw'")
        if self.quaternion_xyzw is not None:
            norm = math.hypot(*self.quaternion_xyzw)
            if abs(norm - 1.0) > 1e-6:
                raise wrong(f"the quaternion has norm {norm:.9g}, off 1 by more than 1e-6")
        return self


class InitialState(Part):
    """Pose and twist of the base, and the joints; zero where not given."""

    other_words: ClassVar = {
        "velocity": "linear_velocity", "spin": "angular_velocity", "orientation": "attitude",
        "q": "joints", "joint_velocities": "joint_rates",
    }  # fmt: skip

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
