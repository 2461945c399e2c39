"""``onorbit new``."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import Annotated

import typer

from onorbit_rs.cli.options import (
    ArgumentsOption,
    PackagesOption,
    QuietOption,
    RobotArgument,
    as_mapping,
)
from onorbit_rs.cli.writing import claim, writing


def new(
    robot: RobotArgument,
    out: Annotated[Path | None, typer.Option("--out", "-o", metavar="FILE", help="Write it here.")] = None,
    tool: Annotated[
        str | None, typer.Option(metavar="FRAME", help="The frame to move; else what looks most like a tool.")
    ] = None,
    packages: PackagesOption = None,
    arguments: ArgumentsOption = None,
    force: Annotated[bool, typer.Option("--force", help="Replace the file that is there.")] = False,
    quiet: QuietOption = False,
) -> None:
    """Write a commented scenario in which a robot's arm moves in orbit, tried before it is written."""
    claim(out, force=force)
    from onorbit_rs.drafting import draft
    from onorbit_rs.progress import doing

    written_by = " ".join(
        ["onorbit new", shlex.quote(robot), *(["--tool", shlex.quote(tool)] if tool else [])]
    )
    with doing("trying motions", quiet=quiet):
        made = draft(
            robot, tool=tool, beside=out.absolute().parent if out else None, package_paths=packages,
            xacro_arguments=as_mapping(arguments), command=written_by,
        )  # fmt: skip
    if out is None:
        typer.echo(made.text, nl=False)
        return
    with writing(out):
        out.write_text(made.text, encoding="utf-8")
    if not quiet:
        moved = f"{made.tool}, moved by {len(made.joints)} joints" if made.tool else "a body without joints"
        typer.echo(f"scenario: {out} ({moved})\nnext: onorbit check {shlex.quote(str(out))}")
