"""Drag and radiation pressure: the air, and what the links show to wind and light."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import BeforeValidator, Field, model_validator

from onorbit_rs import _core
from onorbit_rs.scenario.fields import (
    Angle,
    Area,
    Density,
    FilePath,
    Flux,
    Length,
    Length3,
    NotNegative,
    Number,
    Number3,
    Positive,
)
from onorbit_rs.scenario.part import Part, of_kind
from onorbit_rs.scenario.refusals import wrong
from onorbit_rs.scenario.units import NUMBER, parse_quantity

if TYPE_CHECKING:
    from typing import Any

Share = Annotated[Number, NotNegative]


class ConstantAir(Part):
    """The same density everywhere."""

    kind: Literal["constant"] = "constant"
    density: Annotated[Density, NotNegative]

    def make(self, beside: Path) -> _core.Atmosphere:
        """The engine's."""
        return _core.ConstantAtmosphere(self.density)


class ExponentialAir(Part):
    """One layer, or Vallado's table where nothing is given."""

    kind: Literal["exponential"] = "exponential"
    density: Annotated[Density, Positive] | None = None
    altitude: Length | None = None
    scale_height: Annotated[Length, Positive] | None = None

    def make(self, beside: Path) -> _core.Atmosphere:
        """The engine's."""
        return _core.ExponentialAtmosphere(
            density=self.density, altitude=self.altitude, scale_height=self.scale_height
        )


class HarrisPriesterAir(Part):
    """A bulge that follows the Sun; needs an epoch."""

    kind: Literal["harris_priester"] = "harris_priester"
    exponent: Number = 4.0
    lag: Angle | None = None

    def make(self, beside: Path) -> _core.Atmosphere:
        """The engine's."""
        lag = {} if self.lag is None else {"lag": self.lag}
        return _core.HarrisPriester(exponent=self.exponent, **lag)


def _ap(value: object) -> float | list[float]:
    if not isinstance(value, list):
        return parse_quantity(value, NUMBER)
    if len(value) != 7:
        raise wrong(f"ap is one number or seven, not {len(value)}")
    return [parse_quantity(entry, NUMBER) for entry in value]


GeomagneticIndex = Annotated[float | list[float], BeforeValidator(_ap)]


class Nrlmsise00Air(Part):
    """NRLMSISE-00 under constant indices or those of a table; needs an epoch."""

    kind: Literal["nrlmsise00"] = "nrlmsise00"
    f107: Number | None = None
    f107a: Number | None = None
    ap: GeomagneticIndex | None = None
    """One number, or seven: the day's, then the means of the hours before, as NRLMSISE-00 has them."""
    table: FilePath | None = None
    """A CSV beside the scenario."""
    three_hourly: bool = True

    def make(self, beside: Path) -> _core.Atmosphere:
        """The engine's."""
        table = None if self.table is None else beside / self.table
        return _core.Nrlmsise00(
            f107=self.f107, f107a=self.f107a, ap=self.ap, table=table, three_hourly=self.three_hourly
        )


AnyAir = ConstantAir | ExponentialAir | HarrisPriesterAir | Nrlmsise00Air
Air = Annotated[AnyAir, Field(discriminator="kind"), of_kind(AnyAir)]


class FacesSurface(Part):
    """The faces of a link's visual geometry."""

    kind: Literal["faces"] = "faces"
    drag_coefficient: Share = 2.2
    specular: Share = 0.0
    diffuse: Share = 0.0

    def make(self) -> _core.Surface:
        """The engine's."""
        return _core.Faces(
            drag_coefficient=self.drag_coefficient, specular=self.specular, diffuse=self.diffuse
        )


class CannonballSurface(Part):
    """The same from all sides."""

    kind: Literal["cannonball"] = "cannonball"
    area: Annotated[Area, NotNegative]
    drag_coefficient: Share = 2.2
    reflectivity: Share = 1.0

    def make(self) -> _core.Surface:
        """The engine's."""
        return _core.Cannonball(
            self.area, drag_coefficient=self.drag_coefficient, reflectivity=self.reflectivity
        )


class Plate(Part):
    """Flat, seen from the side of its normal; axes and origin of the link."""

    area: Annotated[Area, NotNegative]
    normal: Number3
    centroid: Length3 = Field(default_factory=lambda: [0.0, 0.0, 0.0])


class PlatesSurface(Part):
    """Flat plates."""

    kind: Literal["plates"] = "plates"
    plates: Annotated[list[Plate], Field(min_length=1)]
    drag_coefficient: Share = 2.2
    specular: Share = 0.0
    diffuse: Share = 0.0

    def make(self) -> _core.Surface:
        """The engine's."""
        return _core.Plates(
            [plate.area for plate in self.plates],
            [plate.normal for plate in self.plates],
            [plate.centroid for plate in self.plates],
            drag_coefficient=self.drag_coefficient, specular=self.specular, diffuse=self.diffuse,
        )  # fmt: skip


_Surfaces = FacesSurface | CannonballSurface | PlatesSurface
AnySurface = Annotated[_Surfaces, Field(discriminator="kind"), of_kind(_Surfaces)]


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

    def make(self, beside: Path) -> _core.Effect:
        """The engine's."""
        return _core.Drag(self.atmosphere.make(beside), surfaces=self.made_surfaces())


class RadiationPressureEffect(Covered):
    """The push of sunlight; needs an orbit and an epoch."""

    kind: Literal["radiation_pressure"] = "radiation_pressure"
    flux: Annotated[Flux, NotNegative] = 1361.0
    """W/m² at 1 au."""
    shadow: bool = True
    earth_radius: Annotated[Length, Positive] | None = None

    def make(self, beside: Path) -> _core.Effect:
        """The engine's."""
        radius = {} if self.earth_radius is None else {"earth_radius": self.earth_radius}
        return _core.RadiationPressure(
            surfaces=self.made_surfaces(), flux=self.flux, shadow=self.shadow, **radius
        )
