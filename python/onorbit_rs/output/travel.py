"""A trace between processes: its arrays and what it said of itself, under the same names."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.output.saved_trace import SavedTrace

if TYPE_CHECKING:
    from onorbit_rs._core import Trace


@dataclass(frozen=True)
class TravelledTrace(SavedTrace):
    """What a pickled :class:`onorbit_rs.Trace` comes back as: no instance of it, read-only as it."""

    is_complete: bool
    wall_s: float
    results: Sequence[Any]
    told: Mapping[str, Any]

    def __post_init__(self) -> None:
        """Columns out of a pickle can be written."""
        for rows in self.arrays.values():
            rows.setflags(write=False)

    def __reduce__(self) -> tuple[Any, ...]:
        """Its fields, to be made anew."""
        return TravelledTrace, tuple(getattr(self, part.name) for part in fields(self))

    def certificate(self) -> Any:
        """As the trace gave it."""
        return self.told["certificate"]

    def joint_limits_exceeded(self) -> Any:
        """As the trace gave it."""
        return self.told["joint_limits_exceeded"]

    def __len__(self) -> int:
        """Rows."""
        return len(self.arrays.get("time", ()))


def arrays_of(trace: Trace) -> dict[str, Any]:
    """The columns of a trace under their own names, the errors of each controller, the wrenches."""
    arrays = {name: np.asarray(getattr(trace, name)) for name in trace.columns()}
    arrays |= {f"tracking_{name}": np.asarray(errors) for name, errors in trace.tracking.items()}
    return arrays | {f"wrench_{name}": np.asarray(rows) for name, rows in trace.wrenches.items()}


def reduced(trace: Trace) -> tuple[Any, ...]:
    """How a trace pickles (``__reduce__``)."""
    told = {"certificate": trace.certificate(), "joint_limits_exceeded": trace.joint_limits_exceeded()}
    arrays = arrays_of(trace) | {"rereferenced": np.asarray(trace.rereferenced)}
    return TravelledTrace, (arrays, trace.is_complete, trace.wall_s, list(trace.results), told)
