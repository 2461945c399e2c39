"""Implements ``onorbit check``, which validates a scenario without running it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from onorbit_rs.cli.options import (
    JsonOption,
    QuietOption,
    ScenarioArgument,
    SetOption,
    check_is_scenario,
    scenario_changes,
)
from onorbit_rs.cli.text_output import print_line
from onorbit_rs.common.counting import count
from onorbit_rs.common.printable import shell_word

if TYPE_CHECKING:
    from onorbit_rs.scenario import Scenario, WorldScenario
    from onorbit_rs.scenario.build import Built
    from onorbit_rs.scenario.build_world import BuiltWorld


def check(
    scenario: ScenarioArgument,
    quiet: QuietOption = False,
    as_json: JsonOption = False,
    trust: Annotated[
        bool, typer.Option("--trust", help="Also execute controllers and effects written in Python.")
    ] = False,
    assignments: SetOption = None,
) -> None:
    """Check a scenario and its files without running it.

    Controllers and effects written in Python are inspected but not executed, unless --trust is given.
    """
    from onorbit_rs.cli.console import print_json
    from onorbit_rs.scenario import WorldScenario, load
    from onorbit_rs.scenario.build import build
    from onorbit_rs.scenario.build_world import build_world

    check_is_scenario(scenario)
    checked = load(scenario, changes=scenario_changes(assignments))
    built: Built | BuiltWorld
    if isinstance(checked, WorldScenario):
        built = build_world(checked, runs_code=trust)
    else:
        built = build(checked, runs_code=trust)
    not_run = [] if trust else _sources(checked)
    if as_json:
        print_json(as_data(built) | {"code_not_run": not_run})
    elif not quiet:
        print_checked(built)
        for source in not_run:
            print_line(f"not executed: {source} (onorbit run executes it; add --trust to execute it now)")
        print_line(f"next: onorbit run {shell_word(scenario)} --out DIR")


def _sources(scenario: Scenario | WorldScenario) -> list[str]:
    """Return the user's Python files and modules that a run would execute."""
    from onorbit_rs.common.user_code import is_foreign
    from onorbit_rs.scenario.user_code import source_of

    sources = [source_of(part, scenario.folder) for part in scenario.user_classes]
    return [source for source in dict.fromkeys(sources) if is_foreign(source)]


def as_data(built: Built | BuiltWorld) -> dict[str, Any]:
    """Return the summary of a scenario that ``--json`` prints, in SI units."""
    from onorbit_rs.scenario.build import Built

    scenario = built.scenario
    if isinstance(built, Built):
        own, messages = _robot_data(built), [*built.model.warnings, *built.warnings]
    else:
        own = {
            "systems": {name: _robot_data(alone) for name, alone in built.systems.items()},
            "events": [event.name for event in built.scenario.events],
        }
        messages = [*(text for alone in built.systems.values() for text in alone.model.warnings),
                    *built.warnings]  # fmt: skip
    return {"ok": True, "scenario": scenario.name} | own | {
        "orbit": scenario.orbit.kind if scenario.orbit else None,
        "environment": [effect.kind for effect in scenario.environment],
        "duration_s": scenario.simulation.duration,
        "time_step_s": scenario.simulation.time_step,
        "integrator": scenario.simulation.integrator,
        "engine": scenario.engine,
        "warnings": messages,
    }  # fmt: skip


def _robot_data(built: Built) -> dict[str, Any]:
    model = built.model
    return {
        "robot": model.name,
        "joints": list(model.joint_names),
        "mass_kg": model.mass,
        "tool": built.scenario.tracked_tool,
        "controllers": [law.kind for law in built.scenario.laws],
    }


def print_checked(built: Built | BuiltWorld) -> None:
    """Print the contents of a scenario in one line."""
    from onorbit_rs.scenario.build import Built

    scenario = built.scenario
    settings = scenario.simulation
    engine = "" if scenario.engine == "native" else f" on {scenario.engine}"
    around = [
        f"orbit {scenario.orbit.kind}" if scenario.orbit else "no orbit",
        *(effect.kind for effect in scenario.environment),
    ]
    timing = f"{settings.duration:g} s at {settings.time_step:g} s with {settings.integrator}{engine}"
    if isinstance(built, Built):
        robot, laws = _robot_words(built)
        parts = [robot, *around, laws, timing]
    else:
        systems = (f"{name}: {', '.join(_robot_words(alone))}" for name, alone in built.systems.items())
        number = len(built.scenario.events)
        events = [count(number, "event", "events")] if number else []
        parts = ["; ".join(systems), *around, *events, timing]
    print_line(f"ok: {scenario.name}: {', '.join(parts)}")


def _robot_words(built: Built) -> tuple[str, str]:
    """Return short descriptions of the robot and of its controllers."""
    model = built.model
    robot = f"{model.name} ({count(len(model.joint_names), 'joint', 'joints')}, {model.mass:.4g} kg)"
    return robot, ", ".join(law.kind for law in built.scenario.laws) or "no controller"
