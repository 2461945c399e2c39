"""Arguments and options that commands share."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from onorbit_rs.cli.completing import robot_names, scenario_names

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
CheckpointOption = Annotated[
    float, typer.Option(metavar="SECONDS", help="Wall-clock time between checkpoints in DIR.")
]

PackagesOption = Annotated[
    list[Path] | None,
    typer.Option("--package-path", metavar="DIR", help="Where ROS packages are; may be repeated."),
]
ArgumentsOption = Annotated[
    list[str] | None, typer.Option("--arg", metavar="NAME=VALUE", help="For a xacro; may be repeated.")
]


def as_mapping(arguments: list[str] | None) -> dict[str, str] | None:
    """``name=value`` or, as xacro writes it, ``name:=value``."""
    pairs = [argument.replace(":=", "=", 1).partition("=") for argument in arguments or []]
    for name, equals, _ in pairs:
        if not equals or not name:
            raise typer.BadParameter(f"write an argument of a xacro as name=value, not {name!r}")
    return {name: value for name, _, value in pairs} or None
