"""Drag and radiation pressure on the surfaces of the links."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self

from pydantic import Field, model_validator

from onorbit_rs import _core
from onorbit_rs.scenario.environment.atmosphere import Air, ExponentialAir
from onorbit_rs.scenario.environment.paths import split_link
from onorbit_rs.scenario.environment.surfaces import AnySurface, build_surfaces
from onorbit_rs.scenario.errors import invalid
from onorbit_rs.scenario.fields import Flux, Length, NotNegative, Positive
from onorbit_rs.scenario.part import Part

if TYPE_CHECKING:
    from collections.abc import Collection


class SurfaceEffect(Part):
    """Effect on surfaces: ``surfaces`` for all links, or ``bodies``, a mapping from link to surface."""

    surfaces: AnySurface | None = None
    """Surface of all links. If ``bodies`` is not given either, the default is the ``surfaces`` of the robot
    or of each system, otherwise the visual geometry."""
    bodies: Annotated[dict[str, AnySurface], Field(min_length=1)] | None = None
    """Surfaces by link; with several systems by ``SYSTEM/LINK``, or by ``SYSTEM`` for all links of a
    system."""

    @model_validator(mode="after")
    def _is_given_once(self) -> SurfaceEffect:
        if self.surfaces is not None and self.bodies is not None:
            raise invalid(
                "'surfaces' and 'bodies' are both given; give 'surfaces' for all links, or 'bodies' by link"
            )
        return self

    def build_surfaces(self) -> Any:
        """Return the engine's surfaces: one for all links, a mapping by link, or None for the default."""
        return build_surfaces(self.surfaces if self.bodies is None else self.bodies)

    def with_default(self, surfaces: Any) -> Self:
        """Return the effect with these default surfaces (one, or by link) if it defines no surfaces."""
        if surfaces is None or self.surfaces is not None or self.bodies is not None:
            return self
        key = "bodies" if isinstance(surfaces, dict) else "surfaces"
        return self.model_copy(update={key: surfaces})

    @property
    def paths(self) -> list[tuple[tuple[str, ...], str]]:
        """Locations (keys) and values of the entries that name systems or links on which the effect acts."""
        return [(("bodies", path), path) for path in self.bodies or {}]

    def of_system(self, name: str, systems: Collection[str]) -> Self | None:
        """Return the effect on the system ``name`` alone; None if it acts only on other systems."""
        if self.bodies is None:
            return self
        own = {}
        for path, surface in self.bodies.items():
            system, link = split_link(path, systems)
            if system == name and not link:
                return self.model_copy(update={"bodies": None, "surfaces": surface})
            if system == name:
                own[link] = surface
        return self.model_copy(update={"bodies": own}) if own else None


class DragEffect(SurfaceEffect):
    """Drag in an atmosphere that rotates with the Earth. It requires an orbit and an epoch or ``earth``."""

    kind: Literal["drag"] = "drag"
    atmosphere: Air = Field(default_factory=ExponentialAir)

    def build(self, _model: _core.Model | None, folder: Path) -> _core.Effect:
        """Return the engine's effect object."""
        return _core.Drag(self.atmosphere.build(folder), surfaces=self.build_surfaces())


class RadiationPressureEffect(SurfaceEffect):
    """Solar radiation pressure, which requires an orbit and an epoch."""

    kind: Literal["radiation_pressure"] = "radiation_pressure"
    flux: Annotated[Flux, NotNegative] = 1361.0
    """Solar flux at 1 au, W/m²."""
    shadow: bool = True
    """Whether the shadow of the Earth (umbra and penumbra) is modelled."""
    earth_radius: Annotated[Length, Positive] | None = None
    """Radius of the Earth used for its shadow, m. Default: that of the engine."""

    def build(self, _model: _core.Model | None, _folder: Path) -> _core.Effect:
        """Return the engine's effect object."""
        radius = {} if self.earth_radius is None else {"earth_radius": self.earth_radius}
        return _core.RadiationPressure(
            surfaces=self.build_surfaces(), flux=self.flux, shadow=self.shadow, **radius
        )
