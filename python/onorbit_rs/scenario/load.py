"""Reads a scenario from a name, a file or a mapping; errors name file, line and key."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from onorbit_rs.exceptions import DtypeError, ScenarioError
from onorbit_rs.scenario.changes import Changes, changed, misspelt
from onorbit_rs.scenario.locations import scenario_error
from onorbit_rs.scenario.schema import Scenario
from onorbit_rs.scenario.world import WorldScenario
from onorbit_rs.scenario.yaml_lines import Lines, read_yaml
from onorbit_rs.scenarios import SCENARIOS

AnyScenario = Scenario | WorldScenario

_KINDS = {bool: "true or false", int: "a number", float: "a number", str: "text", list: "a list"}
"""Descriptions, for messages, of the types other than mappings that YAML yields."""


def load(
    source: str | os.PathLike[str] | Mapping[str, Any] | AnyScenario, *, changes: Changes | None = None
) -> AnyScenario:
    """Return the validated scenario that a name, a file or a mapping defines.

    Parameters
    ----------
    source : str, path, mapping or Scenario
        A bundled name (``"humanoid_reach"``), a YAML file, its content as a mapping, or a scenario, which is
        returned as it is unless there are changes.
    changes : mapping, optional
        New values of entries, by path: ``{"simulation.duration": "2 s", "environment[0].kind": "drag"}``.
        Keys that the scenario does not contain are added.

    Returns
    -------
    Scenario or WorldScenario
        Scenario of one robot, or of several systems.

    Raises
    ------
    NotFoundError, ReadError
        If ``source`` is neither a bundled name nor a file, or the file cannot be read.
    DtypeError
        If ``source`` has another type.
    InputError
        If a path of ``changes`` cannot be read, or leads through an entry that is neither a mapping nor a
        list, or to an entry of a list that does not exist.
    ScenarioError
        If the scenario is invalid; the error has the attributes ``file``, ``path`` (the location in the YAML)
        and ``line``.
    """
    if isinstance(source, (Scenario, WorldScenario)):
        if not changes:
            return source
        return _checked_changes(source.resolved(), source.file, {}, changes)
    if isinstance(source, Mapping):
        return _checked_changes(dict(source), None, {}, changes)
    if not isinstance(source, (str, os.PathLike)):
        kind = type(source).__name__
        raise DtypeError(
            f"{source!s:.60} ({kind}) is not a scenario; give a bundled name, a YAML file, a mapping or a "
            "Scenario",
            name="scenario", got=kind, expected="str, path, mapping or Scenario",
        )  # fmt: skip
    file = SCENARIOS.locate(source)
    data, lines = read_yaml(file)
    return _checked_changes(data, file, lines, changes)


def _checked_changes(data: Any, file: Path | None, lines: Lines, changes: Changes | None) -> AnyScenario:
    """Return the validated scenario with the changes."""
    before = data
    if changes and isinstance(data, dict):
        data, lines = changed(data, lines, changes)
    try:
        return check(data, file, lines)
    except ScenarioError as error:
        hint = misspelt(before, str(error.path or ""), changes) if changes else ""
        if hint and len(error.errors) <= 1 and "did you mean" not in error.message:
            error.message += hint
        if not isinstance(data, dict) or "campaign" in data:
            raise
        from onorbit_rs.scenario.robot_errors import with_robot_errors  # imports half of the package

        raise with_robot_errors(error, data, file, lines) from None


def check(data: Any, file: Path | None, lines: Lines) -> AnyScenario:
    """Return a validated scenario from plain data, or raise ScenarioError.

    ``lines`` contains the line of each entry.

    Several ``systems`` give a :class:`WorldScenario`; a single system or robot gives a :class:`Scenario`.
    """
    if not isinstance(data, dict):
        what = "empty" if data is None else _KINDS.get(type(data), f"of type {type(data).__name__}")
        message = (
            f"the content is {what}; a scenario must be a mapping of keys to values (onorbit new writes a "
            "template)"
        )
        raise scenario_error(message, file, None)
    if "campaign" in data:
        message = "the content is a campaign, not a scenario; run it with onorbit campaign or oo.campaign"
        raise scenario_error(message, file, lines.get(("campaign",)))
    if "systems" in data:
        world = WorldScenario.checked(data, file, lines)
        if len(world.systems) > 1:
            return world
        if world.events:
            message = (
                "events require at least two systems; add a system, or let a brake hold from the start with "
                "'engaged: true'"
            )
            raise scenario_error(message, file, lines.get(("events",)), "events")
        return next(iter(world.scenarios.values()))
    return Scenario.checked(data, file, lines)
