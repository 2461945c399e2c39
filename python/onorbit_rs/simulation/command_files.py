"""Commands in the folder of a run, and warnings about controllers that receive no commands."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from onorbit_rs.output.manifest import COMMANDS
from onorbit_rs.scenario import WorldScenario
from onorbit_rs.scenario.control import ExternalController
from onorbit_rs.simulation.command_format import Command, as_line, parse_commands

if TYPE_CHECKING:
    from onorbit_rs.output import OutputFolder
    from onorbit_rs.scenario import Scenario


def write_commands(folder: OutputFolder, commands: Sequence[Command]) -> None:
    """Write the commands of a run to ``commands.jsonl``, so that the run can be resumed or repeated."""
    with folder.writing(COMMANDS) as path:
        path.write_text("".join(as_line(command) for command in commands), encoding="utf-8")


def saved_commands(folder: OutputFolder) -> list[Command]:
    """Return the commands of the run in a folder; empty if the folder contains no commands.

    Raises
    ------
    IntegrityError
        If the file has changed since the run wrote it.
    """
    manifest = folder.manifest
    if manifest is None or COMMANDS not in manifest.files:
        return []
    with manifest.opened(folder.path, COMMANDS) as stream:
        return parse_commands(stream.read().decode(), str(folder.path / COMMANDS))


def warnings_without(scenario: Scenario | WorldScenario) -> Iterator[str]:
    """Yield a warning for each controller that follows commands, for a run without commands."""
    if isinstance(scenario, WorldScenario):
        systems = {f"systems.{name}.": alone for name, alone in scenario.scenarios.items()}
    else:
        systems = {"": scenario}
    for prefix, alone in systems.items():
        for index, law in enumerate(alone.laws):
            if isinstance(law, ExternalController):
                where = "controller" if alone.controllers is None else f"controllers[{index}]"
                yield (
                    f"{prefix}{where}: the controller external receives no commands in this run, so "
                    f"{law.without_commands()}; give commands with onorbit run --commands FILE, or from "
                    "Python with Stepper.send"
                )
