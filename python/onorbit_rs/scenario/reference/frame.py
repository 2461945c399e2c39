"""Frame in which a reference of a tool is expressed: a named frame or the frame of a target."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import BeforeValidator, Discriminator, Field, Tag

from onorbit_rs import _core
from onorbit_rs.common.suggestions import nearest
from onorbit_rs.scenario.errors import invalid, shortened
from onorbit_rs.scenario.fields import AngularRate3, Length3, Speed3
from onorbit_rs.scenario.part import Part
from onorbit_rs.scenario.pose import Pose


class TargetMotion(Pose):
    """Motion of a free-flying spacecraft in W: its pose at time zero, constant velocity and constant spin."""

    synonyms: ClassVar = {
        "angular_velocity": "spin", "angular_rate": "spin", "rate": "spin", "linear_velocity": "velocity",
        "orientation": "attitude",
    }  # fmt: skip

    velocity: Speed3 = Field(default_factory=lambda: [0.0, 0.0, 0.0])
    """Velocity of the origin, m/s, in axes of W."""
    spin: AngularRate3 = Field(default_factory=lambda: [0.0, 0.0, 0.0])
    """Angular velocity, rad/s, in axes of W."""
    size: Length3 | None = None
    """Edge lengths, m, of the box that the viewer draws at the target. Default: no box."""


class TargetFrame(Part):
    """Frame of a free-flying target."""

    target: TargetMotion

    def build(self) -> _core.Target:
        """Return the engine's target object."""
        motion = self.target
        return _core.Target(
            motion.transform(), velocity=np.array(motion.velocity), spin=np.array(motion.spin)
        )


FRAMES = ("world", "lvlh", "base")


def _frame(value: Any) -> Any:
    """Return a valid frame name or the data of a target; raise an error for other values."""
    if value in FRAMES or isinstance(value, (dict, TargetFrame)):
        return value
    if isinstance(value, str) and all(value.partition("/")):
        return value
    near = nearest(value, FRAMES) if isinstance(value, str) else None
    raise invalid(
        f"{shortened(value)} is not a frame{f' (did you mean {near!r}?)' if near else ''}; give one of "
        f"{', '.join(FRAMES)}, SYSTEM/FRAME, or {{target: {{position: ..., velocity: ..., spin: ...}}}}"
    )


Frame = Annotated[
    Annotated[str, Tag("name")] | Annotated[TargetFrame, Tag("a target")],
    Discriminator(lambda value: "name" if isinstance(value, str) else "a target"),
    BeforeValidator(_frame),
]
"""Frame of a reference: the world W, the local orbital frame L, the base of the robot, a frame of another
system, or a target."""


def moving_frame(frame: Any) -> tuple[str, str] | None:
    """Return the names of the system and of its frame for a frame of another system, otherwise None."""
    system, slash, name = frame.partition("/") if isinstance(frame, str) else ("", "", "")
    return (system, name) if slash else None
