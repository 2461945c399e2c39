"""Joint reference from a table of positions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from onorbit_rs import _core
from onorbit_rs.scenario.csv_table import read_table
from onorbit_rs.scenario.fields import FilePath
from onorbit_rs.scenario.part import Part

if TYPE_CHECKING:
    from onorbit_rs.scenario.reference.start import Start


class JointSampledReference(Part):
    """Positions from a CSV file with the columns ``time`` and joint names; other joints are held."""

    kind: Literal["joint_sampled"] = "joint_sampled"
    file: FilePath
    """CSV file with values in s, rad and m; its path is relative to the scenario."""

    def build(self, at: Start) -> _core.JointSampled:
        """Return the engine's reference object, for the joints of the group."""
        group = at.group
        table = read_table(at.folder / self.file, {name: (name,) for name in ("time", *group)}, ("time",))
        time = table.pop("time").ravel()
        positions = np.tile(at.of_group(at.joint_positions), (len(time), 1))
        for name, column in table.items():
            positions[:, group.index(name)] = column.ravel()
        return _core.JointSampled(time, positions)
