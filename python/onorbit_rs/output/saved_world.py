"""The trace of a run with several systems, read from a file or from a pickle."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs import _core
from onorbit_rs.common.counting import count
from onorbit_rs.exceptions import WorldError
from onorbit_rs.output.saved_trace import SavedTrace

if TYPE_CHECKING:
    from onorbit_rs._core import EventRecord, Trace, WorldTrace

WORLD_COLUMNS = ("time", "momentum", "kinetic_energy")
"""Names of the columns that describe all systems together."""
EVENTS = {
    "time": (), "impulse": (6,), "point": (3,), "energy_lost": (), "momentum_error": (2,), "peak_force": (),
}  # fmt: skip
"""Names of the columns of the events, with the shape of one row; NaN stands for None."""


def systems_in(arrays: Mapping[str, Any]) -> list[str]:
    """Return the names of the systems, given the columns of a world by path, such as ``chaser/q``."""
    split = (path.partition("/") for path in arrays)
    return [system for system, _, column in split if column == "q"]  # a contact may be named "a/x|b/q"


def system_in(arrays: Mapping[str, Any], name: str) -> SavedTrace:
    """Return the trace of a system, given the columns of a world by path, such as ``chaser/q``."""
    prefix = f"{name}/"
    own = {path.removeprefix(prefix): rows for path, rows in arrays.items() if path.startswith(prefix)}
    return SavedTrace(own)


@dataclass(frozen=True)
class SavedWorldTrace:
    """Trace of a world, read from a file or a pickle, with attributes of :class:`onorbit_rs.WorldTrace`."""

    systems: Mapping[str, Any]
    """Trace of each system."""
    events: Sequence[EventRecord]
    """Events that happened, in order of time."""
    time: Any
    """Times of the rows that all systems recorded, (T,), s."""
    momentum: Any
    """Total momentum of all systems, (T, 6), N s and N m s, as in :class:`onorbit_rs.WorldTrace`."""
    kinetic_energy: Any
    """Total kinetic energy of all systems, (T,), J."""

    @property
    def names(self) -> list[str]:
        """Names of the systems."""
        return list(self.systems)

    @property
    def contacts(self) -> dict[str, Any]:
        """Contacts by their names, as in :class:`onorbit_rs.WorldTrace`."""
        return {name: one for system in self.systems.values() for name, one in system.contacts.items()}

    def __getitem__(self, name: str) -> Any:
        """Return the trace of a system; raise WorldError for an unknown name."""
        if name not in self.systems:
            known = (
                f"the only system is {self.names[0]!r}"
                if len(self.names) == 1
                else f"the systems are: {', '.join(self.names)}"
            )
            raise WorldError(f"there is no system {name!r}; {known}", name=name)
        return self.systems[name]

    def __len__(self) -> int:
        """Return the number of rows that all systems recorded."""
        return len(self.time)


@dataclass(frozen=True)
class PickledWorldTrace(SavedWorldTrace):
    """Result of unpickling a :class:`onorbit_rs.WorldTrace`: the same attributes, read-only."""

    is_complete: bool
    wall_s: float
    checks: Sequence[Any]

    def __post_init__(self) -> None:
        """Make the columns read-only."""
        for column in (self.time, self.momentum, self.kinetic_energy):
            column.setflags(write=False)

    def __reduce__(self) -> tuple[Any, ...]:
        """Return the class and the field values, from which pickle rebuilds the trace."""
        return PickledWorldTrace, tuple(getattr(self, part.name) for part in fields(self))

    def certificate(self) -> Any:
        """Return the certificate as computed by :meth:`onorbit_rs.WorldTrace.certificate` before pickling."""
        return self.checks


def saved_world(arrays: Mapping[str, Any], audits: Sequence[Mapping[str, Any]]) -> SavedWorldTrace:
    """Return the trace of a world with these columns, such as ``chaser/q`` and ``events/time``.

    Parameters
    ----------
    arrays : mapping of array
        Columns by path.
    audits : sequence of mapping
        Entries of ``events`` in the summary, which contain the names of the events.

    Raises
    ------
    ValueError
        If the numbers of events in the columns and in the summary differ.
    """
    systems = {name: system_in(arrays, name) for name in systems_in(arrays)}
    if len(audits) != len(arrays["events/time"]):
        raise ValueError(
            f"it contains {count(len(arrays['events/time']), 'event', 'events')}, but summary.json contains "
            f"{len(audits)}"
        )
    events = [_event(arrays, row, audit) for row, audit in enumerate(audits)]
    columns = (arrays[name] for name in WORLD_COLUMNS)
    return SavedWorldTrace(systems, events, *columns)


def _event(arrays: Mapping[str, Any], row: int, audit: Mapping[str, Any]) -> EventRecord:
    def value(name: str) -> Any:
        return arrays[f"events/{name}"][row]

    by, of = audit["systems"]
    peak = value("peak_force") if "events/peak_force" in arrays else np.nan
    return _core.EventRecord(
        audit["name"], audit["kind"], value("time"), (by, of), impulse=value("impulse"), point=value("point"),
        energy_lost=value("energy_lost"), momentum_error=value("momentum_error"),
        peak_force=None if np.isnan(peak) else peak,
    )  # fmt: skip


def reduced_world(trace: WorldTrace) -> tuple[Any, ...]:
    """Return the class and arguments that rebuild the trace of a world from a pickle."""
    systems: dict[str, Trace] = {name: trace[name] for name in trace.names}
    columns = (np.asarray(column) for column in (trace.time, trace.momentum, trace.kinetic_energy))
    rest = (trace.is_complete, trace.wall_s, trace.certificate())
    return PickledWorldTrace, (systems, trace.events, *columns, *rest)
