"""Prints the results of the validation cases on the terminal."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

from onorbit_rs.cli.console import new_console, new_table, text
from onorbit_rs.tools.validation import Case, Gate, Verdict

Row = tuple[str, str, str, str, bool | None]
"""Case, quantity, error, gate, and whether the error is within the gate."""

_WORDS = {True: "[green]pass[/green]", False: "[red]FAIL[/red]", None: "[yellow]skipped[/yellow]"}
_GAPS = 2 + 6 * 2
"""Total width of the gaps between columns and of the indent, characters."""


def print_cases(cases: Sequence[Case]) -> None:
    """Print the cases by family and source, with their gates."""
    console = new_console()
    for family, members in itertools.groupby(cases, lambda case: case.family):
        console.print(f"[bold]{text(family)}[/bold]")
        for source, some in itertools.groupby(members, lambda case: case.source):
            console.print(f"  [dim]{text(source)}[/dim]", soft_wrap=True)
            for case in some:
                gates = ", ".join(f"{gate.quantity} {gate}" for gate in case.gates)
                console.print(f"    {text(case.name)}: {text(gates)}", soft_wrap=True)


def print_verdicts(verdicts: Sequence[Verdict], *, in_full: bool) -> None:
    """Print the checks by family and source: all of them if ``in_full``.

    Otherwise, each case shows its failed checks or, if none failed, the check nearest to its gate.
    """
    console = new_console(at_least=72)
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


def _rows(verdict: Verdict, *, in_full: bool) -> list[Row]:
    """Return the table rows of a case's checks."""
    failed = [check for check in verdict.checks if check.passed is False and check.error is not None]
    shown = verdict.checks if in_full else failed or [verdict.nearest]
    rows: list[Row] = []
    for check in shown:
        error = "" if check.error is None else f"{check.error:.1e} {check.unit}".rstrip()
        limit = str(Gate(check.quantity, check.gate, check.unit))
        rows.append(("" if rows else verdict.case, check.quantity, error, limit, check.passed))
    return rows


def _widths(rows: Sequence[Row], at_most: int) -> list[int]:
    """Return the column widths; on a narrow terminal, the columns of names shrink and their texts wrap."""
    widths = [max(len(str(row[column])) for row in rows) for column in range(4)] + [len("skipped")]
    for column, least in ((0, 24), (1, 12)):
        too_wide = max(0, sum(widths) + _GAPS - at_most)
        widths[column] = max(min(widths[column], least), widths[column] - too_wide)
    return widths


def print_count(verdicts: Sequence[Verdict], elapsed: float) -> None:
    """Print the numbers of passed, failed and skipped cases, and the elapsed wall-clock time, s."""
    passed, failed, skipped = (
        sum(verdict.passed is outcome for verdict in verdicts) for outcome in (True, False, None)
    )
    line = f"{passed} passed, {failed} failed, {skipped} skipped in {elapsed:.1f} s"
    new_console().print(f"[bold {'red' if failed else 'green'}]{line}[/]")
