"""``onorbit compare``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from onorbit_rs.cli.completing import scenario_names
from onorbit_rs.cli.failing import as_far_as_read
from onorbit_rs.cli.options import JsonOption
from onorbit_rs.cli.pictures import claim_picture
from onorbit_rs.cli.saying import say
from onorbit_rs.counting import count

if TYPE_CHECKING:
    from rich.table import Table

    from onorbit_rs.comparison import Comparison


def compare(
    a: Annotated[
        str,
        typer.Argument(
            metavar="A", help="A folder of a run, or a scenario, run now.", autocompletion=scenario_names
        ),
    ],
    b: Annotated[
        str | None,
        typer.Argument(
            metavar="B",
            help="Another; left out: A's scenario on the other plant.",
            autocompletion=scenario_names,
        ),
    ] = None,
    tolerance: Annotated[
        float, typer.Option(metavar="X", help="Share of the largest value, or of 1 in a measure's unit.")
    ] = 1e-6,
    as_json: JsonOption = False,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", metavar="FILE", help="Draw the differences: PNG, PDF or SVG."),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace the figure that is there.")] = False,
) -> None:
    """Compare two runs and say where they part.

    Exit code 1 if they do, 2 for errors, 130 after Ctrl-C.
    """
    from onorbit_rs.cli.printing import print_json
    from onorbit_rs.comparison import compare as compare_runs

    claim_picture("--out", out, force=force)
    compared = compare_runs(a, b, tolerance=tolerance)
    with as_far_as_read():
        if as_json:
            print_json(compared.as_dict())
        else:
            print_comparison(compared)
    if out is not None:
        from onorbit_rs.figures import differences, save

        save(differences(compared), out)
    if out is not None and not as_json:
        with as_far_as_read():
            say(f"figure: {out}")
    if not compared.agrees:
        raise typer.Exit(1)


def print_comparison(compared: Comparison) -> None:
    """A table of the differences, and where the runs part."""
    from onorbit_rs.cli.printing import new_console, print_table, text

    console = new_console()
    console.print(f"[bold]{text(compared.b)}[/bold] against [bold]{text(compared.a)}[/bold]", soft_wrap=True)
    table = _table()
    for difference in compared.differences:
        parted = difference.parts_at
        table.add_row(
            text(difference.name),
            f"{difference.largest:.1e}",
            f"{difference.largest_at:.6g}",
            f"{difference.final:.1e}",
            f"{difference.allowed:.1e}",
            "[green]nowhere[/green]" if parted is None else f"[red]{parted:.6g}[/red]",
            difference.unit,
        )
    print_table(console, table)
    for note in compared.notes:
        console.print(f"[yellow]note[/yellow]: {text(note)}", soft_wrap=True)
    rows = f"{count(len(compared.time), 'row', 'rows')} from {compared.time[0]:g} to {compared.time[-1]:g} s"
    if compared.agrees:
        console.print(f"[green]they agree[/green] within {compared.tolerance:g} over {rows}", soft_wrap=True)
    else:
        verdict = f"[red]they part[/red] at t = {compared.parts_at:.6g} s by more than {compared.tolerance:g}"
        console.print(f"{verdict}; {rows}", soft_wrap=True)


def _table() -> Table:
    from onorbit_rs.cli.printing import new_table

    return new_table("", "largest", "at, s", "at the end", "allowed", "parts at, s", "unit")
