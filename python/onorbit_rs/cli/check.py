"""``onorbit check``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from onorbit_rs.cli.options import JsonOption, QuietOption, ScenarioArgument
from onorbit_rs.cli.saying import count, say
from onorbit_rs.printable import shell_word

if TYPE_CHECKING:
    from onorbit_rs.scenario.build import Built


def check(scenario: ScenarioArgument, quiet: QuietOption = False, as_json: JsonOption = False) -> None:
    """Check a scenario and all it names, without running it."""
    from onorbit_rs.cli.printing import print_json
    from onorbit_rs.scenario import load
    from onorbit_rs.scenario.build import build

    built = build(load(scenario))
    if as_json:
        print_json(described(built))
    elif not quiet:
        print_checked(built)
        say(f"next: onorbit run {shell_word(scenario)} --out DIR")


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
