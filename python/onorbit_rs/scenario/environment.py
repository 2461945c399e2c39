"""Effects of the environment. A new kind is one class with its ``kind``, added to the union at the end."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from onorbit_rs.scenario.air_and_light import DragEffect, RadiationPressureEffect
from onorbit_rs.scenario.fields import Force3, Time, Torque3
from onorbit_rs.scenario.gravity_field import GravityFieldEffect
from onorbit_rs.scenario.part import Part, of_kind
from onorbit_rs.scenario.refusals import wrong
from onorbit_rs.scenario.third_body import ThirdBodyEffect


class GravityGradientEffect(Part):
    """The gravity-gradient torque on every body, about its own centre of mass; needs an orbit."""

    kind: Literal["gravity_gradient"] = "gravity_gradient"


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


AnyEffect = (
    GravityFieldEffect
    | GravityGradientEffect
    | ThirdBodyEffect
    | BodyWrenchEffect
    | DragEffect
    | RadiationPressureEffect
)
Effect = Annotated[AnyEffect, Field(discriminator="kind"), of_kind(AnyEffect)]
