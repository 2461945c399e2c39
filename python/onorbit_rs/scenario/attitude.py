"""Attitude of a frame, as a quaternion or as three angles."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from pydantic import model_validator

from onorbit_rs.common.numbers import shortest
from onorbit_rs.common.rotations import quaternion_from_roll_pitch_yaw
from onorbit_rs.scenario.errors import invalid
from onorbit_rs.scenario.fields import Angle3, Number4
from onorbit_rs.scenario.part import Part

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]


class Attitude(Part):
    """Rotation from body axes to the axes of the frame: either a quaternion or three angles."""

    synonyms: ClassVar = {
        "rpy": "roll_pitch_yaw", "euler": "roll_pitch_yaw", "angles": "roll_pitch_yaw",
        "quaternion": "quaternion_xyzw", "quat": "quaternion_xyzw", "xyzw": "quaternion_xyzw",
    }  # fmt: skip

    quaternion_xyzw: Number4 | None = None
    roll_pitch_yaw: Angle3 | None = None
    """Rotations, rad, about the fixed x, y and z axes of the frame, in this order."""

    @model_validator(mode="before")
    @classmethod
    def _reject_list(cls, value: Any) -> Any:
        if isinstance(value, list):
            raise invalid(
                "must not be a list; write either 'quaternion_xyzw: [...]' or 'roll_pitch_yaw: [...]'"
            )
        return value

    @model_validator(mode="after")
    def _is_one_rotation(self) -> Attitude:
        if (self.quaternion_xyzw is None) == (self.roll_pitch_yaw is None):
            given = "none" if self.quaternion_xyzw is None else "both"
            raise invalid(f"give exactly one of 'quaternion_xyzw' and 'roll_pitch_yaw'; given: {given}")
        if self.quaternion_xyzw is not None:
            norm = math.hypot(*self.quaternion_xyzw)
            if abs(norm - 1.0) > 1e-6:
                raise invalid(
                    f"the quaternion has norm {shortest(norm)}; it must be 1 within 1e-6; normalise it"
                )
        return self


def quaternion_of(attitude: Attitude | None) -> Floats:
    """Return the unit quaternion xyzw of an attitude; the identity if it is None."""
    if attitude is None:
        return np.array([0.0, 0.0, 0.0, 1.0])
    if attitude.quaternion_xyzw is not None:
        quat: Floats = np.array(attitude.quaternion_xyzw)
        quat /= np.linalg.norm(quat)
        return quat
    return quaternion_from_roll_pitch_yaw(np.array(attitude.roll_pitch_yaw))
