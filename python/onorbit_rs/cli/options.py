"""Arguments and options that several commands accept."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from onorbit_rs.cli.completion import robot_names, scenario_names
from onorbit_rs.common.printable import shell_word
from onorbit_rs.exceptions import InputError

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
FolderArgument = Annotated[Path, typer.Argument(metavar="DIR", help="Folder of a run.")]
OutOption = Annotated[Path | None, typer.Option("--out", "-o", metavar="DIR", help="Folder for results.")]
ForceOption = Annotated[bool, typer.Option("--force", help="Replace existing results in DIR.")]
JsonOption = Annotated[bool, typer.Option("--json", help="Print JSON only.")]
QuietOption = Annotated[bool, typer.Option("--quiet", "-q", help="Print no progress and no summary.")]
FiguresOption = Annotated[bool, typer.Option("--figures/--no-figures", help="Write figures to DIR.")]
RecordingOption = Annotated[
    bool, typer.Option("--recording/--no-recording", help="Write the recording for the viewer to DIR.")
]
CompressOption = Annotated[
    bool, typer.Option("--compress/--no-compress", help="Compress trace.npz to about 70 % of its size.")
]
SetOption = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="KEY=VALUE", help="Change an entry of the scenario; may be repeated."),
]
DurationOption = Annotated[
    str | None, typer.Option("--duration", metavar="TIME", help="Simulated time, such as '10 s' or '2 h'.")
]
ViewOption = Annotated[bool, typer.Option("--view", help="Show the run in the viewer while it is computed.")]
CommandsOption = Annotated[
    Path | None,
    typer.Option("--commands", metavar="FILE", help="File of timed commands, one JSON object per line."),
]
CheckpointOption = Annotated[
    float | None,
    typer.Option(metavar="SECONDS", help="Wall-clock time between checkpoints in DIR, s; default: 30."),
]

PackagesOption = Annotated[
    list[Path] | None,
    typer.Option("--package-path", metavar="DIR", help="Folder with ROS packages; may be repeated."),
]
ArgumentsOption = Annotated[
    list[str] | None,
    typer.Option("--arg", metavar="NAME=VALUE", help="Argument of a xacro file; may be repeated."),
]

PictureOption = Annotated[
    Path | None, typer.Option(metavar="FILE", help="Draw the robot to a PNG, PDF or SVG file.")
]
XacroOption = Annotated[
    bool, typer.Option("--xacro", help="Expand the file with xacro even if its name does not end in .xacro.")
]


def reading_options(
    robot: str,
    packages: list[Path] | None,
    arguments: list[str] | None,
    xacro: bool,
    *,
    bus: str | None = None,
) -> dict[str, Any]:
    """Return the keyword arguments of :func:`onorbit_rs.robots.load` for a robot's file.

    Raises
    ------
    InputError
        If an option does not apply to a bundled robot or to the type of the file, or a folder does not
        exist. With a ``bus``, the message explains where to put the arguments of its xacro file.
    typer.BadParameter
        If an argument is not written ``name=value`` or ``name:=value``.
    """
    from onorbit_rs import robots

    values = xacro_arguments(arguments)
    is_xacro = xacro or Path(robot).suffix.lower() == ".xacro"
    if arguments and bus is not None and not is_xacro:
        raise InputError(
            f"--arg sets an argument of the robot, but {robot} does not end in .xacro; add --xacro if it is "
            "a xacro file, or omit --arg, and write the arguments of the bus in the scenario, as "
            "robot.bus.xacro_arguments",
            name="arg", got=arguments,
        )  # fmt: skip
    if (packages or arguments or xacro) and not robots.is_file(robot):
        raise InputError(
            f"--package-path, --arg and --xacro apply only to robot files, but {robot!r} is not a path that "
            "contains a folder or ends in .urdf, .xml or .xacro; omit them or give such a path",
            name="robot", got=robot,
        )  # fmt: skip
    for folder in packages or ():
        if not folder.is_dir():
            raise InputError(
                f"--package-path {folder} is not an existing folder; give a folder with ROS packages",
                name="package_path", got=str(folder),
            )  # fmt: skip
    if arguments and not is_xacro:
        raise InputError(
            f"--arg applies only to xacro files, but {robot} does not end in .xacro; omit --arg or add "
            "--xacro",
            name="arg", got=arguments,
        )  # fmt: skip
    return {"package_paths": packages, "xacro_arguments": values, "xacro": xacro}


def as_arguments(robot: str, packages: list[Path] | None, arguments: list[str] | None, xacro: bool) -> str:
    """Return the robot and its options as command-line arguments."""
    words = [robot]
    for option, values in (("--package-path", packages), ("--arg", arguments)):
        words += [word for value in values or () for word in (option, str(value))]
    words += ["--xacro"] if xacro else []
    return " ".join(map(shell_word, words))


def scenario_changes(assignments: list[str] | None, duration: str | None = None) -> dict[str, Any]:
    """Return the changes of a scenario that ``--set`` and ``--duration`` describe.

    Raises
    ------
    InputError
        If an assignment is not of the form ``KEY=VALUE``, or its key or value cannot be read.
    """
    from onorbit_rs.scenario.changes import parsed_changes

    changes = parsed_changes(assignments)
    return changes if duration is None else changes | parsed_changes([f"simulation.duration={duration}"])


def check_is_scenario(name: str) -> None:
    """Raise InputError if a name is that of a bundled campaign, and of no file."""
    from onorbit_rs.campaigns.bundled import CAMPAIGNS

    if name in CAMPAIGNS.names() and not Path(name).exists():
        raise InputError(
            f"{name!r} is a campaign; run it with: onorbit campaign {name} --out DIR",
            name="scenario", got=name,
        )  # fmt: skip


def xacro_arguments(arguments: list[str] | None) -> dict[str, str] | None:
    """Return xacro arguments (``name=value`` or ``name:=value``) as a mapping, or None without arguments."""
    pairs = [argument.replace(":=", "=", 1).partition("=") for argument in arguments or []]
    for argument, (name, equals, _) in zip(arguments or [], pairs, strict=True):
        if not equals or not name:
            raise typer.BadParameter(f"--arg {argument!r} has no name or no '='; write NAME=VALUE")
    return {name: value for name, _, value in pairs} or None
