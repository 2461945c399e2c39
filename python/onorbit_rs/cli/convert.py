"""Implements ``onorbit convert``, which converts OnOrbitROS files to a scenario."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from onorbit_rs.cli.output_files import check_output_file
from onorbit_rs.cli.text_output import print_error, print_line
from onorbit_rs.common.files import replacing
from onorbit_rs.common.printable import printable, shell_word


def convert(
    files: Annotated[
        list[Path],
        typer.Argument(metavar="FILE...", help="YAML files of OnOrbitROS, and the URDF of the robot."),
    ],
    out: Annotated[Path | None, typer.Option("--out", "-o", metavar="FILE", help="Output file.")] = None,
    controller: Annotated[
        str | None, typer.Option(metavar="NAME", help="Controller to convert, if there are several.")
    ] = None,
    external: Annotated[
        bool,
        typer.Option(
            "--external", help="Let joints with a PID follow commands instead of holding their positions."
        ),
    ] = False,
    keep_going: Annotated[bool, typer.Option("--keep-going", help="Ignore unknown keys.")] = False,
    force: Annotated[bool, typer.Option("--force", help="Replace an existing file.")] = False,
) -> None:
    """Convert YAML files of OnOrbitROS to a scenario.

    A note on standard error describes the conversion of each line. Without --out, the scenario is printed.
    """
    from onorbit_rs.robots.wording import COMMAND_LINE, worded
    from onorbit_rs.scenario.load import check as check_scenario
    from onorbit_rs.tools.interop.onorbitros import convert as convert_files
    from onorbit_rs.tools.interop.write_scenario import scenario_text

    check_output_file(out, force=force)
    beside = out.parent if out else None
    with worded(COMMAND_LINE):
        conversion = convert_files(
            files, controller=controller, external=external, keep_going=keep_going, beside=beside
        )
    check_scenario(conversion.scenario, None, {})
    for note in conversion.notes:
        print_error(printable(note))
    sources = ", ".join(file.name for file in files)
    text = scenario_text(
        conversion.scenario,
        conversion.comments,
        f"Converted from {sources} by onorbit convert. SI and radians.",
    )
    if out is None:
        typer.echo(text, nl=False)
        return
    with replacing(out) as file:
        file.write_text(text, encoding="utf-8")
    print_line(f"scenario: {out}")
    print_line(f"next: onorbit check {shell_word(out)}")
