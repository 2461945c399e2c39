"""``onorbit convert``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from onorbit_rs.cli.saying import complain, say
from onorbit_rs.cli.writing import claim
from onorbit_rs.files import replacing
from onorbit_rs.printable import printable, shell_word


def convert(
    files: Annotated[
        list[Path], typer.Argument(metavar="FILE...", help="YAML files of OnOrbitROS, and the robot's URDF.")
    ],
    out: Annotated[Path | None, typer.Option("--out", "-o", metavar="FILE", help="Write it here.")] = None,
    controller: Annotated[
        str | None, typer.Option(metavar="NAME", help="Which of several controllers.")
    ] = None,
    keep_going: Annotated[bool, typer.Option("--keep-going", help="Pass over unknown keys.")] = False,
    force: Annotated[bool, typer.Option("--force", help="Replace the file that is there.")] = False,
) -> None:
    """Make a scenario of OnOrbitROS' YAML files.

    Says on standard error what became of every line; without --out the scenario goes to standard output.
    """
    from onorbit_rs.interop.onorbitros import convert as convert_files
    from onorbit_rs.interop.write_scenario import scenario_text
    from onorbit_rs.scenario.load import check as check_scenario

    claim(out, force=force)
    done = convert_files(
        files, controller=controller, keep_going=keep_going, beside=out.parent if out else None
    )
    check_scenario(done.scenario, None, {})
    for note in done.notes:
        complain(printable(note))
    made_of = ", ".join(file.name for file in files)
    text = scenario_text(
        done.scenario, done.comments, f"Made by onorbit convert of {made_of}. SI and radians."
    )
    if out is None:
        typer.echo(text, nl=False)
        return
    with replacing(out) as file:
        file.write_text(text, encoding="utf-8")
    say(f"scenario: {out}")
    say(f"next: onorbit check {shell_word(out)}")
