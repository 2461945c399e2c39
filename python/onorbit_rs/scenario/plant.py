"""Another physics engine in the place of ours: what it can take of a scenario."""

from __future__ import annotations

from typing import TYPE_CHECKING

from onorbit_rs import plants
from onorbit_rs.scenario.refusals import misfit

if TYPE_CHECKING:
    from onorbit_rs._core import Model
    from onorbit_rs.scenario.schema import Scenario


def check_plant(scenario: Scenario) -> None:
    """Refuse settings that the plant does not have."""
    settings = scenario.simulation
    if scenario.plant == "native":
        return
    if settings.integrator == "dormand_prince":
        raise misfit(
            ("simulation", "integrator"),
            f"the plant {scenario.plant} has no dormand_prince; take rk4, or plant: native",
        )
    if settings.enforce_limits and settings.restitution > 0.0:
        raise misfit(
            ("simulation", "restitution"),
            f"stops of the plant {scenario.plant} give nothing back; take restitution 0, or plant: native",
        )


def make_plant(scenario: Scenario, model: Model) -> plants.Mujoco | None:
    """The engine that moves the robot, None for ours."""
    if scenario.plant == "native":
        return None
    settings = scenario.simulation
    assert settings.integrator != "dormand_prince"  # refused above
    return plants.Mujoco(
        model,
        time_step=settings.time_step,
        integrator=settings.integrator,
        enforce_limits=settings.enforce_limits,
    )
