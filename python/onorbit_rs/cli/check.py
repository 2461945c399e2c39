"""``onorbit check``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from onorbit_rs.cli.options import JsonOption, QuietOption, ScenarioArgument
from onorbit_rs.cli.text_output import print_line
from onorbit_rs.common.counting import count
from onorbit_rs.common.printable import shell_word

if TYPE_CHECKING:
    from onorbit_rs.scenario import Scenario
    from onorbit_rs.scenario.build import Built


def check(
    scenario: ScenarioArgument,
    quiet: QuietOption = False,
    as_json: JsonOption = False,
    trust: Annotated[
        bool, typer.Option("--trust", help="Also execute controllers written in Python.")
    ] = False,
) -> None:
    """Check a scenario and its files without running it.

    Python controllers are inspected but not executed, unless --trust is given.
    """
    from onorbit_rs.cli.console import print_json
    from onorbit_rs.scenario import load
    from onorbit_rs.scenario.build import build

    checked = load(scenario)
    built = build(checked, runs_code=trust)
    not_run = [] if trust else _sources(checked)
    if as_json:
        print_json(as_data(built) | {"code_not_run": not_run})
    elif not quiet:
        print_checked(built)
        for source in not_run:
            print_line(f"not executed: {source} (onorbit run executes it; add --trust to execute it now)")
        print_line(f"next: onorbit run {shell_word(scenario)} --out DIR")


def _sources(scenario: Scenario) -> list[str]:
    """Return the files or modules of the user that a run would execute."""
    from onorbit_rs.common.user_code import is_foreign
    from onorbit_rs.scenario.control import PythonController
    from onorbit_rs.scenario.control.python_source import source_of

    sources = [source_of(law, scenario.folder) for law in scenario.laws if isinstance(law, PythonController)]
    return [source for source in dict.fromkeys(sources) if is_foreign(source)]


def as_data(built: Built) -> dict[str, Any]:
    """Return the contents of a scenario as plain data."""
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
        "engine": scenario.engine,
        "warnings": [*model.warnings, *built.warnings],
    }


def print_checked(built: Built) -> None:
    """Print the contents of a scenario in one line."""
    scenario, model = built.scenario, built.model
    settings = scenario.simulation
    engine = "" if scenario.engine == "native" else f" on {scenario.engine}"
    parts = [
        f"{model.name} ({count(len(model.joint_names), 'joint', 'joints')}, {model.mass:.4g} kg)",
        f"orbit {scenario.orbit.kind}" if scenario.orbit else "no orbit",
        *(effect.kind for effect in scenario.environment),
        ", ".join(law.kind for law in scenario.laws) or "no controller",
        f"{settings.duration:g} s at {settings.time_step:g} s with {settings.integrator}{engine}",
    ]
    print_line(f"ok: {scenario.name}: {', '.join(parts)}")
