"""Implements ``onorbit copy``, which copies a bundled scenario for editing."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from onorbit_rs.cli.completion import scenario_names
from onorbit_rs.cli.options import QuietOption
from onorbit_rs.cli.output_files import check_output_file
from onorbit_rs.cli.text_output import print_line
from onorbit_rs.common.printable import shell_word


def copy(
    name: Annotated[
        str, typer.Argument(metavar="NAME", help="A bundled name.", autocompletion=scenario_names)
    ],
    out: Annotated[
        Path | None, typer.Option("--out", "-o", metavar="FILE", help="The copy; default: NAME.yaml.")
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace existing files.")] = False,
    quiet: QuietOption = False,
) -> None:
    """Copy a bundled scenario to a file, for editing.

    A Python file that the scenario uses is copied beside it.
    """
    from onorbit_rs import scenarios
    from onorbit_rs.common.files import replacing

    source = scenarios.path(name)
    target = out or Path(f"{name}.yaml")
    copies = {target: source} | {target.parent / used.name: used for used in scenarios.files_of(name)}
    for file in copies:
        check_output_file(file, force=force)
    for file, original in copies.items():
        with replacing(file) as temporary:
            temporary.write_bytes(original.read_bytes())
    if not quiet:
        for file in copies:
            print_line(f"written: {file}")
        print_line(f"next: onorbit run {shell_word(target)} --out DIR")
