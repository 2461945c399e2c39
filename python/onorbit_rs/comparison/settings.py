"""What two scenarios set otherwise: why two runs may part, or agree although they should not."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from onorbit_rs.counting import count
from onorbit_rs.output import with_absolute_paths
from onorbit_rs.scenario import Scenario

PARTS = ("epoch", "orbit", "gravity_mode", "environment", "controller", "controllers", "reference")
"""Of a scenario, beside its steps: what moves the robot."""
MOST = 6
"""Notes of settings, before the rest are counted."""


def settings_apart(a: Scenario, b: Scenario) -> list[str]:
    """A note for each setting of orbit, environment, controllers or time step that differs."""
    first, second = (_told(scenario) for scenario in (a, b))
    found = [f"{where} differs: {_short(one)} and {_short(other)}"
             for where, one, other in _apart("", first, second)]  # fmt: skip
    left = len(found) - MOST
    return found if left <= 0 else [*found[:MOST], f"{left} more settings differ"]


def _told(scenario: Scenario) -> dict[str, Any]:
    resolved = with_absolute_paths(scenario)
    steps = resolved.get("simulation", {})
    told = {name: resolved.get(name) for name in PARTS}
    return told | {name: steps.get(name) for name in ("time_step", "control_period", "integrator")}


def _apart(where: str, a: Any, b: Any) -> Iterator[tuple[str, Any, Any]]:
    """The entries that differ, by their names."""
    if isinstance(a, dict) and isinstance(b, dict) and a.get("kind") == b.get("kind"):
        for name in (*a, *(name for name in b if name not in a)):
            yield from _apart(f"{where}.{name}" if where else name, a.get(name), b.get(name))
    elif isinstance(a, list) and isinstance(b, list) and len(a) == len(b):
        for number, (one, other) in enumerate(zip(a, b, strict=True)):
            yield from _apart(f"{where}[{number}]", one, other)
    elif a != b:
        yield where, a, b


def _short(value: Any) -> str:
    """On one line, and not a long one."""
    if value is None or value == []:
        return "none"
    if isinstance(value, dict):
        return str(value.get("kind", "another"))
    if isinstance(value, list):
        return count(len(value), "entry", "entries")
    said = f"{value:.10g}" if isinstance(value, float) else str(value)
    return said if len(said) <= 60 else f"{said[:57]}..."
