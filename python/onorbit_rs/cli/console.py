"""Prints tables, JSON and untrusted text on the terminal."""

from __future__ import annotations

import json
import sys
from typing import TYPE_CHECKING

from rich.console import Console
from rich.markup import escape
from rich.table import Column, Table

from onorbit_rs.cli.text_output import print_text
from onorbit_rs.common.printable import json_text, printable

if TYPE_CHECKING:
    from rich.console import JustifyMethod


def text(value: object) -> str:
    """Return untrusted text with rich markup and control characters escaped."""
    return escape(printable(value))


def print_json(data: object) -> None:
    """Print data as JSON on stdout; characters missing from its encoding are escaped."""
    output = json_text(data, indent=2)
    try:
        output.encode(getattr(sys.stdout, "encoding", None) or "utf-8")
    except UnicodeEncodeError:
        output = json.dumps(data, indent=2, allow_nan=False)
    print_text(output)


class _Console(Console):
    """Console that raises ``BrokenPipeError`` for a closed pipe, where rich would exit with code 1."""

    def on_broken_pipe(self) -> None:
        raise BrokenPipeError


def new_console(at_least: int = 0) -> Console:
    """Return a console on stdout without highlighting; lines are wrapped only if stdout is a terminal.

    The console is at least ``at_least`` columns wide; a narrower terminal wraps lines without cutting
    numbers.
    """
    console = _Console(highlight=False)
    console.width = max(console.width, at_least) if console.is_terminal else 10_000
    return console


def new_table(*header: str) -> Table:
    """Return a table without borders; only the first column may wrap.

    Columns are right-aligned, unless their header is empty or ``unit``.
    """
    table = Table(show_header=bool(header), box=None, padding=(0, 2, 0, 0), header_style="dim")
    for number, name in enumerate(header):
        justify: JustifyMethod = "left" if name in ("", "unit") else "right"
        table.add_column(name, justify=justify, no_wrap=number > 0)
    return table


def print_table(console: Console, table: Table) -> None:
    """Print a table without cutting numbers or names; a narrow terminal wraps the lines."""
    width = console.width
    console.width = max(width, sum(_min_width(console, column) + 2 for column in table.columns))
    console.print(table, crop=False)
    console.width = width


def _min_width(console: Console, column: Column) -> int:
    """Return the minimum width of a column; text wraps only between words, and not in ``no_wrap`` columns."""
    sizes = [console.measure(text) for text in (column.header, *column.cells)]
    return max(size.maximum if column.no_wrap else size.minimum for size in sizes)
