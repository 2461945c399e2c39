"""Text of a comparison of two runs, as printed by ``onorbit compare``."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from onorbit_rs.common.counting import count
from onorbit_rs.common.printable import printable

if TYPE_CHECKING:
    from onorbit_rs.tools.comparison.robots import Comparison
    from onorbit_rs.tools.comparison.world import EventDifference, WorldComparison

HEAD = ("", "largest", "at, s", "at the end", "allowed", "diverges at, s", "unit")
"""Header of the table of the quantities of a robot."""
EVENTS_HEAD = ("event", "quantity", "first run", "second run", "difference", "allowed", "unit")
"""Header of the table of the events."""


def as_text(compared: Comparison) -> str:
    """Return the text of a comparison: a line for each quantity, the notes and the verdict."""
    lines = [f"{compared.b} against {compared.a}", *_quantities(compared)]
    lines += [f"note: {note}" for note in compared.notes]
    return "\n".join(map(printable, (*lines, _verdict(compared, rows_of(compared)))))


def as_world_text(compared: WorldComparison) -> str:
    """Return the text of a comparison of worlds: systems, events, notes and verdict."""
    lines = [f"{compared.b} against {compared.a}"]
    for name, system in compared.systems.items():
        lines += [f"{name}:", *_quantities(system), *(f"note: {note}" for note in system.notes)]
    if compared.events:
        lines += ["events:", *_aligned([EVENTS_HEAD, *map(event_cells, compared.events)], left=2)]
    lines += [f"note: {note}" for note in compared.notes]
    return "\n".join(map(printable, (*lines, _verdict(compared, rows_of_world(compared)))))


def rows_of(compared: Comparison) -> str:
    """Return a description of the compared rows: their number and the first and last time."""
    rows = count(len(compared.time), "row", "rows")
    return f"{rows} from {compared.time[0]:g} to {compared.time[-1]:g} s"


def rows_of_world(compared: WorldComparison) -> str:
    """Return a description of the compared systems, rows and events of a world."""
    names = ", ".join(f"{name} ({rows_of(system)})" for name, system in compared.systems.items())
    events = len({event.event for event in compared.events})
    return f"{names}; {count(events, 'event', 'events')}"


def event_cells(event: EventDifference) -> tuple[str, ...]:
    """Return the cells of an event's row in the table of the events."""
    values = ("did not happen" if value is None else f"{value:.6g}" for value in (event.a, event.b))
    return (
        event.event, event.quantity, *values, f"{event.difference:.1e}", f"{event.allowed:.1e}", event.unit
    )  # fmt: skip


def _quantities(compared: Comparison) -> Iterator[str]:
    """Yield the lines of the table of the quantities of a robot."""
    table = [HEAD]
    for one in compared.differences:
        parts_at = "never" if one.parts_at is None else f"{one.parts_at:.6g}"
        numbers = f"{one.largest:.1e}", f"{one.largest_at:.6g}", f"{one.final:.1e}", f"{one.allowed:.1e}"
        table.append((one.name, *numbers, parts_at, one.unit))
    return _aligned(table, left=1)


def _aligned(table: Sequence[tuple[str, ...]], left: int) -> Iterator[str]:
    """Yield the lines of a table; the first ``left`` columns and the last column are left-aligned."""
    widths = [max(map(len, column)) for column in zip(*table, strict=True)]
    for row in table:
        padded = [
            f"{cell:<{width}}" if number < left or number == len(row) - 1 else f"{cell:>{width}}"
            for number, (cell, width) in enumerate(zip(row, widths, strict=True))
        ]
        yield "  ".join(padded).rstrip()


def _verdict(compared: Comparison | WorldComparison, rows: str) -> str:
    within = f"{compared.tolerance:g}"
    if compared.agrees:
        return f"the runs agree within {within} over {rows}"
    return f"the runs diverge at t = {compared.parts_at:.6g} s by more than {within}; {rows}"
