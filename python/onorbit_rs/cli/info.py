"""``onorbit info``."""

from __future__ import annotations

import json
import warnings

import typer

from onorbit_rs.cli.options import ArgumentsOption, JsonOption, PackagesOption, RobotArgument, as_mapping


def info(
    robot: RobotArgument,
    packages: PackagesOption = None,
    arguments: ArgumentsOption = None,
    as_json: JsonOption = False,
) -> None:
    """Print a robot's tree, masses, joints, frames and what was odd."""
    from onorbit_rs import robots
    from onorbit_rs.robots.describe import describe, print_info

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # they are printed with the rest
        model = robots.load(robot, package_paths=packages, xacro_arguments=as_mapping(arguments))
    if as_json:
        typer.echo(json.dumps(describe(model), indent=1))
    else:
        print_info(model)
