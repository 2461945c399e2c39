"""A comparison as text, for ``print``."""

from __future__ import annotations

from typing import TYPE_CHECKING

from onorbit_rs.counting import count
from onorbit_rs.printable import printable

if TYPE_CHECKING:
    from onorbit_rs.comparison import Comparison

_HEAD = ("", "largest", "at, s", "at the end", "allowed", "parts at, s", "unit")


def as_text(compared: Comparison) -> str:
    """A line for each measure, the notes, and the verdict."""
    table = [_HEAD]
    for one in compared.differences:
        parts = "nowhere" if one.parts_at is None else f"{one.parts_at:.6g}"
        said = f"{one.largest:.1e}", f"{one.largest_at:.6g}", f"{one.final:.1e}", f"{one.allowed:.1e}"
        table.append((one.name, *said, parts, one.unit))
    widths = [max(map(len, column)) for column in zip(*table, strict=True)]
    lines = [f"{compared.b} against {compared.a}"]
    for name, *numbers, unit in table:
        middle = (f"{number:>{width}}" for number, width in zip(numbers, widths[1:-1], strict=True))
        lines.append("  ".join((f"{name:<{widths[0]}}", *middle, unit)).rstrip())
    lines += [f"note: {note}" for note in compared.notes]
    span = f"{count(len(compared.time), 'row', 'rows')} from {compared.time[0]:g} to {compared.time[-1]:g} s"
    within = f"{compared.tolerance:g}"
    verdict = f"they agree within {within} over {span}"
    if not compared.agrees:
        verdict = f"they part at t = {compared.parts_at:.6g} s by more than {within}; {span}"
    return "\n".join(map(printable, (*lines, verdict)))
