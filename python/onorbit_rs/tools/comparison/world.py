"""Comparison of two runs of a world: each of its systems, and its events."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.common.event_kinds import OF_CONTACT
from onorbit_rs.common.printable import json_value
from onorbit_rs.exceptions import CompareError
from onorbit_rs.tools.comparison.robots import Comparison, compared_robots
from onorbit_rs.tools.comparison.text import as_world_text
from onorbit_rs.tools.comparison.verdict import Verdict, entry

if TYPE_CHECKING:
    from onorbit_rs._core import EventRecord
    from onorbit_rs.tools.comparison.recorded import RecordedWorld


@dataclass(frozen=True)
class EventDifference:
    """Difference between two runs in one quantity of an event."""

    event: str
    """Name of the event."""
    quantity: str
    unit: str
    a: float | None
    """Value (for vectors, the magnitude) in the first run; None if the event did not happen in that run."""
    b: float | None
    difference: float
    """Difference (for vectors, its magnitude); infinite if the event happened in only one run."""
    allowed: float
    """Allowed difference: the tolerance times the largest of both magnitudes and 1 in the unit."""
    time: float
    """Time of the event, s, in the run in which the event happened earlier."""

    @property
    def agrees(self) -> bool:
        """True if the difference does not exceed ``allowed``."""
        return self.difference <= self.allowed


@dataclass(frozen=True)
class WorldComparison(Verdict):
    """Differences between run ``b`` and run ``a`` of a world."""

    systems: Mapping[str, Comparison]
    """Comparison of each system, by name."""
    events: tuple[EventDifference, ...]
    """Differences of the events: five quantities of each event, six if it has a peak force in both runs, and
    only the time of an event that happened in one run only.
    """
    notes: tuple[str, ...]
    """Notes on differing settings and on events that were not compared."""

    @property
    def parts_at(self) -> float | None:
        """First time at which a quantity exceeds its tolerance, s; None if the runs agree."""
        systems = [one.parts_at for one in self.systems.values() if one.parts_at is not None]
        return min([*systems, *(event.time for event in self.events if not event.agrees)], default=None)

    def __getitem__(self, name: str) -> Comparison:
        """Return the comparison of a system; raise CompareError for an unknown name."""
        return entry(self.systems, name, "system of the runs")

    def __str__(self) -> str:
        """Return the text that ``onorbit compare`` prints."""
        return as_world_text(self)

    def as_dict(self) -> dict[str, Any]:
        """Return plain data without the rows, as printed by ``onorbit compare --json``."""
        names = ("event", "quantity", "unit", "a", "b", "difference", "allowed", "time", "agrees")
        return super().as_dict() | {
            "systems": {name: compared.as_dict() for name, compared in self.systems.items()},
            "events": [{name: json_value(getattr(event, name)) for name in names} for event in self.events],
            "notes": list(self.notes),
        }


def compared_worlds(
    a: RecordedWorld, b: RecordedWorld, tolerance: float, settings: Sequence[str]
) -> WorldComparison:
    """Compare two runs of a world; ``settings`` are notes about differing settings.

    Raises
    ------
    CompareError
        If the systems of the runs have different names, or as for :func:`compared_robots`.
    """
    if set(a.systems) != set(b.systems):
        names = [", ".join(world.systems) for world in (a, b)]
        raise CompareError(
            f"the names of the systems differ: {names[0]} in {a.name}, and {names[1]} in {b.name}; only runs "
            "with the same systems can be compared",
            name="systems", got=names[1], expected=names[0],
        )  # fmt: skip
    systems = {name: compared_robots(own, b.systems[name], tolerance) for name, own in a.systems.items()}
    end = min(float(compared.time[-1]) for compared in systems.values())
    events, notes = [], list(settings)
    compared, left_out = zip(*(_first_touches(world.events) for world in (a, b)), strict=True)
    if any(left_out):
        notes.append("of each contact, only the first touch is compared as an event")
    for name, pair in _pairs(*compared):
        if min(record.time for record in pair if record is not None) > end:
            notes.append(f"event {name!r} is not compared: it happened after the end of one of the runs")
        else:
            events += list(_differences(name, pair, tolerance))
            have_peaks = {record.peak_force is not None for record in pair if record is not None}
            if len(have_peaks) == 2:
                notes.append(f"the peak force of event {name!r} is not compared: only one of the runs has it")
    return WorldComparison(a.name, b.name, tolerance, systems, tuple(events), tuple(notes))


Named = tuple[str, "EventRecord"]


def _first_touches(records: Sequence[EventRecord]) -> tuple[list[Named], bool]:
    """Return the events with unique names; of each contact, only the events of its first touch are kept.

    Small differences grow with every touch. The second value is True if events were left out.
    """
    found: dict[str, EventRecord] = {}
    for record in records:
        is_of_contact = record.kind in OF_CONTACT
        name = f"{record.name} ({record.kind.replace('_', '-')})" if is_of_contact else record.name
        found.setdefault(name, record)
    return list(found.items()), len(found) < len(records)


Pair = tuple["EventRecord | None", "EventRecord | None"]


def _pairs(a: Sequence[Named], b: Sequence[Named]) -> Iterator[tuple[str, Pair]]:
    """Yield each event's name and its records in both runs (None without one), in the first run's order."""
    by_name = [dict(records) for records in (a, b)]
    for name in dict.fromkeys([*by_name[0], *by_name[1]]):
        yield name, (by_name[0].get(name), by_name[1].get(name))


def _differences(name: str, pair: Pair, tolerance: float) -> Iterator[EventDifference]:
    """Yield the differences of an event; only the time is compared if it happened in one run only."""
    first, second = pair
    if first is None or second is None:
        a, b = (None if record is None else record.time for record in pair)
        at = b if a is None else a
        assert at is not None  # it happened in one of the runs
        yield EventDifference(name, "time", "s", a, b, math.inf, tolerance * max(1.0, at), at)
        return
    at = min(first.time, second.time)
    others = {quantity: other for quantity, _, other in _quantities(second)}
    for quantity, unit, one in _quantities(first):
        if quantity not in others:
            continue
        other = others[quantity]
        value_a, value_b = (float(v[0] if len(v) == 1 else np.linalg.norm(v)) for v in (one, other))
        difference = float(np.linalg.norm(one - other))
        allowed = tolerance * max(1.0, abs(value_a), abs(value_b))
        yield EventDifference(name, quantity, unit, value_a, value_b, difference, allowed, at)


def _quantities(record: EventRecord) -> list[tuple[str, str, Any]]:
    """Return the name, unit and value of each compared quantity of an event; vectors are in axes of W."""
    impulse = np.asarray(record.impulse)
    peak = [] if record.peak_force is None else [("peak force", "N", np.array([record.peak_force]))]
    return [
        *peak,
        ("time", "s", np.array([record.time])),
        ("impulse", "N s", impulse[:3]),
        ("angular impulse", "N m s", impulse[3:]),
        ("point", "m", np.asarray(record.point)),
        ("energy lost", "J", np.array([record.energy_lost])),
    ]
