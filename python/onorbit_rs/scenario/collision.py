"""Collision shapes that a scenario adds to the links of a robot."""

from __future__ import annotations

from pathlib import Path

from onorbit_rs import _core
from onorbit_rs.scenario.part import Part
from onorbit_rs.scenario.pose import Pose
from onorbit_rs.scenario.shape import Shape


class CollisionShape(Part):
    """Collision shape of a link, in addition to those of the robot's file; several shapes form a union."""

    link: str
    """Name of the link."""
    shape: Shape
    pose: Pose | None = None
    """Pose of the shape in link axes. Default: the axes coincide."""

    def add_to(self, model: _core.Model, folder: Path) -> _core.Model:
        """Return the robot with this shape; relative paths start at ``folder``."""
        pose = None if self.pose is None else self.pose.transform()
        return model.with_collision(self.link, self.shape.build(folder), pose=pose)
