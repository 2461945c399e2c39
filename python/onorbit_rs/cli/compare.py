"""``onorbit compare``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from onorbit_rs.cli.completion import scenario_names
from onorbit_rs.cli.exit_codes import ignore_closed_pipe
from onorbit_rs.cli.figure_files import check_figure_file
from onorbit_rs.cli.options import JsonOption
from onorbit_rs.cli.text_output import print_line
from onorbit_rs.common.counting import count

if TYPE_CHECKING:
    from rich.table import Table

    from onorbit_rs.tools.comparison import Comparison


def compare(
    a: Annotated[
        str,
        typer.Argument(
            metavar="A",
            help="Output folder of a run, or a scenario to simulate.",
            autocompletion=scenario_names,
        ),
    ],
    b: Annotated[
        str | None,
        typer.Argument(
            metavar="B",
            help="Second run; default: the scenario of A on the other engine.",
            autocompletion=scenario_names,
        ),
    ] = None,
    tolerance: Annotated[
        float,
        typer.Option(
            metavar="X", help="Tolerance relative to the largest value of a quantity, or to 1 in its unit."
        ),
    ] = 1e-6,
    as_json: JsonOption = False,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", metavar="FILE", help="Draw the differences: PNG, PDF or SVG."),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace an existing figure.")] = False,
) -> None:
    """Compare two runs and report whether and when they diverge.

    Exit code 1 if they do, 2 for errors, 130 after Ctrl-C.
    """
    from onorbit_rs.cli.console import print_json
    from onorbit_rs.tools.comparison import compare as compare_runs

    check_figure_file("--out", out, force=force)
    compared = compare_runs(a, b, tolerance=tolerance)
    with ignore_closed_pipe():
        if as_json:
            print_json(compared.as_dict())
        else:
            print_comparison(compared)
    if out is not None:
        from onorbit_rs.figures import differences, save

        save(differences(compared), out)
    if out is not None and not as_json:
        with ignore_closed_pipe():
            print_line(f"figure: {out}")
    if not compared.agrees:
        raise typer.Exit(1)


def print_comparison(compared: Comparison) -> None:
    """Print a table of the differences and the time at which the runs diverge."""
    from onorbit_rs.cli.console import new_console, print_table, text

    console = new_console()
    console.print(f"[bold]{text(compared.b)}[/bold] against [bold]{text(compared.a)}[/bold]", soft_wrap=True)
    table = _table()
    for difference in compared.differences:
        diverges_at = difference.parts_at
        table.add_row(
            text(difference.name),
            f"{difference.largest:.1e}",
            f"{difference.largest_at:.6g}",
            f"{difference.final:.1e}",
            f"{difference.allowed:.1e}",
            "[green]never[/green]" if diverges_at is None else f"[red]{diverges_at:.6g}[/red]",
            difference.unit,
        )
    print_table(console, table)
    for note in compared.notes:
        console.print(f"[yellow]note[/yellow]: {text(note)}", soft_wrap=True)
    rows = f"{count(len(compared.time), 'row', 'rows')} from {compared.time[0]:g} to {compared.time[-1]:g} s"
    if compared.agrees:
        console.print(
            f"[green]the runs agree[/green] within {compared.tolerance:g} over {rows}", soft_wrap=True
        )
    else:
        at, most = compared.parts_at, compared.tolerance
        verdict = f"[red]the runs diverge[/red] at t = {at:.6g} s by more than {most:g}"
        console.print(f"{verdict}; {rows}", soft_wrap=True)


def _table() -> Table:
    from onorbit_rs.cli.console import new_table

    return new_table("", "largest", "at, s", "at the end", "allowed", "diverges at, s", "unit")
