"""Finds the errors of robots, tools and initial joints of a scenario that is invalid for other reasons."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any, cast

from onorbit_rs.exceptions import OnOrbitError, ScenarioError
from onorbit_rs.scenario.build import build_parts
from onorbit_rs.scenario.faults import Faults
from onorbit_rs.scenario.schema import Scenario
from onorbit_rs.scenario.validation_errors import combined
from onorbit_rs.scenario.world import WorldScenario
from onorbit_rs.scenario.yaml_lines import Lines

_KEPT = ("robot", "tool")
_OF_START = ("joints", "joint_rates")
_SIMULATION = {"duration": 1.0}


def with_robot_errors(
    error: ScenarioError, data: dict[str, Any], file: Path | None, lines: Lines
) -> ScenarioError:
    """Return an error of a scenario together with those of its robots.

    The robots are loaded with their tools and the positions and rates of their joints, as far as these
    entries are valid; all other entries have their defaults, and no Python code is executed.
    """
    wrong = [str(own.path) for own in (error.errors or (error,))]
    faults = Faults()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for alone in _robots(data, wrong, file, lines):
            with faults.kept():
                build_parts(alone, runs_code=False)
    return cast("ScenarioError", combined([error, *faults.errors]))


def _robots(data: dict[str, Any], wrong: list[str], file: Path | None, lines: Lines) -> list[Scenario]:
    """Return a scenario of each robot whose entry is valid."""
    systems = data.get("systems")
    try:
        if systems is None:
            kept = _valid(data, wrong, "")
            return [Scenario.checked({**kept, "simulation": _SIMULATION}, file, lines)] if kept else []
        found = {name: _valid(system, wrong, f"systems.{name}.") for name, system in systems.items()}
        found = {name: kept for name, kept in found.items() if kept}
        world = {"systems": found, "simulation": _SIMULATION}
        return list(WorldScenario.checked(world, file, lines).scenarios.values()) if found else []
    except (OnOrbitError, AttributeError, TypeError):  # entries of wrong types, whose errors are known
        return []


def _valid(part: dict[str, Any], wrong: list[str], prefix: str) -> dict[str, Any]:
    """Return the entries of one robot without errors; empty if the robot itself has errors."""

    def is_valid(key: str) -> bool:
        return not any(path.startswith(f"{prefix}{key}") for path in wrong)

    if "robot" not in part or not is_valid("robot"):
        return {}
    kept = {key: part[key] for key in _KEPT if key in part and is_valid(key)}
    initial = part.get("initial")
    if isinstance(initial, dict):
        kept["initial"] = {
            key: initial[key] for key in _OF_START if key in initial and is_valid(f"initial.{key}")
        }
    return kept
