"""Drag and radiation pressure on the surfaces of the links."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import Field, model_validator

from onorbit_rs import _core
from onorbit_rs.scenario.environment.atmosphere import Air, ExponentialAir
from onorbit_rs.scenario.environment.surfaces import AnySurface
from onorbit_rs.scenario.errors import invalid
from onorbit_rs.scenario.fields import Flux, Length, NotNegative, Positive
from onorbit_rs.scenario.part import Part

if TYPE_CHECKING:
    from typing import Any


class SurfaceEffect(Part):
    """Effect on surfaces: ``surfaces`` for all links, or ``bodies``, a mapping from link to surface."""

    surfaces: AnySurface | None = None
    """Surface of all links. Default, if ``bodies`` is not given either: their visual geometry."""
    bodies: Annotated[dict[str, AnySurface], Field(min_length=1)] | None = None

    @model_validator(mode="after")
    def _is_given_once(self) -> SurfaceEffect:
        if self.surfaces is not None and self.bodies is not None:
            raise invalid(
                "'surfaces' and 'bodies' are both given; give 'surfaces' for all links, or 'bodies' by link"
            )
        return self

    def build_surfaces(self) -> Any:
        """Return the surfaces: one for all links, a mapping from link to surface, or None for the default."""
        if self.bodies is not None:
            return {body: surface.build() for body, surface in self.bodies.items()}
        return None if self.surfaces is None else self.surfaces.build()


class DragEffect(SurfaceEffect):
    """Drag in an atmosphere that rotates with the Earth; requires an orbit and an epoch or ``earth``."""

    kind: Literal["drag"] = "drag"
    atmosphere: Air = Field(default_factory=ExponentialAir)

    def build(self, _model: _core.Model, folder: Path) -> _core.Effect:
        """Return the effect of the engine."""
        return _core.Drag(self.atmosphere.build(folder), surfaces=self.build_surfaces())


class RadiationPressureEffect(SurfaceEffect):
    """Solar radiation pressure; requires an orbit and an epoch."""

    kind: Literal["radiation_pressure"] = "radiation_pressure"
    flux: Annotated[Flux, NotNegative] = 1361.0
    """Solar flux at 1 au, W/m²."""
    shadow: bool = True
    earth_radius: Annotated[Length, Positive] | None = None

    def build(self, _model: _core.Model, _folder: Path) -> _core.Effect:
        """Return the effect of the engine."""
        radius = {} if self.earth_radius is None else {"earth_radius": self.earth_radius}
        return _core.RadiationPressure(
            surfaces=self.build_surfaces(), flux=self.flux, shadow=self.shadow, **radius
        )
