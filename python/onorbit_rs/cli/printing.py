"""What several commands print with: text of others' made harmless, JSON, tables."""

from __future__ import annotations

import json
import sys
from typing import TYPE_CHECKING

from rich.console import Console
from rich.markup import escape
from rich.table import Column, Table

from onorbit_rs.cli.saying import say_all
from onorbit_rs.printable import json_text, printable

if TYPE_CHECKING:
    from rich.console import JustifyMethod


def text(value: object) -> str:
    """Text of the user's, in which rich must see no markup and the terminal nothing but letters."""
    return escape(printable(value))


def print_json(data: object) -> None:
    """Data, and nothing else, on stdout; what its encoding lacks is escaped."""
    said = json_text(data, indent=2)
    try:
        said.encode(getattr(sys.stdout, "encoding", None) or "utf-8")
    except UnicodeEncodeError:
        said = json.dumps(data, indent=2, allow_nan=False)
    say_all(said)


class _Console(Console):
    """Leaves a closed pipe to the command, which may have more to do; rich would end with exit code 1."""

    def on_broken_pipe(self) -> None:
        raise BrokenPipeError


def new_console(at_least: int = 0) -> Console:
    """Stdout, with no colours but ours; lines are as long as they are where nobody looks.

    A terminal of fewer columns than ``at_least`` breaks the lines itself: no number is cut.
    """
    console = _Console(highlight=False)
    console.width = max(console.width, at_least) if console.is_terminal else 10_000
    return console


def new_table(*header: str) -> Table:
    """Columns side by side, no lines; numbers below a header stand to the right, the first may be broken."""
    table = Table(show_header=bool(header), box=None, padding=(0, 2, 0, 0), header_style="dim")
    for number, name in enumerate(header):
        justify: JustifyMethod = "left" if name in ("", "unit") else "right"
        table.add_column(name, justify=justify, no_wrap=number > 0)
    return table


def print_table(console: Console, table: Table) -> None:
    """Whole also on a narrow terminal, which then breaks the lines: no number and no name is cut."""
    width = console.width
    console.width = max(width, sum(_least(console, column) + 2 for column in table.columns))
    console.print(table, crop=False)
    console.width = width


def _least(console: Console, column: Column) -> int:
    """Words may be broken between, not within."""
    sizes = [console.measure(text) for text in (column.header, *column.cells)]
    return max(size.maximum if column.no_wrap else size.minimum for size in sizes)
