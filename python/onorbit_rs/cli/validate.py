"""Implements ``onorbit validate``, which runs the published validation cases."""

from __future__ import annotations

import itertools
import time
from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated

import typer

from onorbit_rs.cli.exit_codes import ignore_closed_pipe
from onorbit_rs.cli.options import JsonOption

if TYPE_CHECKING:
    from onorbit_rs.tools.validation import Case, Verdict

OnlyOption = Annotated[
    list[str] | None,
    typer.Option(
        "--only", metavar="WORD", help="Select cases whose family or name contains WORD; may be repeated."
    ),
]
ListOption = Annotated[
    bool, typer.Option("--list", help="List cases with sources and gates, without running them.")
]
AllOption = Annotated[
    bool,
    typer.Option(
        "--all", help="Print every check of a case, not only failed ones or the one nearest to its gate."
    ),
]


def validate(
    only: OnlyOption = None,
    as_list: ListOption = False,
    in_full: AllOption = False,
    as_json: JsonOption = False,
) -> None:
    """Run the published validation cases and print the deviations.

    The exit code is 1 if any case fails, 2 for errors, and 130 after Ctrl-C.
    """
    from onorbit_rs.cli.console import print_json
    from onorbit_rs.cli.validation_results import print_cases, print_count, print_verdicts
    from onorbit_rs.tools.validation import select

    cases = select(only or ())
    started = time.perf_counter()
    verdicts = [case.not_run() for case in cases] if as_list else _run(cases, quiet=as_json)
    elapsed = time.perf_counter() - started
    with ignore_closed_pipe():
        if as_json:
            print_json([verdict.as_dict() for verdict in verdicts])
        elif as_list:
            print_cases(cases)
        else:
            print_verdicts(verdicts, in_full=in_full)
            print_count(verdicts, elapsed)
    if any(verdict.passed is False for verdict in verdicts):
        raise typer.Exit(1)


def _run(cases: Sequence[Case], *, quiet: bool) -> list[Verdict]:
    """Run the cases; show progress unless ``quiet``."""
    from onorbit_rs.common.progress import parts_bar
    from onorbit_rs.tools.validation import run

    done = itertools.count(1)
    with parts_bar("validate", quiet=quiet) as tell:
        return run(cases, each=lambda case: tell(case.name, next(done) / len(cases)))
