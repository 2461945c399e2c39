"""Data of a run that the viewer requires in addition to the rows of the trace."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs.common.coordinates import BASE_Q
from onorbit_rs.scenario.control import grip_controls, rate_controls
from onorbit_rs.scenario.targets import PathFrame, Target, path_frame, targets
from onorbit_rs.viewer.font import shown
from onorbit_rs.visuals.geometry import Shape, extent
from onorbit_rs.visuals.shapes import collision_shapes, shapes

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Earth, Model, Orbit
    from onorbit_rs.scenario.build import Built

    Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Setting:
    """The robot, its orbit and its targets.

    ``tool`` is the frame whose pose the trace contains; its path is drawn in ``path_frame``. ``system`` is
    the name of the robot in a world, ``grasps`` are its frames that capture or are captured, and ``grips``
    are the controls that close a gripper to a force. The errors of ``rate_controls`` are those of joint
    rates.
    """

    model: Model
    name: str = ""
    tool: str | None = None
    path_frame: PathFrame = "world"
    orbit: Orbit | None = None
    earth: Earth | None = None
    targets: tuple[Target, ...] = ()
    system: str = ""
    grasps: tuple[str, ...] = ()
    grips: tuple[str, ...] = ()
    rate_controls: tuple[str, ...] = ()

    @classmethod
    def of(cls, built: Built, system: str = "", grasps: tuple[str, ...] = ()) -> Setting:
        """Return the setting of a scenario that was built; ``system`` and ``grasps`` are those of a world."""
        scenario = built.scenario
        return cls(
            built.model,
            scenario.name,
            scenario.tracked_tool,
            path_frame(scenario),
            built.orbit,
            built.earth,
            targets(scenario),
            system,
            grasps,
            grip_controls(scenario.controllers),
            rate_controls(scenario.controllers),
        )

    def entity(self, part: str) -> str:
        """Return the path of an entity in the 3-D scene, which for a system begins with its name."""
        return f"world/{self.system}/{part}" if self.system else f"world/{part}"

    def orbit_entity(self, part: str) -> str:
        """Return the path of an entity in the view of the orbit, which for a system ends in its name."""
        return f"orbit/{part}/{self.system}" if self.system else f"orbit/{part}"

    def frame(self, name: str) -> str:
        """Return the viewer's name of a frame of the robot."""
        return f"{self.system}/{name}" if self.system else name

    def frame_of(self, link: str) -> str:
        """Return the viewer's name of the frame of a link, or of a named frame that is fixed to a link."""
        return self.frame(f"robot/{shown(link)}")

    @cached_property
    def shapes(self) -> list[Shape]:
        """Shapes of the robot that are drawn."""
        return shapes(self.model)

    @cached_property
    def collisions(self) -> list[Shape]:
        """Collision shapes of the robot, which are drawn on request."""
        return collision_shapes(self.model)

    @property
    def robot(self) -> str:
        """Name of the robot for labels."""
        return shown(self.model.name)

    @property
    def label(self) -> str:
        """Name of the system or, for a single robot, of the robot."""
        return self.system or self.robot

    @property
    def base(self) -> str:
        """Name of the base link."""
        return self.model.body_names[0]

    def extent(self, q: Floats) -> tuple[Floats, float]:
        """Return centre and size of the robot over configurations (k, nq), in base axes, m."""
        return extent(self.model, self.shapes, _at_origin(q))

    def tool_pose(self, q: Floats) -> Floats:
        """Return the poses (k, 4, 4) of the tool in configurations (k, nq), in base axes, m."""
        assert self.tool is not None
        return np.asarray(self.model.frame_pose(_at_origin(q), self.tool))


def _at_origin(q: Floats) -> Floats:
    """Return configurations (k, nq) with the base at the origin of the world."""
    moved = q.copy()
    moved[:, BASE_Q] = [0, 0, 0, 0, 0, 0, 1]
    return moved
