"""Arguments and options that commands share."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from onorbit_rs.cli.completing import robot_names, scenario_names
from onorbit_rs.exceptions import InputError
from onorbit_rs.printable import shell_word

ScenarioArgument = Annotated[
    str,
    typer.Argument(
        metavar="NAME_OR_FILE", help="A bundled name or a YAML file.", autocompletion=scenario_names
    ),
]
RobotArgument = Annotated[
    str,
    typer.Argument(
        metavar="ROBOT", help="A bundled name, a URDF or a xacro file.", autocompletion=robot_names
    ),
]
FolderArgument = Annotated[Path, typer.Argument(metavar="DIR", help="A folder that a run has written.")]
OutOption = Annotated[Path | None, typer.Option("--out", "-o", metavar="DIR", help="Write results here.")]
ForceOption = Annotated[bool, typer.Option("--force", help="Replace the run that is in DIR.")]
JsonOption = Annotated[bool, typer.Option("--json", help="As data on stdout and nothing else.")]
QuietOption = Annotated[bool, typer.Option("--quiet", "-q", help="No progress bar, no summary.")]
ViewOption = Annotated[bool, typer.Option("--view", help="Watch it in the viewer while it runs.")]
CheckpointOption = Annotated[
    float | None,
    typer.Option(metavar="SECONDS", help="Wall-clock time between checkpoints in DIR; 30 unless told."),
]

PackagesOption = Annotated[
    list[Path] | None,
    typer.Option("--package-path", metavar="DIR", help="Where ROS packages are; may be repeated."),
]
ArgumentsOption = Annotated[
    list[str] | None, typer.Option("--arg", metavar="NAME=VALUE", help="For a xacro; may be repeated.")
]

PictureOption = Annotated[Path | None, typer.Option(metavar="FILE", help="Draw the robot: PNG, PDF or SVG.")]
XacroOption = Annotated[bool, typer.Option("--xacro", help="Expand a file that is not named .xacro as one.")]


def of_file(
    robot: str,
    packages: list[Path] | None,
    arguments: list[str] | None,
    xacro: bool,
    *,
    bus: str | None = None,
) -> dict[str, Any]:
    """Return the keyword arguments with which :func:`onorbit_rs.robots.load` reads a robot's file.

    Raises
    ------
    InputError
        If an option could have no effect: for a bundled robot, a missing folder, a file that is no xacro.
        If there is a ``bus``, the message says where the arguments of its xacro go.
    """
    from onorbit_rs import robots

    values = as_mapping(arguments)
    is_xacro = xacro or Path(robot).suffix.lower() == ".xacro"
    if arguments and bus is not None and not is_xacro:
        raise InputError(
            "--arg is for the robot's own xacro file; write the arguments of a xacro bus into the scenario: "
            "robot.bus.xacro_arguments",
            name="arg", got=arguments,
        )  # fmt: skip
    if (packages or arguments or xacro) and not robots.is_file(robot):
        raise InputError(
            f"--package-path, --arg and --xacro are for a robot's file, and {robot!r} is a name, not a path "
            "of one",
            name="robot", got=robot,
        )  # fmt: skip
    for folder in packages or ():
        if not folder.is_dir():
            raise InputError(
                f"--package-path {folder}: there is no such folder", name="package_path", got=str(folder)
            )
    if arguments and not is_xacro:
        raise InputError(
            f"--arg is for a xacro, and {robot} is not named so: leave it out, or add --xacro",
            name="arg", got=arguments,
        )  # fmt: skip
    return {"package_paths": packages, "xacro_arguments": values, "xacro": xacro}


def in_words(robot: str, packages: list[Path] | None, arguments: list[str] | None, xacro: bool) -> str:
    """The robot and how it is read, as the next command takes them."""
    words = [robot]
    for option, values in (("--package-path", packages), ("--arg", arguments)):
        words += [word for value in values or () for word in (option, str(value))]
    words += ["--xacro"] if xacro else []
    return " ".join(map(shell_word, words))


def as_mapping(arguments: list[str] | None) -> dict[str, str] | None:
    """``name=value`` or, as xacro writes it, ``name:=value``."""
    pairs = [argument.replace(":=", "=", 1).partition("=") for argument in arguments or []]
    for name, equals, _ in pairs:
        if not equals or not name:
            raise typer.BadParameter(f"write an argument of a xacro as name=value, not {name!r}")
    return {name: value for name, _, value in pairs} or None
