"""Collision shapes that a scenario adds to the links of a robot, or divides into convex pieces."""

from __future__ import annotations

from pathlib import Path
from typing import Self

from pydantic import model_validator

from onorbit_rs import _core
from onorbit_rs.scenario.errors import inconsistent, invalid
from onorbit_rs.scenario.part import Part
from onorbit_rs.scenario.pose import Pose
from onorbit_rs.scenario.shape import MostPieces, Shape


class CollisionShape(Part):
    """Additional collision shape of a link, or division of the link's collision meshes into convex pieces.

    All shapes of a link form a union.
    """

    link: str
    """Name of the link."""
    shape: Shape | None = None
    pose: Pose | None = None
    """Pose of the shape in the frame of the link. Default: the frames coincide."""
    pieces: MostPieces | None = None
    """Instead of ``shape``: largest number of convex pieces into which each collision mesh that the robot's
    file defines for the link is divided."""

    @model_validator(mode="after")
    def _has_a_shape_or_pieces(self) -> Self:
        if self.shape is None and self.pieces is None:
            raise invalid("neither 'shape' nor 'pieces' is given; give one of them")
        if self.shape is not None and self.pieces is not None:
            message = (
                "'pieces' beside 'shape' would divide the meshes of the robot's file, not this shape; move "
                "'pieces' into 'shape'"
            )
            raise inconsistent("pieces", message)
        if self.pose is not None and self.shape is None:
            raise inconsistent("pose", "'pose' is the pose of 'shape'; add 'shape' or omit 'pose'")
        return self

    def add_to(self, model: _core.Model, folder: Path) -> _core.Model:
        """Return the robot with this shape or with divided meshes; relative paths start at ``folder``."""
        if self.shape is None:
            assert self.pieces is not None
            return model.with_convex_pieces(self.link, self.pieces)
        pose = None if self.pose is None else self.pose.transform()
        return model.with_collision(self.link, self.shape.build(folder), pose=pose)
