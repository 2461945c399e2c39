"""Surfaces of the links for drag and radiation pressure."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag

from onorbit_rs import _core
from onorbit_rs.scenario.fields import Area, Length3, NotNegative, Number, Number3
from onorbit_rs.scenario.part import Part, of_kind

Coefficient = Annotated[Number, NotNegative]


class FacesSurface(Part):
    """Surface that consists of the faces of a link's visual geometry."""

    kind: Literal["faces"] = "faces"
    drag_coefficient: Coefficient = 2.2
    specular: Coefficient = 0.0
    diffuse: Coefficient = 0.0

    def build(self) -> _core.Surface:
        """Return the engine's surface object."""
        return _core.Faces(
            drag_coefficient=self.drag_coefficient, specular=self.specular, diffuse=self.diffuse
        )


class CannonballSurface(Part):
    """Sphere-like surface with the same area in all directions (cannonball model)."""

    kind: Literal["cannonball"] = "cannonball"
    area: Annotated[Area, NotNegative]
    drag_coefficient: Coefficient = 2.2
    reflectivity: Coefficient = 1.0

    def build(self) -> _core.Surface:
        """Return the engine's surface object."""
        return _core.Cannonball(
            self.area, drag_coefficient=self.drag_coefficient, reflectivity=self.reflectivity
        )


class Plate(Part):
    """One-sided flat plate; its outward normal and its centroid are given in the frame of the link."""

    area: Annotated[Area, NotNegative]
    normal: Number3
    centroid: Length3 = Field(default_factory=lambda: [0.0, 0.0, 0.0])


class PlatesSurface(Part):
    """Set of flat plates."""

    kind: Literal["plates"] = "plates"
    plates: Annotated[list[Plate], Field(min_length=1)]
    drag_coefficient: Coefficient = 2.2
    specular: Coefficient = 0.0
    diffuse: Coefficient = 0.0

    def build(self) -> _core.Surface:
        """Return the engine's surface object."""
        return _core.Plates(
            [plate.area for plate in self.plates],
            [plate.normal for plate in self.plates],
            [plate.centroid for plate in self.plates],
            drag_coefficient=self.drag_coefficient, specular=self.specular, diffuse=self.diffuse,
        )  # fmt: skip


_Surfaces = FacesSurface | CannonballSurface | PlatesSurface
AnySurface = Annotated[_Surfaces, Field(discriminator="kind"), of_kind(_Surfaces)]


def _form(value: Any) -> str:
    return "by link" if isinstance(value, dict) and "kind" not in value else "one surface"


RobotSurfaces = Annotated[
    Annotated[AnySurface, Tag("one surface")]
    | Annotated[dict[str, AnySurface], Field(min_length=1), Tag("by link")],
    Discriminator(_form),
]
"""Field type: one surface for all links, or a mapping from links to surfaces."""


def build_surfaces(surfaces: Any) -> Any:
    """Return the engine's surfaces: one for all links, or a mapping by link; None if none are given."""
    if isinstance(surfaces, dict):
        return {link: surface.build() for link, surface in surfaces.items()}
    return None if surfaces is None else surfaces.build()
