"""Rows of a trace that are sent to the viewer: all rows of a run, or those since the last update."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import rerun as rr

from onorbit_rs.common.coordinates import BASE_NQ, QUATERNION
from onorbit_rs.common.decimate import evenly_spaced
from onorbit_rs.common.rotations import (
    conjugate,
    is_local_frame_defined,
    local_orbital_axes,
    product,
    quaternion_from_matrix,
)
from onorbit_rs.output.columns import row_shape, split_path
from onorbit_rs.viewer.font import shown

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Trace

    Floats = NDArray[np.float64]

TIMELINE = "simulation_time"


@dataclass(frozen=True)
class TraceRows:
    """Rows of a trace: ``columns`` maps the name of each column to its values, (T, ...).

    ``wrenches``, (T, bodies, 6), are stored by effect, ``tracking`` errors, (T, k), by control,
    ``contacts``, (T, 19), by contact, and ``loops``, (T, 11), by loop.
    """

    columns: Mapping[str, Floats]
    wrenches: Mapping[str, Floats] = field(default_factory=dict)
    tracking: Mapping[str, Floats] = field(default_factory=dict)
    contacts: Mapping[str, Floats] = field(default_factory=dict)
    loops: Mapping[str, Floats] = field(default_factory=dict)

    @classmethod
    def of_trace(cls, trace: Trace, chosen: NDArray[np.int64] | slice = slice(None)) -> TraceRows:
        """Return the chosen rows of a trace."""
        return cls(
            {name: np.asarray(getattr(trace, name))[chosen] for name in trace.columns()},
            {shown(name): np.asarray(values)[chosen] for name, values in trace.wrenches.items()},
            {shown(name): np.asarray(values)[chosen] for name, values in trace.tracking.items()},
            {shown(name): np.asarray(one.values)[chosen] for name, one in trace.contacts.items()},
            {shown(name): np.asarray(one.values)[chosen] for name, one in trace.loops.items()},
        )

    @classmethod
    def of_checkpoint(cls, columns: Mapping[str, Floats]) -> TraceRows:
        """Return the rows of a checkpoint, with its flat (rows, width) columns reshaped as in a trace."""
        plain: dict[str, Floats] = {}
        owned: dict[str, dict[str, Floats]] = {
            "wrenches": {}, "tracking": {}, "contacts": {}, "loops": {},
        }  # fmt: skip
        joints = columns["q"].shape[1] - BASE_NQ
        for path, values in columns.items():
            name, owner = split_path(path)
            shaped = values.reshape(len(values), *row_shape(name, joints))
            if owner is None:
                plain[name] = shaped
            else:
                owned[name][shown(owner)] = shaped
        return cls(plain, **owned)

    def __getitem__(self, name: str) -> Floats:
        """Return the values, (T, ...), of a column."""
        return self.columns[name]

    def __contains__(self, name: str) -> bool:
        """Return True if the run recorded a column."""
        return name in self.columns

    def __len__(self) -> int:
        """Return the number of rows."""
        return len(self.columns["time"])

    def decimated(self, most: int) -> TraceRows:
        """Return at most ``most`` evenly spaced rows, including the last row."""
        if len(self) <= most:
            return self
        return self.at(evenly_spaced(len(self), most))

    def at(self, chosen: NDArray[np.int64] | slice) -> TraceRows:
        """Return the rows with the chosen indices."""
        parts = (self.columns, self.wrenches, self.tracking, self.contacts, self.loops)
        return TraceRows(*({name: values[chosen] for name, values in part.items()} for part in parts))

    def last(self) -> TraceRows:
        """Return the last row of the columns, without wrenches, tracking errors, contacts and loops."""
        return TraceRows({name: values[-1:] for name, values in self.columns.items()})

    def after(self, earlier: TraceRows) -> TraceRows:
        """Return these rows preceded by the rows ``earlier``, with the columns that both contain.

        A stepper omits columns without entries, such as the efforts of a robot without joints.
        """
        both = (name for name in self.columns if name in earlier.columns)
        return TraceRows({name: np.concatenate([earlier.columns[name], self.columns[name]]) for name in both})

    @cached_property
    def times(self) -> rr.TimeColumn:
        """Times of the rows on the viewer's timeline."""
        return rr.TimeColumn(TIMELINE, duration=self["time"])

    @cached_property
    def rot_wl(self) -> Floats | None:
        """Rotations (T, 3, 3) from L of the reference orbit to W; None if L is undefined."""
        if "reference_position_eci" not in self:
            return None
        r, v = self["reference_position_eci"], self["reference_velocity_eci"]
        return local_orbital_axes(r, v) if is_local_frame_defined(r, v) else None

    @cached_property
    def quat_wl(self) -> Floats | None:
        """Quaternions xyzw (T, 4) of the rotation from L to W; None if L is undefined."""
        return None if self.rot_wl is None else quaternion_from_matrix(self.rot_wl)

    @cached_property
    def quat_lb(self) -> Floats | None:
        """Quaternions xyzw (T, 4) of the rotation from B to L; None if L is undefined."""
        return None if self.quat_wl is None else product(conjugate(self.quat_wl), self["q"][:, QUATERNION])
