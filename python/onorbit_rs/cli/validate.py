"""``onorbit validate``."""

from __future__ import annotations

import itertools
import json
import sys
import time
from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated, Any

import typer

from onorbit_rs.cli.printing import new_console, new_table, text

if TYPE_CHECKING:
    from onorbit_rs.validation import Case, Verdict

OnlyOption = Annotated[
    list[str] | None,
    typer.Option("--only", metavar="WORD", help="Cases whose family or name holds it; may be repeated."),
]
ListOption = Annotated[bool, typer.Option("--list", help="Cases with sources and gates, without running.")]
AllOption = Annotated[bool, typer.Option("--all", help="Every number, not each case's nearest to its gate.")]
_WIDE = 200
"""Columns where there is no terminal: nothing is broken."""
_GAPS = 2 + 6 * 2
"""Columns between columns, and the indent."""

JsonOption = Annotated[bool, typer.Option("--json", help="As a list, for programs; nothing else on stdout.")]


def validate(
    only: OnlyOption = None,
    as_list: ListOption = False,
    in_full: AllOption = False,
    as_json: JsonOption = False,
) -> None:
    """Run the published cases and compare: exit code 0 if none fails, else 1."""
    from onorbit_rs.validation import select

    cases = select(only or ())
    if as_list:
        _list(cases, as_json=as_json)
        return
    started = time.perf_counter()
    verdicts = _run(cases)
    if as_json:
        typer.echo(json.dumps([verdict.plain() for verdict in verdicts], indent=1))
    else:
        _print(verdicts, in_full=in_full)
        _print_count(verdicts, time.perf_counter() - started)
    if any(verdict.passed is False for verdict in verdicts):
        raise typer.Exit(1)


def _list(cases: Sequence[Case], *, as_json: bool) -> None:
    """What would run."""
    if as_json:
        verdicts = [case.not_run().plain() for case in cases]
        typer.echo(json.dumps(verdicts, indent=1))
        return
    console = new_console()
    for family, members in itertools.groupby(cases, lambda case: case.family):
        console.print(f"[bold]{text(family)}[/bold]")
        for source, some in itertools.groupby(members, lambda case: case.source):
            console.print(f"  [dim]{text(source)}[/dim]", soft_wrap=True)
            for case in some:
                gates = ", ".join(f"{gate.quantity} {gate}" for gate in case.gates)
                console.print(f"    {text(case.name)}: {text(gates)}", soft_wrap=True)


def _run(cases: Sequence[Case]) -> list[Verdict]:
    """With a bar where there is a terminal."""
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

    from onorbit_rs.validation import run

    columns = (BarColumn(), MofNCompleteColumn(), TextColumn("{task.description}", markup=False))
    console, is_quiet = Console(stderr=True), not sys.stderr.isatty()
    with Progress(*columns, console=console, transient=True, disable=is_quiet) as bar:
        task = bar.add_task("", total=len(cases))
        return run(cases, each=lambda case: bar.update(task, advance=1, description=case.name))


def _print(verdicts: Sequence[Verdict], *, in_full: bool) -> None:
    """A table by family and source: of each case the number nearest to its gate, and every one that fails."""
    from rich.console import Console

    is_terminal = sys.stdout.isatty()
    console = Console(highlight=False, width=None if is_terminal else _WIDE)
    rows = [(verdict, _rows(verdict, in_full=in_full)) for verdict in verdicts]
    widths = _widths([row for _, some in rows for row in some], console.width)
    for family, members in itertools.groupby(rows, lambda row: row[0].family):
        console.print(f"[bold]{text(family)}[/bold]")
        for source, group in itertools.groupby(members, lambda row: row[0].source):
            some = list(group)
            console.print(f"  [dim]{text(source)}[/dim]", soft_wrap=True)
            table = new_table()
            for width in (2, *widths):
                table.add_column(width=width)
            for _, lines in some:
                for *cells, outcome in lines:
                    table.add_row("", *map(text, cells), _WORDS[outcome])
            console.print(table)
            for note in dict.fromkeys(verdict.note for verdict, _ in some if verdict.note):
                console.print(f"    [yellow]{text(note)}[/yellow]", soft_wrap=True)


_WORDS = {True: "[green]pass[/green]", False: "[red]FAIL[/red]", None: "[yellow]skipped[/yellow]"}


def _rows(verdict: Verdict, *, in_full: bool) -> list[tuple[str, str, str, str, bool | None]]:
    """The case, what is measured, our error, the gate, and whether it passes."""
    from onorbit_rs.validation import Gate

    failed = [check for check in verdict.checks if check.passed is False and check.error is not None]
    shown = verdict.checks if in_full else failed or [verdict.nearest]
    rows: list[tuple[str, str, str, str, bool | None]] = []
    for check in shown:
        error = "" if check.error is None else f"{check.error:.1e} {check.unit}".rstrip()
        limit = str(Gate(check.quantity, check.gate, check.unit))
        rows.append(("" if rows else verdict.case, check.quantity, error, limit, check.passed))
    return rows


def _widths(rows: Sequence[tuple[Any, ...]], at_most: int) -> list[int]:
    """Of the columns; where the terminal is narrow, names are broken."""
    widths = [max(len(row[column]) for row in rows) for column in range(4)] + [len("skipped")]
    for column, least in ((0, 24), (1, 12)):
        too_wide = max(0, sum(widths) + _GAPS - at_most)
        widths[column] = max(min(widths[column], least), widths[column] - too_wide)
    return widths


def _print_count(verdicts: Sequence[Verdict], elapsed: float) -> None:
    """The last line."""
    passed, failed, skipped = (
        sum(verdict.passed is outcome for verdict in verdicts) for outcome in (True, False, None)
    )
    line = f"{passed} passed, {failed} failed, {skipped} skipped in {elapsed:.1f} s"
    new_console().print(f"[bold {'red' if failed else 'green'}]{line}[/]")
