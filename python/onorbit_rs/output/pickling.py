"""Pickling of a trace: the unpickled object has the same columns and computed results as attributes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.output.columns import path_of
from onorbit_rs.output.saved_trace import SavedTrace

if TYPE_CHECKING:
    from onorbit_rs._core import EventRecord, Trace


@dataclass(frozen=True)
class PickledTrace(SavedTrace):
    """Result of unpickling a :class:`onorbit_rs.Trace`, with the same attributes as read-only values."""

    is_complete: bool
    wall_s: float
    results: Sequence[Any]
    results_of_methods: Mapping[str, Any]
    events: Sequence[EventRecord] = ()

    def __post_init__(self) -> None:
        """Make the columns read-only."""
        for rows in self.arrays.values():
            rows.setflags(write=False)

    def __reduce__(self) -> tuple[Any, ...]:
        """Return the class and the field values, from which pickle rebuilds the trace."""
        return PickledTrace, tuple(getattr(self, part.name) for part in fields(self))

    def certificate(self) -> Any:
        """Return the certificate as computed by :meth:`onorbit_rs.Trace.certificate` before pickling."""
        return self.results_of_methods["certificate"]

    def joint_limits_exceeded(self) -> Any:
        """Return the names of the joints beyond their position limits, as computed before pickling."""
        return self.results_of_methods["joint_limits_exceeded"]

    def __len__(self) -> int:
        """Return the number of rows."""
        return len(self.arrays.get("time", ()))


def arrays_of(trace: Trace) -> dict[str, Any]:
    """Return the columns of a trace by path, without ``rereferenced``.

    They include the columns of every control, effect, contact and loop.
    """
    arrays = {name: np.asanyarray(getattr(trace, name)) for name in trace.columns()}
    contacts = {name: contact.values for name, contact in trace.contacts.items()}
    loops = {name: loop.values for name, loop in trace.loops.items()}
    for name, by_owner in (
        ("tracking", trace.tracking),
        ("wrenches", trace.wrenches),
        ("contacts", contacts),
        ("loops", loops),
    ):
        arrays |= {path_of(name, owner): np.asanyarray(rows) for owner, rows in by_owner.items()}
    return arrays


def reduced(trace: Trace) -> tuple[Any, ...]:
    """Return the class and arguments that rebuild a trace from a pickle."""
    results = {"certificate": trace.certificate(), "joint_limits_exceeded": trace.joint_limits_exceeded()}
    arrays = arrays_of(trace) | {"rereferenced": np.asarray(trace.rereferenced)}
    rest = (list(trace.results), results, trace.events)
    return PickledTrace, (arrays, trace.is_complete, trace.wall_s, *rest)
