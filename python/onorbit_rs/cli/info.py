"""Implements ``onorbit info``, which describes a robot or the systems of a scenario."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from onorbit_rs.cli.completion import robot_and_scenario_names
from onorbit_rs.cli.figure_files import check_figure_file, save_portrait
from onorbit_rs.cli.options import (
    ArgumentsOption,
    JsonOption,
    PackagesOption,
    PictureOption,
    XacroOption,
    as_arguments,
    reading_options,
)
from onorbit_rs.cli.text_output import print_line
from onorbit_rs.common.printable import shell_word
from onorbit_rs.exceptions import InputError

if TYPE_CHECKING:
    from onorbit_rs.scenario import Scenario, WorldScenario


def info(
    robot: Annotated[
        str,
        typer.Argument(
            metavar="ROBOT_OR_SCENARIO",
            help="A bundled name, a URDF or a xacro file, or the YAML file of a scenario.",
            autocompletion=robot_and_scenario_names,
        ),
    ],
    packages: PackagesOption = None,
    arguments: ArgumentsOption = None,
    xacro: XacroOption = False,
    picture: PictureOption = None,
    force: Annotated[bool, typer.Option("--force", help="Replace an existing picture.")] = False,
    as_json: JsonOption = False,
) -> None:
    """Print a robot's tree, masses, joints, loops and frames.

    For a scenario with several systems, print the systems, the contacts, the events, and the trees of
    connected systems after each event.
    """
    from onorbit_rs import robots
    from onorbit_rs.cli.console import new_console, print_json
    from onorbit_rs.cli.robot_info import print_info
    from onorbit_rs.robots.describe import describe
    from onorbit_rs.robots.wording import COMMAND_LINE, worded

    check_figure_file("--picture", picture, force=force)
    scenario = _scenario(robot)
    given = reading_options(robot, packages, arguments, xacro) if scenario is None else {}
    if scenario is not None:
        _check_no_reading_options(robot, packages, arguments, xacro)
        from onorbit_rs.scenario import WorldScenario

        if isinstance(scenario, WorldScenario):
            _world_info(scenario, robot, picture, as_json=as_json)
            return
    with warnings.catch_warnings(), worded(COMMAND_LINE):
        warnings.simplefilter("ignore")  # print_info prints them
        model = robots.load(robot, **given) if scenario is None else scenario.robot.build(scenario)
    save_portrait(picture, model, model.neutral())
    if as_json:
        print_json(describe(model))
    else:
        print_info(model, new_console(at_least=72))
        if picture is not None:
            print_line(f"picture: {picture}")
        words = as_arguments(robot, packages, arguments, xacro)
        command = f"new {words} --out FILE" if scenario is None else f"run {words} --out DIR"
        print_line(f"next: onorbit {command}")


def _check_no_reading_options(
    name: str, packages: list[Path] | None, arguments: list[str] | None, xacro: bool
) -> None:
    """Raise InputError if options for the file of a robot are given with a scenario."""
    if packages or arguments or xacro:
        raise InputError(
            f"--package-path, --arg and --xacro apply only to robot files, but {name} is a scenario; omit "
            "them, and write package_paths, xacro_arguments and xacro below 'robot' in the scenario",
            name="robot", got=name,
        )  # fmt: skip


def _scenario(name: str) -> Scenario | WorldScenario | None:
    """Return the scenario with this name or in this file; None if the argument is a robot."""
    from onorbit_rs import robots, scenarios
    from onorbit_rs.scenario import load

    is_yaml = Path(name).suffix.lower() in (".yaml", ".yml")
    is_bundled = name in scenarios.names() and name not in robots.names()
    return load(name) if is_yaml or is_bundled else None


def _world_info(scenario: WorldScenario, name: str, picture: Path | None, *, as_json: bool) -> None:
    """Print systems, contacts, events and trees of connected systems of a scenario with several systems."""
    from onorbit_rs.cli.console import new_console, print_json
    from onorbit_rs.cli.world_info import describe_world, print_world

    if picture is not None:
        raise InputError(
            f"--picture {picture} draws a single robot, but {name} has {len(scenario.scenarios)} systems; "
            "give the robot of one system: onorbit info ROBOT --picture FILE",
            name="picture",
            got=str(picture),
        )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # 'onorbit check' prints them
        models = {system: alone.robot.build(alone) for system, alone in scenario.scenarios.items()}
    if as_json:
        print_json(describe_world(scenario, models))
        return
    print_world(scenario, models, new_console(at_least=72))
    print_line(f"next: onorbit run {shell_word(name)} --out DIR")
