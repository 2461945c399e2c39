"""What the links show to wind and light."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from onorbit_rs import _core
from onorbit_rs.scenario.fields import Area, Length3, NotNegative, Number, Number3
from onorbit_rs.scenario.part import Part, of_kind

Share = Annotated[Number, NotNegative]


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
