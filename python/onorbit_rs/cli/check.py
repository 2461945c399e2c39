"""``onorbit check``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from onorbit_rs.cli.options import JsonOption, QuietOption, ScenarioArgument
from onorbit_rs.cli.saying import say
from onorbit_rs.counting import count
from onorbit_rs.printable import shell_word

if TYPE_CHECKING:
    from onorbit_rs.scenario import Scenario
    from onorbit_rs.scenario.build import Built


def check(
    scenario: ScenarioArgument,
    quiet: QuietOption = False,
    as_json: JsonOption = False,
    trust: Annotated[
        bool, typer.Option("--trust", help="Import and construct controllers in Python too.")
    ] = False,
) -> None:
    """Check a scenario and all it names, without running it.

    The source of controllers in Python is read, not executed, unless you --trust it.
    """
    from onorbit_rs.cli.printing import print_json
    from onorbit_rs.scenario import load
    from onorbit_rs.scenario.build import build

    checked = load(scenario)
    built = build(checked, runs_code=trust)
    unrun = [] if trust else _sources(checked)
    if as_json:
        print_json(described(built) | {"code_not_run": unrun})
    elif not quiet:
        print_checked(built)
        for source in unrun:
            say(f"not run: {source}, which onorbit run will execute (--trust constructs its controller)")
        say(f"next: onorbit run {shell_word(scenario)} --out DIR")


def _sources(scenario: Scenario) -> list[str]:
    """Files or modules that a run would execute, but for those of this package."""
    from onorbit_rs.foreign_code import is_foreign
    from onorbit_rs.scenario.control import PythonController
    from onorbit_rs.scenario.python_source import source_of

    beside = scenario.file.parent if scenario.file else Path()
    sources = [source_of(law, beside) for law in scenario.laws if isinstance(law, PythonController)]
    return [source for source in dict.fromkeys(sources) if is_foreign(source)]


def described(built: Built) -> dict[str, Any]:
    """What would run, as data."""
    scenario, model = built.scenario, built.model
    return {
        "ok": True,
        "scenario": scenario.name,
        "robot": model.name,
        "joints": list(model.joint_names),
        "mass_kg": model.mass,
        "tool": scenario.tracked_tool,
        "orbit": scenario.orbit.kind if scenario.orbit else None,
        "environment": [effect.kind for effect in scenario.environment],
        "controllers": [law.kind for law in scenario.laws],
        "duration_s": scenario.simulation.duration,
        "time_step_s": scenario.simulation.time_step,
        "integrator": scenario.simulation.integrator,
        "plant": scenario.plant,
        "warnings": [*model.warnings, *built.doubts],
    }


def print_checked(built: Built) -> None:
    """What would run."""
    scenario, model = built.scenario, built.model
    settings = scenario.simulation
    plant = "" if scenario.plant == "native" else f" on {scenario.plant}"
    parts = [
        f"{model.name} ({count(len(model.joint_names), 'joint', 'joints')}, {model.mass:.4g} kg)",
        f"orbit {scenario.orbit.kind}" if scenario.orbit else "no orbit",
        *(effect.kind for effect in scenario.environment),
        ", ".join(law.kind for law in scenario.laws) or "no controller",
        f"{settings.duration:g} s at {settings.time_step:g} s with {settings.integrator}{plant}",
    ]
    say(f"ok: {scenario.name}: {', '.join(parts)}")
