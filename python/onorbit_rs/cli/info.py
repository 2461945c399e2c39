"""``onorbit info``."""

from __future__ import annotations

import json
import warnings
from typing import Annotated

import typer

from onorbit_rs.cli.options import ArgumentsOption, PackagesOption


def info(
    robot: Annotated[str, typer.Argument(metavar="ROBOT", help="A bundled name, a URDF or a xacro file.")],
    packages: PackagesOption = None,
    arguments: ArgumentsOption = None,
    as_json: Annotated[bool, typer.Option("--json", help="As data, for programs.")] = False,
) -> None:
    """Print a robot's tree, masses, joints, frames and what was odd."""
    from onorbit_rs import robots
    from onorbit_rs.robots.describe import describe, print_info

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # they are printed with the rest
        model = robots.load(robot, package_paths=packages, xacro_arguments=_as_mapping(arguments))
    if as_json:
        typer.echo(json.dumps(describe(model), indent=1))
    else:
        print_info(model)


def _as_mapping(arguments: list[str] | None) -> dict[str, str] | None:
    """``name=value`` or, as xacro writes it, ``name:=value``."""
    pairs = [argument.replace(":=", "=", 1).partition("=") for argument in arguments or []]
    for name, equals, _ in pairs:
        if not equals or not name:
            raise typer.BadParameter(f"write an argument of a xacro as name=value, not {name!r}")
    return {name: value for name, _, value in pairs} or None
