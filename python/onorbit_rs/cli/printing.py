"""What several commands print with: text of others' made harmless, JSON, tables."""

from __future__ import annotations

import json
import sys

import typer
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from onorbit_rs.printable import printable


def text(value: object) -> str:
    """Text of the user's, in which rich must see no markup and the terminal nothing but letters."""
    return escape(printable(value))


def print_json(data: object) -> None:
    """Data, and nothing else, on stdout; what is no letter, or what its encoding lacks, is escaped as in JSON."""
    said = json.dumps(data, indent=2, ensure_ascii=False, allow_nan=False)
    try:
        said.encode(sys.stdout.encoding or "utf-8")
    except UnicodeEncodeError:
        said = json.dumps(data, indent=2, allow_nan=False)
    typer.echo("".join(char if char.isprintable() or char == "\n" else _escaped(char) for char in said))


def _escaped(char: str) -> str:
    """Stands in a string of the JSON: control characters of ASCII are escaped already."""
    return json.dumps(char)[1:-1]


def new_console() -> Console:
    """Stdout, with no colours but ours; lines are as long as they are where nobody looks."""
    console = Console(highlight=False)
    if not console.is_terminal:
        console.width = 10_000
    return console


def new_table(*header: str) -> Table:
    """Columns side by side, no lines; numbers below a header stand to the right."""
    table = Table(show_header=bool(header), box=None, padding=(0, 2, 0, 0), header_style="dim")
    for name in header:
        table.add_column(name, justify="right" if name in ("value", "gate") else "left")
    return table
