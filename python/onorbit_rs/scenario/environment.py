"""Effects of the environment. A new kind is one class: its keys, ``make``, a place in the union."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import numpy as np
from pydantic import Field, model_validator

from onorbit_rs import _core
from onorbit_rs.exceptions import FrameError
from onorbit_rs.names import did_you_mean, nearest
from onorbit_rs.scenario.air_and_light import DragEffect, RadiationPressureEffect
from onorbit_rs.scenario.fields import Force3, Time, Torque3
from onorbit_rs.scenario.gravity_field import GravityFieldEffect
from onorbit_rs.scenario.part import Part, of_kind
from onorbit_rs.scenario.refusals import wrong
from onorbit_rs.scenario.third_body import ThirdBodyEffect


class GravityGradientEffect(Part):
    """The gravity-gradient torque on every body, about its own centre of mass; needs an orbit."""

    kind: Literal["gravity_gradient"] = "gravity_gradient"

    def make(self, _model: _core.Model, _beside: Path) -> _core.Effect:
        """The engine's."""
        return _core.GravityGradient()


class BodyWrenchEffect(Part):
    """A force and a torque on one body, constant in its own axes, from ``start`` to ``end``."""

    kind: Literal["body_wrench"] = "body_wrench"
    body: str
    force: Force3 = Field(default_factory=lambda: [0.0, 0.0, 0.0])
    torque: Torque3 = Field(default_factory=lambda: [0.0, 0.0, 0.0])
    start: Time = 0.0
    end: Time | None = None
    """Until the end of the run where not given."""

    @model_validator(mode="after")
    def _ends_after_start(self) -> BodyWrenchEffect:
        if self.end is not None and self.end <= self.start:
            raise wrong(f"the wrench ends at {self.end:g} s, not after its start at {self.start:g} s")
        return self

    def make(self, model: _core.Model, _beside: Path) -> _core.Effect:
        """The engine's; raises ``FrameError`` where the robot has no such body."""
        bodies = list(model.body_names)
        if self.body not in bodies:
            raise FrameError(
                f"no body is named {self.body!r}{did_you_mean(self.body, bodies)}",
                name=self.body, kind="body", known=bodies, suggestion=nearest(self.body, bodies),
            )  # fmt: skip
        times = {"start": self.start} | ({} if self.end is None else {"end": self.end})
        return _core.BodyWrench(self.body, force=np.array(self.force), torque=np.array(self.torque), **times)


AnyEffect = (
    GravityFieldEffect
    | GravityGradientEffect
    | ThirdBodyEffect
    | BodyWrenchEffect
    | DragEffect
    | RadiationPressureEffect
)
Effect = Annotated[AnyEffect, Field(discriminator="kind"), of_kind(AnyEffect)]
