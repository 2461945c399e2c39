"""Settings that differ between two scenarios, which may explain why two runs diverge."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from onorbit_rs.common.counting import count
from onorbit_rs.output import with_absolute_paths
from onorbit_rs.scenario import Scenario, WorldScenario

PARTS = (
    "epoch",
    "orbit",
    "gravity_mode",
    "environment",
    "surfaces",
    "controller",
    "controllers",
    "reference",
)
"""Sections of a scenario that are compared, besides time step, integrator, control period and events."""
MOST = 6
"""Largest number of differences that are listed individually."""


def differing_settings(a: Scenario | WorldScenario, b: Scenario | WorldScenario) -> list[str]:
    """Return a note for each differing setting, at most :data:`MOST`, and the number of further ones."""
    first, second = (_compared_settings(scenario) for scenario in (a, b))
    found = [f"{where} differs: {_short(one)} and {_short(other)}"
             for where, one, other in _differences("", first, second)]  # fmt: skip
    left = len(found) - MOST
    more = count(left, "more setting differs", "more settings differ")
    return found if left <= 0 else [*found[:MOST], more]


def _compared_settings(scenario: Scenario | WorldScenario) -> dict[str, Any]:
    resolved = with_absolute_paths(scenario)
    steps = resolved.get("simulation", {})
    settings = {name: resolved.get(name) for name in PARTS}
    settings |= {name: steps.get(name) for name in ("time_step", "control_period", "integrator")}
    if "systems" not in resolved:
        return settings
    systems = {name: {part: own.get(part) for part in (*PARTS, "control_period")}
               for name, own in resolved["systems"].items()}  # fmt: skip
    return settings | {"systems": systems, "events": resolved.get("events")}


def _differences(where: str, a: Any, b: Any) -> Iterator[tuple[str, Any, Any]]:
    """Yield the path and both values of every entry that differs."""
    if isinstance(a, dict) and isinstance(b, dict) and a.get("kind") == b.get("kind"):
        for name in (*a, *(name for name in b if name not in a)):
            yield from _differences(f"{where}.{name}" if where else name, a.get(name), b.get(name))
    elif isinstance(a, list) and isinstance(b, list) and len(a) == len(b):
        for number, (one, other) in enumerate(zip(a, b, strict=True)):
            yield from _differences(f"{where}[{number}]", one, other)
    elif a != b:
        yield where, a, b


def _short(value: Any) -> str:
    """Return a value as one short line of text."""
    if value is None or value == []:
        return "none"
    if isinstance(value, dict):
        return str(value.get("kind", "another"))
    if isinstance(value, list):
        return count(len(value), "entry", "entries")
    text = f"{value:.10g}" if isinstance(value, float) else str(value)
    return text if len(text) <= 60 else f"{text[:57]}..."
