"""Effects of the environment of scenarios.

To add an effect, write a class with its keys and ``build``, and add the class to the union.
"""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from onorbit_rs.scenario.environment.body_wrench import BodyWrenchEffect
from onorbit_rs.scenario.environment.gravity_field import GravityFieldEffect
from onorbit_rs.scenario.environment.gravity_gradient import GravityGradientEffect
from onorbit_rs.scenario.environment.python import PythonEffect
from onorbit_rs.scenario.environment.surface_effects import DragEffect, RadiationPressureEffect
from onorbit_rs.scenario.environment.third_body import ThirdBodyEffect
from onorbit_rs.scenario.part import of_kind

__all__ = ["AnyEffect", "BodyWrenchEffect", "Effect", "PythonEffect"]

AnyEffect = (
    GravityFieldEffect
    | GravityGradientEffect
    | ThirdBodyEffect
    | BodyWrenchEffect
    | DragEffect
    | RadiationPressureEffect
    | PythonEffect
)
Effect = Annotated[AnyEffect, Field(discriminator="kind"), of_kind(AnyEffect)]
