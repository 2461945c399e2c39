"""Intervals in which contacts touch, from the touch-downs and lift-offs among the events of a run."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Protocol


class TimedEvent(Protocol):
    """Event with its name, its kind and its time, s."""

    @property
    def name(self) -> str:
        """Name of the event; for a touch-down or a lift-off, the name of the contact."""

    @property
    def kind(self) -> str:
        """Kind of the event, such as ``touch_down``."""

    @property
    def time(self) -> float:
        """Time of the event, s."""


Touch = tuple[float, float]
"""Times of the touch-down and the lift-off, s."""


def touches_of(events: Iterable[TimedEvent], end_s: float) -> dict[str, list[Touch]]:
    """Return start and end, s, of the touches of each contact; one without a lift-off ends at ``end_s``."""
    found: dict[str, list[Touch]] = {}
    for event in events:
        if event.kind == "touch_down":
            found.setdefault(event.name, []).append((event.time, end_s))
        elif event.kind == "lift_off":
            start, _ = found[event.name][-1]
            found[event.name][-1] = (start, event.time)
    return found
