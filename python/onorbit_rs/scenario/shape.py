"""Collision shapes of a scenario."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from onorbit_rs import _core
from onorbit_rs.scenario.errors import inconsistent
from onorbit_rs.scenario.fields import FilePath, Length, Number3, Positive
from onorbit_rs.scenario.part import Part, of_kind

Distance = Annotated[Length, Positive]


class Sphere(Part):
    """Sphere centred at the origin."""

    kind: Literal["sphere"]
    radius: Distance

    def build(self, folder: Path) -> _core.Shape:
        """Return the shape as an object of the engine."""
        return _core.Shape.sphere(self.radius)


class Box(Part):
    """Box centred at the origin, with edges along the axes."""

    kind: Literal["box"]
    size: Annotated[list[Distance], Field(min_length=3, max_length=3)]
    """Lengths of the edges along x, y and z, m."""

    def build(self, folder: Path) -> _core.Shape:
        """Return the shape as an object of the engine."""
        return _core.Shape.box(*self.size)


class Cylinder(Part):
    """Cylinder along z, centred at the origin."""

    kind: Literal["cylinder"]
    radius: Distance
    length: Distance

    def build(self, folder: Path) -> _core.Shape:
        """Return the shape as an object of the engine."""
        return _core.Shape.cylinder(self.radius, self.length)


class Capsule(Part):
    """Cylinder along z, centred at the origin, with a hemisphere at each end."""

    kind: Literal["capsule"]
    radius: Distance
    length: Distance
    """Distance between the centres of the caps, m."""

    def build(self, folder: Path) -> _core.Shape:
        """Return the shape as an object of the engine."""
        return _core.Shape.capsule(self.radius, self.length)


class Cone(Part):
    """Cone along z, with its base at ``z = -height/2`` and its apex at ``z = height/2``."""

    kind: Literal["cone"]
    radius: Distance
    """Radius of the base, m."""
    height: Distance

    def build(self, folder: Path) -> _core.Shape:
        """Return the shape as an object of the engine."""
        return _core.Shape.cone(self.radius, self.height)


class Torus(Part):
    """Torus about the z axis, centred at the origin."""

    kind: Literal["torus"]
    major_radius: Distance
    """Radius of the circle in the middle of the tube, m."""
    minor_radius: Distance
    """Radius of the tube, m, less than ``major_radius``."""

    @model_validator(mode="after")
    def _has_a_hole(self) -> Self:
        if self.minor_radius >= self.major_radius:
            message = f"{self.minor_radius:g} m must be less than the major_radius, {self.major_radius:g} m"
            raise inconsistent("minor_radius", message)
        return self

    def build(self, folder: Path) -> _core.Shape:
        """Return the shape as an object of the engine."""
        return _core.Shape.torus(self.major_radius, self.minor_radius)


class HalfSpace(Part):
    """Half-space of all points with z of at most 0; its surface is the plane z = 0."""

    kind: Literal["half_space"]

    def build(self, folder: Path) -> _core.Shape:
        """Return the shape as an object of the engine."""
        return _core.Shape.half_space()


MostPieces = Annotated[int, Field(ge=1, le=1000)]
"""Largest number of convex pieces of a mesh."""


class MeshHull(Part):
    """Convex hull of a mesh, or its convex pieces."""

    kind: Literal["mesh"]
    file: FilePath
    """STL or OBJ file."""
    scale: Number3 = Field(default_factory=lambda: [1.0, 1.0, 1.0])
    """Scale factors along the axes of the mesh."""
    pieces: MostPieces | None = None
    """Largest number of convex pieces, which follow notches and holes. Default: the convex hull."""

    def build(self, folder: Path) -> _core.Shape:
        """Return the shape; a relative path starts at ``folder``."""
        return _core.Shape.mesh(folder / self.file, scale=self.scale, pieces=self.pieces)


AnyShape = Sphere | Box | Cylinder | Capsule | Cone | Torus | HalfSpace | MeshHull
Shape = Annotated[AnyShape, Field(discriminator="kind"), of_kind(AnyShape)]
