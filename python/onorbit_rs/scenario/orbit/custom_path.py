"""Orbits through given points."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import model_validator

from onorbit_rs import _core
from onorbit_rs.scenario.csv_table import read_table
from onorbit_rs.scenario.errors import invalid
from onorbit_rs.scenario.fields import (
    Acceleration3,
    FilePath,
    GravitationalParameter,
    Length3,
    Number4,
    Positive,
    Speed3,
    Time,
)
from onorbit_rs.scenario.orbit.gravity_mode import GravityMode
from onorbit_rs.scenario.part import Part

COLUMNS = {
    "times": ("t",),
    "positions": ("x", "y", "z"),
    "velocities": ("vx", "vy", "vz"),
    "accelerations": ("ax", "ay", "az"),
    "attitudes": ("qx", "qy", "qz", "qw"),
}
"""Columns of a file of points, in SI units, by the argument of :class:`onorbit_rs.CustomPath`."""


class CustomPathOrbit(Part):
    """Path with continuous acceleration through points, which are given in the scenario or in a CSV file."""

    kind: Literal["custom_path"] = "custom_path"
    times: list[Time] | None = None
    positions: list[Length3] | None = None
    velocities: list[Speed3] | None = None
    accelerations: list[Acceleration3] | None = None
    attitudes: list[Number4] | None = None
    """Quaternions xyzw that rotate path axes to inertial axes."""
    file: FilePath | None = None
    """CSV file with a header and the columns ``t,x,y,z[,vx,vy,vz[,ax,ay,az]][,qx,qy,qz,qw]``, SI."""
    mu: Annotated[GravitationalParameter, Positive] | None = None
    """Gravitational parameter, m³/s²; default: no planet and no gravity."""
    ends: Literal["error", "coast"] = "error"
    gravity_mode: GravityMode = "true"

    def build(self, folder: Path) -> _core.CustomPath:
        """Return the orbit; relative paths start at ``folder``."""
        points: dict[str, Any]
        if self.file is None:
            given = {name: getattr(self, name) for name in COLUMNS}
            points = {name: np.array(rows) for name, rows in given.items() if rows is not None}
        else:
            points = read_table(folder / self.file, COLUMNS, ("times", "positions"))
            points["times"] = points["times"].ravel()
        return _core.CustomPath(**points, mu=self.mu, ends=self.ends)

    @model_validator(mode="after")
    def _is_one_path(self) -> CustomPathOrbit:
        inline = [name for name in ("times", "positions") if getattr(self, name) is not None]
        if self.file is not None:
            extra = [name for name in ("velocities", "accelerations", "attitudes") if getattr(self, name)]
            if inline or extra:
                raise invalid(
                    f"'file' defines the path; omit 'file', or omit {' and '.join(map(repr, inline + extra))}"
                )
        elif len(inline) != 2:
            raise invalid("the path is incomplete; give 'times' and 'positions', or a 'file' with them")
        return self
