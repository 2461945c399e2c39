"""``onorbit new``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from onorbit_rs.cli.options import (
    ArgumentsOption,
    PackagesOption,
    PictureOption,
    QuietOption,
    RobotArgument,
    XacroOption,
    in_words,
    of_file,
)
from onorbit_rs.cli.pictures import claim_picture, save_portrait
from onorbit_rs.cli.saying import say
from onorbit_rs.cli.writing import claim
from onorbit_rs.counting import count
from onorbit_rs.exceptions import InputError
from onorbit_rs.files import replacing
from onorbit_rs.printable import shell_word

if TYPE_CHECKING:
    from onorbit_rs.drafting import Draft


def new(
    robot: RobotArgument,
    out: Annotated[Path | None, typer.Option("--out", "-o", metavar="FILE", help="Write it here.")] = None,
    tool: Annotated[
        str | None, typer.Option(metavar="FRAME", help="The frame to move; else what looks most like a tool.")
    ] = None,
    bus: Annotated[
        str | None,
        typer.Option(
            metavar="ROBOT", help="The robot that carries it: a bundled name, a URDF or a xacro file."
        ),
    ] = None,
    at: Annotated[str | None, typer.Option(metavar="FRAME", help="Frame of the bus to attach to.")] = None,
    prefix: Annotated[
        str, typer.Option(metavar="TEXT", help="Prefix for the names of its links and joints, with --bus.")
    ] = "",
    packages: PackagesOption = None,
    arguments: ArgumentsOption = None,
    xacro: XacroOption = False,
    picture: PictureOption = None,
    force: Annotated[bool, typer.Option("--force", help="Replace the files that are there.")] = False,
    quiet: QuietOption = False,
) -> None:
    """Write a commented scenario that moves a robot's arm.

    The scenario is simulated before it is written; without --out it goes to standard output. With --bus the
    robot is attached to a spacecraft from another file; --picture draws the result.
    """
    given = of_file(robot, packages, arguments, xacro, bus=bus)
    if out is not None and picture is not None and out.absolute() == picture.absolute():
        raise InputError(f"--out and --picture are both {out}: name two files", name="picture", got=str(out))
    if bus is None and (at is not None or prefix):
        raise InputError(
            "--at and --prefix describe the mounting on a bus: add --bus ROBOT", name="bus", got=None
        )
    claim(out, force=force)
    claim_picture("--picture", picture, force=force)
    from onorbit_rs.drafting import Source, draft
    from onorbit_rs.progress import doing
    from onorbit_rs.robots.wording import COMMAND_LINE, worded

    options = {"--tool": tool, "--bus": bus, "--at": at, "--prefix": prefix}
    named = "".join(f" {option} {shell_word(value)}" for option, value in options.items() if value)
    written_by = f"onorbit new {in_words(robot, packages, arguments, xacro)}{named}"
    beside = out.absolute().parent if out else None
    with doing("trying motions", quiet=quiet), worded(COMMAND_LINE):
        source = Source(robot, **given, bus=bus, at=at, prefix=prefix)
        made = draft(source, tool=tool, beside=beside, command=written_by)
    save_portrait(picture, made.model, made.q, [frame for frame in (at, made.tool) if frame is not None])
    if out is None:
        typer.echo(made.text, nl=False)
        return
    with replacing(out) as file:
        file.write_text(made.text, encoding="utf-8")
    if not quiet:
        say(f"scenario: {out} ({_motion(made)})")
        if picture is not None:
            say(f"picture: {picture}")
        say(f"next: onorbit check {shell_word(out)}")


def _motion(made: Draft) -> str:
    """Describe what moves in a draft."""
    if made.joints:
        return f"{made.tool}, moved by {count(len(made.joints), 'joint', 'joints')}"
    return "a body without joints" if made.tool is None else "all joints hold: no motion of the arm passed"
