"""Text of a comparison."""

from __future__ import annotations

from typing import TYPE_CHECKING

from onorbit_rs.common.counting import count
from onorbit_rs.common.printable import printable

if TYPE_CHECKING:
    from onorbit_rs.tools.comparison import Comparison

_HEAD = ("", "largest", "at, s", "at the end", "allowed", "diverges at, s", "unit")


def as_text(compared: Comparison) -> str:
    """Return a line for each quantity, the notes and the verdict."""
    table = [_HEAD]
    for one in compared.differences:
        parts_at = "never" if one.parts_at is None else f"{one.parts_at:.6g}"
        numbers = f"{one.largest:.1e}", f"{one.largest_at:.6g}", f"{one.final:.1e}", f"{one.allowed:.1e}"
        table.append((one.name, *numbers, parts_at, one.unit))
    widths = [max(map(len, column)) for column in zip(*table, strict=True)]
    lines = [f"{compared.b} against {compared.a}"]
    for name, *cells, unit in table:
        middle = (f"{cell:>{width}}" for cell, width in zip(cells, widths[1:-1], strict=True))
        lines.append("  ".join((f"{name:<{widths[0]}}", *middle, unit)).rstrip())
    lines += [f"note: {note}" for note in compared.notes]
    span = f"{count(len(compared.time), 'row', 'rows')} from {compared.time[0]:g} to {compared.time[-1]:g} s"
    within = f"{compared.tolerance:g}"
    verdict = f"the runs agree within {within} over {span}"
    if not compared.agrees:
        verdict = f"the runs diverge at t = {compared.parts_at:.6g} s by more than {within}; {span}"
    return "\n".join(map(printable, (*lines, verdict)))
