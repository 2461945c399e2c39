"""What the viewer must know of a run beside its rows."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs.appearance import shapes
from onorbit_rs.geometry import Shape, extent
from onorbit_rs.scenario.targets import Target, targets
from onorbit_rs.viewer.letters import shown
from onorbit_rs.viewer.targets import PathFrame, path_frame

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Earth, Model, Orbit
    from onorbit_rs.scenario.build import Built

    Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Setting:
    """The robot and where it flies.

    ``tool`` is the frame whose pose the trace has; ``path_frame`` the one in whose axes its path is drawn.
    """

    model: Model
    name: str = ""
    tool: str | None = None
    path_frame: PathFrame = "world"
    orbit: Orbit | None = None
    earth: Earth | None = None
    targets: tuple[Target, ...] = ()

    @classmethod
    def of(cls, built: Built) -> Setting:
        """Of a scenario."""
        scenario = built.scenario
        return cls(
            built.model,
            scenario.name,
            scenario.tracked_tool,
            path_frame(scenario),
            built.orbit,
            built.earth,
            targets(scenario),
        )

    @cached_property
    def shapes(self) -> list[Shape]:
        """What there is to draw of the robot."""
        return shapes(self.model)

    @property
    def robot(self) -> str:
        """Its name, as labels show it."""
        return shown(self.model.name)

    @property
    def base(self) -> str:
        """The link that floats."""
        return self.model.body_names[0]

    def extent(self, q: Floats) -> tuple[Floats, float]:
        """Centre and size of the robot in all of some configurations (k, 7 + n), axes of the base, m."""
        return extent(self.model, self.shapes, _at_origin(q))

    def tool_pose(self, q: Floats) -> Floats:
        """Of the tool in some configurations (k, 7 + n), axes of the base: (k, 4, 4), m."""
        assert self.tool is not None
        return np.asarray(self.model.frame_pose(_at_origin(q), self.tool))


def _at_origin(q: Floats) -> Floats:
    """Configurations (k, 7 + n) with the base in the origin of the world."""
    moved = q.copy()
    moved[:, :7] = [0, 0, 0, 0, 0, 0, 1]
    return moved
