"""Implements ``onorbit compare``, which reports the differences between two runs."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from onorbit_rs.cli.completion import scenario_names
from onorbit_rs.cli.exit_codes import ignore_closed_pipe
from onorbit_rs.cli.figure_files import check_figure_file
from onorbit_rs.cli.options import JsonOption
from onorbit_rs.cli.text_output import print_line

if TYPE_CHECKING:
    from rich.console import Console

    from onorbit_rs.tools.comparison import Comparison, WorldComparison


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
            metavar="X",
            help="Tolerance relative to the largest value of a quantity or to 1, whichever is larger.",
        ),
    ] = 1e-6,
    as_json: JsonOption = False,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", metavar="FILE", help="Draw the differences to a PNG, PDF or SVG file."),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace an existing figure.")] = False,
) -> None:
    """Compare two runs and report whether and when they diverge.

    The exit code is 1 if the runs diverge, 2 for errors, and 130 after Ctrl-C.
    """
    from onorbit_rs.cli.console import print_json
    from onorbit_rs.tools.comparison import compare as compare_runs

    check_figure_file("--out", out, force=force)
    compared = compare_runs(a, b, tolerance=tolerance)
    figures = [] if out is None else _figures(compared, out, force=force)
    with ignore_closed_pipe():
        if as_json:
            print_json(compared.as_dict())
        else:
            print_comparison(compared)
    for file, one in figures:
        from onorbit_rs.figures import differences, save

        save(differences(one), file)
        if not as_json:
            with ignore_closed_pipe():
                print_line(f"figure: {file}")
    if not compared.agrees:
        raise typer.Exit(1)


def _figures(
    compared: Comparison | WorldComparison, out: Path, *, force: bool
) -> list[tuple[Path, Comparison]]:
    """Return the file and the comparison of each figure; a world has one per system, named after it."""
    from onorbit_rs.tools.comparison import Comparison

    if isinstance(compared, Comparison):
        return [(out, compared)]
    figures = [(out.with_stem(f"{out.stem}_{name}"), one) for name, one in compared.systems.items()]
    for file, _ in figures:
        check_figure_file("--out", file, force=force)
    return figures


def print_comparison(compared: Comparison | WorldComparison) -> None:
    """Print tables of the differences, and whether the runs agree or at what time they diverge."""
    from onorbit_rs.cli.console import new_console, text
    from onorbit_rs.tools.comparison import Comparison
    from onorbit_rs.tools.comparison.text import rows_of, rows_of_world

    console = new_console()
    console.print(f"[bold]{text(compared.b)}[/bold] against [bold]{text(compared.a)}[/bold]", soft_wrap=True)
    if isinstance(compared, Comparison):
        _print_quantities(console, compared)
        rows = rows_of(compared)
    else:
        for name, system in compared.systems.items():
            console.print(f"[bold]{text(name)}[/bold]:")
            _print_quantities(console, system)
            _print_notes(console, system)
        _print_events(console, compared)
        rows = text(rows_of_world(compared))
    _print_notes(console, compared)
    if compared.agrees:
        verdict = f"[green]the runs agree[/green] within {compared.tolerance:g} over {rows}"
    else:
        at, most = compared.parts_at, compared.tolerance
        verdict = f"[red]the runs diverge[/red] at t = {at:.6g} s by more than {most:g}; {rows}"
    console.print(verdict, soft_wrap=True)


def _print_quantities(console: Console, compared: Comparison) -> None:
    """Print the table of the quantities of a robot."""
    from onorbit_rs.cli.console import new_table, print_table, text
    from onorbit_rs.tools.comparison.text import HEAD

    table = new_table(*HEAD)
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


def _print_events(console: Console, compared: WorldComparison) -> None:
    """Print the table of the events; differences that are not allowed are red."""
    from onorbit_rs.cli.console import new_table, print_table, text
    from onorbit_rs.tools.comparison.text import EVENTS_HEAD, event_cells

    if not compared.events:
        return
    console.print("[bold]events[/bold]:")
    table = new_table(*EVENTS_HEAD)
    table.columns[1].justify = "left"
    for event in compared.events:
        *cells, difference, allowed, unit = map(text, event_cells(event))
        colour = "green" if event.agrees else "red"
        table.add_row(*cells, f"[{colour}]{difference}[/{colour}]", allowed, unit)
    print_table(console, table)


def _print_notes(console: Console, compared: Comparison | WorldComparison) -> None:
    from onorbit_rs.cli.console import text

    for note in compared.notes:
        console.print(f"[yellow]note[/yellow]: {text(note)}", soft_wrap=True)
