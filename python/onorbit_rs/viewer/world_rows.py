"""Rows of several systems, all in the same frame W."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs.common.decimate import evenly_spaced
from onorbit_rs.viewer.trace_rows import TraceRows

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import WorldTrace
    from onorbit_rs.viewer.world_setting import WorldSetting

    Floats = NDArray[np.float64]

_REFERENCE = ("reference_position_eci", "reference_velocity_eci")


@dataclass(frozen=True)
class WorldRows:
    """Rows of each system; systems that cannot interact may have rows at different times."""

    setting: WorldSetting
    systems: Mapping[str, TraceRows]

    @classmethod
    def of_trace(cls, trace: WorldTrace, setting: WorldSetting, most: int | None = None) -> WorldRows:
        """Return the rows of a trace, decimated to at most ``most`` rows per system."""
        found = {}
        for name in setting.names:
            own = trace[name]
            count = len(own.time)
            chosen = slice(None) if most is None or count <= most else evenly_spaced(count, most)
            found[name] = TraceRows.of_trace(own, chosen)
        return cls(setting, found)

    @classmethod
    def of_columns(cls, columns: Mapping[str, Floats], setting: WorldSetting) -> WorldRows:
        """Return the rows in the columns of a stepper, whose names begin with the name of the system."""
        found = {}
        for name in setting.names:
            prefix = f"{name}/"
            own = {path.removeprefix(prefix): values for path, values in columns.items()
                   if path.startswith(prefix)}  # fmt: skip
            found[name] = TraceRows.of_checkpoint(own)
        return cls(setting, found)

    def __getitem__(self, name: str) -> TraceRows:
        """Return the rows of a system."""
        return self.systems[name]

    @property
    def first(self) -> TraceRows:
        """Rows of the first system."""
        return next(iter(self.systems.values()))

    @cached_property
    def all_times(self) -> TraceRows:
        """Time and reference orbit of the rows of all systems, at distinct times in ascending order."""
        parts = list(self.systems.values())
        names = [name for name in ("time", *_REFERENCE) if name in self.first]
        if all(np.array_equal(part["time"], self.first["time"]) for part in parts):
            return TraceRows({name: self.first[name] for name in names})
        _, rows = np.unique(np.concatenate([part["time"] for part in parts]), return_index=True)
        return TraceRows({name: np.concatenate([part[name] for part in parts])[rows] for name in names})

    @cached_property
    def center(self) -> Floats:
        """Centre of mass of all systems together in W, (T, 3), m, at the times of :attr:`all_times`."""
        time, total = self.all_times["time"], np.zeros((len(self.all_times), 3))
        masses = {name: system.model.mass for name, system in self.setting.systems.items()}
        for name, rows in self.systems.items():
            place = rows["center_of_mass"]
            total += masses[name] * np.stack([np.interp(time, rows["time"], x) for x in place.T], axis=1)
        return total / sum(masses.values())
