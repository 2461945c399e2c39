"""``onorbit check``."""

from __future__ import annotations

from typing import TYPE_CHECKING

import typer

from onorbit_rs.cli.options import ScenarioArgument

if TYPE_CHECKING:
    from onorbit_rs.scenario.build import Built


def check(scenario: ScenarioArgument) -> None:
    """Check a scenario and everything it names, without running it."""
    from onorbit_rs.scenario import load
    from onorbit_rs.scenario.build import build

    print_checked(build(load(scenario)))


def print_checked(built: Built) -> None:
    """What would run."""
    scenario, model = built.scenario, built.model
    settings = scenario.simulation
    parts = [
        f"{model.name} ({len(model.joint_names)} joints, {model.mass:.4g} kg)",
        f"orbit {scenario.orbit.kind}" if scenario.orbit else "no orbit",
        *(effect.kind for effect in scenario.environment),
        ", ".join(law.kind for law in scenario.laws) or "no controller",
        f"{settings.duration:g} s at {settings.time_step:g} s with {settings.integrator}",
    ]
    typer.echo(f"ok: {scenario.name}: {', '.join(parts)}")
