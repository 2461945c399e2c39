"""Checks and creates the physics engine of a scenario."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from onorbit_rs import engines
from onorbit_rs.scenario.errors import inconsistent

if TYPE_CHECKING:
    from onorbit_rs import _core
    from onorbit_rs._core import Model
    from onorbit_rs.scenario.schema import Scenario
    from onorbit_rs.scenario.world import WorldScenario


def check_engine(scenario: Scenario) -> None:
    """Raise an error for settings that the engine does not support."""
    settings = scenario.simulation
    if scenario.engine == "native":
        return
    if settings.integrator == "dormand_prince":
        raise inconsistent(
            ("simulation", "integrator"),
            f"engine {scenario.engine} does not support integrator dormand_prince; use integrator: rk4, "
            "or engine: native",
        )
    if settings.enforce_limits and settings.restitution > 0.0:
        raise inconsistent(
            ("simulation", "restitution"),
            f"engine {scenario.engine} does not support restitution; use restitution: 0, or engine: native",
        )


def check_world_engine(scenario: WorldScenario) -> None:
    """Raise an error for settings, contacts, events and systems that the engine does not support."""
    if scenario.engine == "native":
        if scenario.simulation.weld_time_constant is not None:
            message = (
                "'weld_time_constant' applies only to engine: mujoco, since connections of the native engine "
                "are exact; omit it"
            )
            raise inconsistent(("simulation", "weld_time_constant"), message)
        return
    for index, contact in enumerate(scenario.contacts):
        if contact.friction is not None and contact.friction.torsional > 0.0:
            message = (
                f"engine {scenario.engine} applies one friction cone to sliding and torsion together, so it "
                "does not support 'torsional'; omit 'torsional', or use engine: native"
            )
            raise inconsistent(("contacts", index, "friction", "torsional"), message)
    for index, event in enumerate(scenario.events):
        for key in ("seat", "impulse"):
            if getattr(event.do, key, None) is not None:
                message = f"engine {scenario.engine} does not support {key!r}; omit it, or use engine: native"
                raise inconsistent(("events", index, "do", key), message)
    for name, system in scenario.systems.items():
        if system.knows:
            message = f"engine {scenario.engine} does not support 'knows'; omit it, or use engine: native"
            raise inconsistent(("systems", name, "knows"), message)


def build_engine(scenario: Scenario, model: Model) -> engines.Mujoco | None:
    """Return the physics engine of the run, or None for the native engine."""
    return _build(scenario, model, scenario.simulation.enforce_limits)


def build_world_engine(scenario: WorldScenario, models: dict[str, Model]) -> engines.Mujoco | None:
    """Return the physics engine of a run of several systems, or None for the native engine."""
    stops = [name for name, one in scenario.systems.items() if one.enforce_limits]
    contacts = [contact.build() for contact in scenario.contacts]
    return _build(
        scenario, models, stops,
        weld_time_constant=scenario.simulation.weld_time_constant, contacts=contacts,
    )  # fmt: skip


def _build(
    scenario: Scenario | WorldScenario,
    model: Model | dict[str, Model],
    enforce_limits: bool | list[str],
    *,
    weld_time_constant: float | None = None,
    contacts: Sequence[_core.Contact] = (),
) -> engines.Mujoco | None:
    if scenario.engine == "native":
        return None
    settings = scenario.simulation
    assert settings.integrator != "dormand_prince"  # check_engine rejects it
    return engines.Mujoco(
        model, time_step=settings.time_step, integrator=settings.integrator, enforce_limits=enforce_limits,
        weld_time_constant=weld_time_constant, contacts=contacts,
    )  # fmt: skip
