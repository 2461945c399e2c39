"""Implements ``onorbit new``, which writes a scenario for a robot."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from onorbit_rs.cli.completion import robot_names
from onorbit_rs.cli.figure_files import check_figure_file, save_portrait
from onorbit_rs.cli.options import (
    ArgumentsOption,
    PackagesOption,
    PictureOption,
    QuietOption,
    RobotArgument,
    XacroOption,
    as_arguments,
    reading_options,
)
from onorbit_rs.cli.output_files import check_output_file
from onorbit_rs.cli.text_output import print_line
from onorbit_rs.common.counting import count
from onorbit_rs.common.files import replacing
from onorbit_rs.common.printable import shell_word
from onorbit_rs.exceptions import InputError

if TYPE_CHECKING:
    from onorbit_rs.tools.new_scenario import CaptureDraft, Draft


def new(
    robot: RobotArgument,
    target: Annotated[
        str | None,
        typer.Argument(
            metavar="[TARGET]",
            help="Spacecraft that the robot captures: a bundled name, a URDF or a xacro file.",
            autocompletion=robot_names,
            show_default=False,
        ),
    ] = None,
    out: Annotated[Path | None, typer.Option("--out", "-o", metavar="FILE", help="Output file.")] = None,
    tool: Annotated[
        str | None,
        typer.Option(
            metavar="FRAME", help="Frame that is moved or captures TARGET; default: the most likely tool."
        ),
    ] = None,
    target_frame: Annotated[
        str | None,
        typer.Option(
            metavar="FRAME",
            help="Frame of TARGET to capture; default: a frame named grapple, handle, grasp, dock or berth, "
            "otherwise the base link.",
        ),
    ] = None,
    bus: Annotated[
        str | None,
        typer.Option(
            metavar="ROBOT", help="Spacecraft to attach the robot to: a bundled name, a URDF or a xacro file."
        ),
    ] = None,
    at: Annotated[
        str | None,
        typer.Option(
            metavar="FRAME",
            help="Frame of the bus to attach the robot to; only with --bus; required if the bus has several "
            "frames.",
        ),
    ] = None,
    prefix: Annotated[
        str,
        typer.Option(metavar="TEXT", help="Prefix for the robot's link and joint names; only with --bus."),
    ] = "",
    packages: PackagesOption = None,
    arguments: ArgumentsOption = None,
    xacro: XacroOption = False,
    picture: PictureOption = None,
    force: Annotated[bool, typer.Option("--force", help="Replace existing files.")] = False,
    quiet: QuietOption = False,
) -> None:
    """Write a commented scenario that moves an arm or captures TARGET.

    The scenario is simulated before it is written; without --out, it is printed. With --bus, the robot is
    attached to a spacecraft from another file; --picture draws the result. With TARGET, the target
    approaches the tool slowly, a latch captures it, and a spring separates both craft again.
    """
    given = reading_options(robot, packages, arguments, xacro, bus=bus)
    _check_options(out, picture, bus, at, prefix)
    _check_target(target, target_frame)
    check_output_file(out, force=force)
    check_figure_file("--picture", picture, force=force)
    from onorbit_rs.common.progress import doing
    from onorbit_rs.robots import is_file
    from onorbit_rs.robots.wording import COMMAND_LINE, worded
    from onorbit_rs.tools.new_scenario import Source, draft, draft_capture

    options = {
        "--tool": tool, "--target-frame": target_frame, "--bus": bus, "--at": at, "--prefix": prefix,
    }  # fmt: skip
    mounting = "".join(f" {option} {shell_word(value)}" for option, value in options.items() if value)
    craft = as_arguments(robot, packages, arguments, xacro) + (f" {shell_word(target)}" if target else "")
    command = f"onorbit new {craft}{mounting}"
    folder = out.absolute().parent if out else None
    with doing("trying motions", quiet=quiet), worded(COMMAND_LINE):
        source = Source(robot, **given, bus=bus, at=at, prefix=prefix)
        result: Draft | CaptureDraft
        if target is None:
            result = draft(source, tool=tool, beside=folder, command=command)
        else:
            captured = Source(target, package_paths=packages if is_file(target) else None)
            result = draft_capture(
                source, captured, tool=tool, handle=target_frame, beside=folder, command=command
            )
    save_portrait(
        picture, result.model, result.q, [frame for frame in (at, result.tool) if frame is not None]
    )
    if out is None:
        typer.echo(result.text, nl=False)
        return
    with replacing(out) as file:
        file.write_text(result.text, encoding="utf-8")
    if not quiet:
        print_line(f"scenario: {out} ({_motion(result)})")
        if picture is not None:
            print_line(f"picture: {picture}")
        print_line(f"next: onorbit check {shell_word(out)}")


def _check_options(
    out: Path | None, picture: Path | None, bus: str | None, at: str | None, prefix: str
) -> None:
    """Raise InputError if options contradict each other."""
    if out is not None and picture is not None and out.absolute() == picture.absolute():
        raise InputError(
            f"--out and --picture are both {out}; give two different files", name="picture", got=str(out)
        )
    if bus is None and (at is not None or prefix):
        raise InputError(
            "--at and --prefix apply only with a bus; add --bus ROBOT, or omit them", name="bus", got=None
        )


def _check_target(target: str | None, frame: str | None) -> None:
    """Raise InputError if the frame of the target is given without a target."""
    if target is None and frame is not None:
        raise InputError(
            f"--target-frame {frame} applies only with a target; write onorbit new ROBOT TARGET, or omit "
            "--target-frame",
            name="target_frame", got=frame,
        )  # fmt: skip


def _motion(result: Draft | CaptureDraft) -> str:
    """Return a description of the motion in a draft scenario."""
    from onorbit_rs.tools.new_scenario import CaptureDraft

    if isinstance(result, CaptureDraft):
        return f"chaser/{result.tool} captures target/{result.handle}"
    if result.joints:
        return f"{result.tool}, moved by {count(len(result.joints), 'joint', 'joints')}"
    return (
        "a body without joints"
        if result.tool is None
        else "all joints are held, because every tried motion of the arm failed"
    )
