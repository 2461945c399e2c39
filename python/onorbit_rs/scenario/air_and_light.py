"""Drag and radiation pressure on what the links show to wind and light."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import Field, model_validator

from onorbit_rs import _core
from onorbit_rs.scenario.air import Air, ExponentialAir
from onorbit_rs.scenario.fields import Flux, Length, NotNegative, Positive
from onorbit_rs.scenario.part import Part
from onorbit_rs.scenario.refusals import wrong
from onorbit_rs.scenario.surfaces import AnySurface

if TYPE_CHECKING:
    from typing import Any


class Covered(Part):
    """An effect on surfaces: ``surfaces`` for the robot, or ``bodies`` from link to surface."""

    surfaces: AnySurface | None = None
    """The faces of all links where neither is given."""
    bodies: Annotated[dict[str, AnySurface], Field(min_length=1)] | None = None

    @model_validator(mode="after")
    def _is_covered_once(self) -> Covered:
        if self.surfaces is not None and self.bodies is not None:
            raise wrong("give surfaces for the robot or bodies one by one, not both")
        return self

    def made_surfaces(self) -> Any:
        """As ``oo.Drag`` takes them."""
        if self.bodies is not None:
            return {body: surface.make() for body, surface in self.bodies.items()}
        return None if self.surfaces is None else self.surfaces.make()


class DragEffect(Covered):
    """Drag of air that turns with the Earth; needs an orbit and an earth."""

    kind: Literal["drag"] = "drag"
    atmosphere: Air = Field(default_factory=ExponentialAir)

    def make(self, _model: _core.Model, beside: Path) -> _core.Effect:
        """The engine's."""
        return _core.Drag(self.atmosphere.make(beside), surfaces=self.made_surfaces())


class RadiationPressureEffect(Covered):
    """The push of sunlight; needs an orbit and an epoch."""

    kind: Literal["radiation_pressure"] = "radiation_pressure"
    flux: Annotated[Flux, NotNegative] = 1361.0
    """W/m² at 1 au."""
    shadow: bool = True
    earth_radius: Annotated[Length, Positive] | None = None

    def make(self, _model: _core.Model, _beside: Path) -> _core.Effect:
        """The engine's."""
        radius = {} if self.earth_radius is None else {"earth_radius": self.earth_radius}
        return _core.RadiationPressure(
            surfaces=self.made_surfaces(), flux=self.flux, shadow=self.shadow, **radius
        )
