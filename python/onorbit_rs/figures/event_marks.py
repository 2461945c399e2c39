"""Marks of events in figures over time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from matplotlib.axes import Axes

from onorbit_rs.common.event_kinds import OF_CONTACT
from onorbit_rs.figures.style import FAINT_INK, SMALL, legend_name

if TYPE_CHECKING:
    from onorbit_rs.figures.world_subject import EventMark

STYLES = {"capture": "-", "release": (0, (4, 2))}
_OTHER = (0, (1, 1.5))
_LEAST_APART = 0.12
"""Smallest time between the names of two events, as a fraction of the time of the last event."""


def mark_events(
    axes: Axes, events: Sequence[EventMark], time_scale: float, *, has_names: bool = False
) -> None:
    """Draw a vertical line for each event: solid for a capture, dashed for a release, dotted for others.

    Events of contacts are not drawn. ``time_scale`` is the number of seconds in the unit of the time axis.
    """
    jumps = [event for event in events if event.kind not in OF_CONTACT]
    for event in jumps:
        at, style = event.time / time_scale, STYLES.get(event.kind, _OTHER)
        axes.axvline(at, color=FAINT_INK, linewidth=0.8, linestyle=style, zorder=0.5)
    if has_names:
        for at, name in _joined(jumps):
            axes.annotate(
                legend_name(name), (at / time_scale, 1.0), xycoords=axes.get_xaxis_transform(),
                xytext=(0, 1.5), textcoords="offset points", ha="center", va="bottom", fontsize=SMALL,
                color=FAINT_INK,
            )  # fmt: skip


def _joined(events: Sequence[EventMark]) -> list[tuple[float, str]]:
    """Return the times, s, and names of the events; names that would overlap are joined at the first."""
    if not events:
        return []
    least = _LEAST_APART * max(event.time for event in events)
    found: list[tuple[float, list[str]]] = []
    for event in events:
        if found and event.time - found[-1][0] < least:
            found[-1][1].append(event.name)
        else:
            found.append((event.time, [event.name]))
    return [(at, ", ".join(names)) for at, names in found]


def of_systems(events: Sequence[EventMark], systems: Sequence[str]) -> list[EventMark]:
    """Return the events that involve only these systems, except touch-downs and lift-offs of contacts."""
    return [event for event in events
            if event.kind not in OF_CONTACT and set(event.systems) <= set(systems)]  # fmt: skip
