"""Rows of a run as the viewer takes them: all of a trace, or those that have come since the last look."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import rerun as rr

from onorbit_rs.rotations import (
    conjugate,
    is_local_frame_defined,
    local_orbital_axes,
    product,
    quaternion_from_matrix,
    reference_motion,
)
from onorbit_rs.thinning import evenly
from onorbit_rs.viewer.letters import shown

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Trace

    Floats = NDArray[np.float64]

TIMELINE = "simulation_time"
_POSES = ("tool_pose", "reference_pose")
_PARTS = {"wrench_": 6, "tracking_": None}


@dataclass(frozen=True)
class Rows:
    """Columns by the trace's names, (T, ...).

    ``wrenches`` (T, bodies, 6) by effect, ``tracking`` (T, k) by control.
    """

    columns: Mapping[str, Floats]
    wrenches: Mapping[str, Floats] = field(default_factory=dict)
    tracking: Mapping[str, Floats] = field(default_factory=dict)

    @classmethod
    def of_trace(cls, trace: Trace, chosen: NDArray[np.int64] | slice = slice(None)) -> Rows:
        """Some of a trace, or all of it."""
        return cls(
            {name: np.asarray(getattr(trace, name))[chosen] for name in trace.columns()},
            {shown(name): np.asarray(values)[chosen] for name, values in trace.wrenches.items()},
            {shown(name): np.asarray(values)[chosen] for name, values in trace.tracking.items()},
        )

    @classmethod
    def of_checkpoint(cls, columns: Mapping[str, Floats]) -> Rows:
        """What a checkpoint holds: every column (k, width)."""
        plain: dict[str, Floats] = {}
        parts: dict[str, dict[str, Floats]] = {kind: {} for kind in _PARTS}
        for name, values in columns.items():
            kind = next((kind for kind in _PARTS if name.startswith(kind)), None)
            if kind is not None:
                width = _PARTS[kind]
                shaped = values if width is None else values.reshape(len(values), -1, width)
                parts[kind][shown(name.removeprefix(kind))] = shaped
            elif name in _POSES:
                plain[name] = values.reshape(-1, 4, 4)
            else:
                plain[name] = values[:, 0] if values.shape[1] == 1 and name != "tau" else values
        return cls(plain, parts["wrench_"], parts["tracking_"])

    def __getitem__(self, name: str) -> Floats:
        """A column."""
        return self.columns[name]

    def __contains__(self, name: str) -> bool:
        """Whether the run has a column."""
        return name in self.columns

    def __len__(self) -> int:
        """How many rows."""
        return len(self.columns["time"])

    def thinned(self, most: int) -> Rows:
        """At most so many, evenly, the last one among them."""
        if len(self) <= most:
            return self
        chosen = evenly(len(self), most)
        parts = (self.columns, self.wrenches, self.tracking)
        return Rows(*({name: values[chosen] for name, values in part.items()} for part in parts))

    def last(self) -> Rows:
        """The columns of the last row."""
        return Rows({name: values[-1:] for name, values in self.columns.items()})

    def after(self, earlier: Rows) -> Rows:
        """The columns of these rows, with those of an earlier part before them."""
        return Rows(
            {name: np.concatenate([earlier.columns[name], values]) for name, values in self.columns.items()}
        )

    @cached_property
    def times(self) -> rr.TimeColumn:
        """When each row is."""
        return rr.TimeColumn(TIMELINE, duration=self["time"])

    @cached_property
    def rot_wl(self) -> Floats | None:
        """(T, 3, 3), L of the reference orbit to W; None where there is no orbit or L is undefined on it."""
        if "position_eci" not in self:
            return None
        r, v = reference_motion(self["q"], self["v"], self["position_eci"], self["velocity_eci"])
        return local_orbital_axes(r, v) if is_local_frame_defined(r, v) else None

    @cached_property
    def quat_wl(self) -> Floats | None:
        """(T, 4), L to W."""
        return None if self.rot_wl is None else quaternion_from_matrix(self.rot_wl)

    @cached_property
    def quat_lb(self) -> Floats | None:
        """(T, 4), B to L."""
        return None if self.quat_wl is None else product(conjugate(self.quat_wl), self["q"][:, 3:7])
