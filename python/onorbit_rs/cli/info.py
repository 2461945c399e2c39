"""``onorbit info``."""

from __future__ import annotations

import warnings
from typing import Annotated

import typer

from onorbit_rs.cli.options import (
    ArgumentsOption,
    JsonOption,
    PackagesOption,
    PictureOption,
    RobotArgument,
    XacroOption,
    in_words,
    of_file,
)
from onorbit_rs.cli.pictures import claim_picture, save_portrait
from onorbit_rs.cli.saying import say


def info(
    robot: RobotArgument,
    packages: PackagesOption = None,
    arguments: ArgumentsOption = None,
    xacro: XacroOption = False,
    picture: PictureOption = None,
    force: Annotated[bool, typer.Option("--force", help="Replace the picture that is there.")] = False,
    as_json: JsonOption = False,
) -> None:
    """Print a robot's tree, masses, joints, frames, oddities."""
    from onorbit_rs import robots
    from onorbit_rs.cli.printing import new_console, print_json
    from onorbit_rs.cli.robot import print_info
    from onorbit_rs.robots.describe import describe
    from onorbit_rs.robots.wording import COMMAND_LINE, worded

    given = of_file(robot, packages, arguments, xacro)
    claim_picture("--picture", picture, force=force)
    with warnings.catch_warnings(), worded(COMMAND_LINE):
        warnings.simplefilter("ignore")  # they are printed with the rest
        model = robots.load(robot, **given)
    save_portrait(picture, model, model.neutral())
    if as_json:
        print_json(describe(model))
    else:
        print_info(model, new_console(at_least=72))
        if picture is not None:
            say(f"picture: {picture}")
        say(f"next: onorbit new {in_words(robot, packages, arguments, xacro)} --out FILE")
