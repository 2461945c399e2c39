"""``onorbit info``."""

from __future__ import annotations

import warnings
from typing import Annotated

import typer

from onorbit_rs.cli.figure_files import check_figure_file, save_portrait
from onorbit_rs.cli.options import (
    ArgumentsOption,
    JsonOption,
    PackagesOption,
    PictureOption,
    RobotArgument,
    XacroOption,
    as_arguments,
    reading_options,
)
from onorbit_rs.cli.text_output import print_line


def info(
    robot: RobotArgument,
    packages: PackagesOption = None,
    arguments: ArgumentsOption = None,
    xacro: XacroOption = False,
    picture: PictureOption = None,
    force: Annotated[bool, typer.Option("--force", help="Replace an existing picture.")] = False,
    as_json: JsonOption = False,
) -> None:
    """Print a robot's tree, masses, joints, frames, warnings."""
    from onorbit_rs import robots
    from onorbit_rs.cli.console import new_console, print_json
    from onorbit_rs.cli.robot_info import print_info
    from onorbit_rs.robots.describe import describe
    from onorbit_rs.robots.wording import COMMAND_LINE, worded

    given = reading_options(robot, packages, arguments, xacro)
    check_figure_file("--picture", picture, force=force)
    with warnings.catch_warnings(), worded(COMMAND_LINE):
        warnings.simplefilter("ignore")  # print_info prints them
        model = robots.load(robot, **given)
    save_portrait(picture, model, model.neutral())
    if as_json:
        print_json(describe(model))
    else:
        print_info(model, new_console(at_least=72))
        if picture is not None:
            print_line(f"picture: {picture}")
        print_line(f"next: onorbit new {as_arguments(robot, packages, arguments, xacro)} --out FILE")
