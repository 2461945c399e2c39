"""``onorbit validate``."""

from __future__ import annotations

import itertools
import time
from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated

import typer

from onorbit_rs.cli.failing import as_far_as_read
from onorbit_rs.cli.options import JsonOption

if TYPE_CHECKING:
    from onorbit_rs.validation import Case, Verdict

OnlyOption = Annotated[
    list[str] | None,
    typer.Option("--only", metavar="WORD", help="Cases whose family or name holds it; may be repeated."),
]
ListOption = Annotated[bool, typer.Option("--list", help="Cases with sources and gates, without running.")]
AllOption = Annotated[bool, typer.Option("--all", help="Every number, not each case's nearest to its gate.")]


def validate(
    only: OnlyOption = None,
    as_list: ListOption = False,
    in_full: AllOption = False,
    as_json: JsonOption = False,
) -> None:
    """Run the published cases and say how near we come.

    Exit code 1 if any case fails, 2 for errors, 130 after Ctrl-C.
    """
    from onorbit_rs.cli.printing import print_json
    from onorbit_rs.cli.verdicts import print_cases, print_count, print_verdicts
    from onorbit_rs.validation import select

    cases = select(only or ())
    started = time.perf_counter()
    verdicts = [case.not_run() for case in cases] if as_list else _run(cases)
    elapsed = time.perf_counter() - started
    with as_far_as_read():
        if as_json:
            print_json([verdict.as_dict() for verdict in verdicts])
        elif as_list:
            print_cases(cases)
        else:
            print_verdicts(verdicts, in_full=in_full)
            print_count(verdicts, elapsed)
    if any(verdict.passed is False for verdict in verdicts):
        raise typer.Exit(1)


def _run(cases: Sequence[Case]) -> list[Verdict]:
    """With a bar where there is a terminal."""
    from onorbit_rs.progress import parts_bar
    from onorbit_rs.validation import run

    done = itertools.count(1)
    with parts_bar("validate", quiet=False) as tell:
        return run(cases, each=lambda case: tell(case.name, next(done) / len(cases)))
