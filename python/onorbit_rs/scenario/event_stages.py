"""Trees of connected systems after each event of a scenario, computed before the run."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from onorbit_rs.scenario.events import Event, split_path
from onorbit_rs.scenario.world import WorldScenario


@dataclass(frozen=True)
class Stage:
    """Trees of connected systems between an event and the next event."""

    event: str | None
    """Name of the event; None at the start of the run."""
    time: float | None
    """Time, s; None if it is not known before the run."""
    trees: tuple[tuple[str, ...], ...]
    """Names of the systems in each tree; the first is the root."""
    remark: str = ""
    """Remark on the event, such as the reason why it has no effect on the trees; empty if there is none."""
    seating_joints: tuple[int, ...] = ()
    """Number of joints of each tree whose positions are prescribed by a seating in progress."""


@dataclass(frozen=True)
class _Weld:
    capture: str
    by: str
    of: str
    seat: float
    """Duration of the seating, s; zero without a seating."""


SEATING_JOINTS = 2
"""Number of joints of a seating: one prismatic and one revolute joint."""


def stages(scenario: WorldScenario) -> list[Stage]:
    """Return the stages at the start of the run and after its events, in the order of :func:`expected_order`.

    As in the engine, a tree keeps the root of the capturing system. The root of a released part is the system
    of the released frame, unless the part contains the former root.
    """
    names = list(scenario.systems)
    welds: list[_Weld] = []
    roots: list[str] = []
    found = [Stage(None, 0.0, _trees(names, welds, roots))]
    by_name = {event.name: event for event in scenario.events}
    for event, time in expected_order(scenario.events):
        if time is not None and time > scenario.simulation.duration:
            remark = "after the end of the run"
        elif event.do.capture is not None:
            remark = _capture(event, found[-1].trees, welds, roots)
        elif event.do.release is not None:
            remark = _release(event.do.release, names, welds, roots)
        else:
            remark = "no effect on the trees: the event sets a brake"
        trees = _trees(names, welds, roots)
        seated = [weld for weld in welds if _elapsed(event, weld.capture, by_name) < weld.seat]
        joints = tuple(SEATING_JOINTS * sum(weld.by in tree for weld in seated) for tree in trees)
        found.append(Stage(event.name, time, trees, remark, joints))
    return found


def _elapsed(event: Event, capture: str, by_name: dict[str, Event]) -> float:
    """Return the time from a capture to an event, s; infinity if it is not known before the run."""
    before, delay = event, 0.0
    while before.name != capture and before.when.after is not None:
        before, delay = by_name[before.when.after], delay + before.when.delay
    if before.name == capture:
        return delay
    start, end = _time(by_name[capture], by_name), _time(event, by_name)
    return math.inf if start is None or end is None else end - start


def expected_order(events: Sequence[Event]) -> list[tuple[Event, float | None]]:
    """Return the events with their times, in the order in which they are expected to happen.

    The time is None for events with a latch or on command, and for events that follow such an event. Events
    without a time are assumed to happen in the order of the scenario, after the event that they follow.
    """
    by_name = {event.name: event for event in events}
    times = {event.name: _time(event, by_name) for event in events}
    waiting = list(events)
    found: list[tuple[Event, float | None]] = []
    while waiting:
        known = [time for event in waiting if (time := times[event.name]) is not None]
        placed = {event.name for event, _ in found}
        ready = [event for event in waiting if event.when.after is None or event.when.after in placed]
        due = [event for event in ready if times[event.name] in (None, min(known, default=None))]
        waiting.remove(due[0])
        found.append((due[0], times[due[0].name]))
    return found


def _time(event: Event, by_name: dict[str, Event]) -> float | None:
    """Return the time of an event, s; None if it is not known before the run."""
    if event.when.after is None:
        return event.when.at
    before = _time(by_name[event.when.after], by_name)
    return None if before is None else before + event.when.delay


def _capture(event: Event, trees: Sequence[Sequence[str]], welds: list[_Weld], roots: list[str]) -> str:
    """Connect two systems; return a remark if they are already connected, otherwise an empty string."""
    by, of = (split_path(path)[0] for path in event.do.capture or ())
    first, second = (next(tree for tree in trees if name in tree) for name in (by, of))
    if first == second and event.do.seat:
        return f"stops the run: {by} and {of} are already connected, so the capture cannot seat its frames"
    welds.append(_Weld(event.name, by, of, event.do.seat or 0.0))
    if first == second:
        return f"closes a loop: {by} and {of} are already connected"
    roots[:] = [root for root in roots if root not in (first[0], second[0])] + [first[0]]
    return ""


def _release(capture: str, names: Sequence[str], welds: list[_Weld], roots: list[str]) -> str:
    """Separate two systems; return the reason if nothing changes, otherwise an empty string."""
    weld = next((weld for weld in welds if weld.capture == capture), None)
    if weld is None:
        return f"no effect: {capture} has not happened, or has already been released"
    welds.remove(weld)
    for name in (weld.by, weld.of):
        tree = next(tree for tree in _trees(names, welds, [*roots, name]) if name in tree)
        if not set(tree) & set(roots):
            roots.append(name)
    return ""


def _trees(names: Sequence[str], welds: Sequence[_Weld], roots: Sequence[str]) -> tuple[tuple[str, ...], ...]:
    """Return the trees in the order of the engine: first those with a given root, then the others."""
    placed: set[str] = set()
    found = []
    for root in (*roots, *names):
        if root in placed:
            continue
        tree = [root]
        for system in tree:  # the list grows during the iteration
            ends = ((weld.by, weld.of) if weld.by == system else (weld.of, weld.by) for weld in welds
                    if system in (weld.by, weld.of))  # fmt: skip
            tree += [far for far in dict.fromkeys(far for _, far in ends) if far not in tree]
        placed.update(tree)
        found.append(tuple(tree))
    return tuple(found)
