"""State of the robot from which references start."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs import _core
from onorbit_rs.common.coordinates import JOINTS_Q

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs.scenario.initial import Neighbour

    Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Start:
    """State of the robot at time zero, with the frame or the joints that a controller moves."""

    model: _core.Model
    q: Floats
    """Configuration (nq,)."""
    orbit: _core.Orbit | None
    folder: Path
    """Folder of the scenario; relative paths start there."""
    tool: str | None = None
    """Frame that tracks the reference; None for joint references."""
    joints: tuple[str, ...] | None = None
    """Names of the joints that track a joint reference; default: all joints."""
    neighbours: Mapping[str, Neighbour] = field(default_factory=dict)
    """Other systems of the world, at time zero."""
    load: str | None = None
    """Frame ``SYSTEM/FRAME`` of a load that tracks the reference instead of the tool, which holds it."""

    def tool_pose(self) -> Floats:
        """Return the pose (4, 4) in W of the frame that tracks the reference: the load or the tool."""
        if self.load is not None:
            name, _, frame = self.load.partition("/")
            system = self.neighbours[name]
            return np.asarray(system.model.frame_pose(system.q, frame))
        assert self.tool is not None, "a reference of a tool is built for a tool"
        return np.asarray(self.model.frame_pose(self.q, self.tool))

    @property
    def group(self) -> list[str]:
        """Names of the joints in the group."""
        return list(self.joints or self.model.joint_names)

    def of_group(self, values: Floats) -> Floats:
        """Return the values of the joints of the group, (len(group),), from those of all joints, (n,)."""
        names = list(self.model.joint_names)
        return values[[names.index(name) for name in self.group]]

    @property
    def joint_positions(self) -> Floats:
        """Positions of all joints, (n,), rad or m."""
        return self.q[JOINTS_Q]
