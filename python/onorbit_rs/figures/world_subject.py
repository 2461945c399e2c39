"""Data of a run with several systems that its figures need in addition to its trace."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from onorbit_rs._core import Model, WorldTrace
    from onorbit_rs.scenario.connections import Connection


class EventMark(NamedTuple):
    """Event to be marked in a figure; the attributes are those of :class:`onorbit_rs.EventRecord`."""

    name: str
    kind: str
    time: float
    systems: tuple[str, str]
    energy_lost: float


@dataclass(frozen=True)
class WorldSubject:
    """Run of several systems whose figures are drawn, with the data that the figures need.

    Attributes
    ----------
    trace : WorldTrace
        Trace of the run.
    models : dict of Model
        Robots by system, except those whose file cannot be read or has changed since the run.
    events : tuple of EventMark
        Events that happened; figures mark all but touch-downs and lift-offs, which they draw as touches.
    connections : tuple of Connection
        Pairs of frames that captures connect.
    touching : tuple of tuple of str
        Systems of each contact.
    """

    trace: WorldTrace
    models: Mapping[str, Model]
    events: tuple[EventMark, ...] = ()
    connections: tuple[Connection, ...] = ()
    touching: tuple[tuple[str, ...], ...] = ()


def marks_of(summary: dict[str, Any]) -> tuple[EventMark, ...]:
    """Return the events in the summary of a run, for marking them in figures."""
    return tuple(
        EventMark(row["name"], row["kind"], row["time_s"], tuple(row["systems"]), row["energy_lost_j"])
        for row in summary["events"]
    )
