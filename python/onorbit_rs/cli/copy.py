"""Implements ``onorbit copy``, which copies a bundled scenario or campaign for editing."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from onorbit_rs.cli.completion import bundled_names
from onorbit_rs.cli.options import QuietOption
from onorbit_rs.cli.output_files import check_output_file
from onorbit_rs.cli.text_output import print_line
from onorbit_rs.common.printable import shell_word


def copy(
    name: Annotated[
        str,
        typer.Argument(metavar="NAME", help="A bundled scenario or campaign.", autocompletion=bundled_names),
    ],
    out: Annotated[
        Path | None, typer.Option("--out", "-o", metavar="FILE", help="File of the copy; default: NAME.yaml.")
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace existing files.")] = False,
    quiet: QuietOption = False,
) -> None:
    """Copy a bundled scenario or campaign to a file, for editing.

    A Python file that the scenario uses is copied beside it. The copy of a campaign refers to its scenario by
    name; to edit both, copy the scenario as well, and refer to its file.
    """
    from onorbit_rs.common.files import replacing

    command, source, used = _files_of(name)
    target = out or Path(f"{name}.yaml")
    copies = {target: source} | {target.parent / file.name: file for file in used}
    for file in copies:
        check_output_file(file, force=force)
    for file, original in copies.items():
        with replacing(file) as temporary:
            temporary.write_bytes(original.read_bytes())
    if not quiet:
        for file in copies:
            print_line(f"written: {file}")
        print_line(f"next: onorbit {command} {shell_word(target)} --out DIR")


def _files_of(name: str) -> tuple[str, Path, list[Path]]:
    """Return the command that runs a bundled scenario or campaign, its YAML file, and the files that it uses.

    Raises
    ------
    NotFoundError
        If neither a scenario nor a campaign has this name; the message suggests a similar name, if there is
        one.
    """
    from onorbit_rs import scenarios
    from onorbit_rs.campaigns.bundled import CAMPAIGNS
    from onorbit_rs.common.suggestions import did_you_mean, nearest
    from onorbit_rs.exceptions import NotFoundError

    if name in CAMPAIGNS.names():
        return "campaign", CAMPAIGNS.path(name), []
    known = [*scenarios.names(), *CAMPAIGNS.names()]
    if name not in known:
        hint = did_you_mean(name, known) or "; onorbit list prints the names"
        message = f"no bundled scenario or campaign is named {name!r}{hint}"
        raise NotFoundError(message, path=name, kind="scenario", suggestion=nearest(name, known))
    return "run", scenarios.path(name), scenarios.files_of(name)
