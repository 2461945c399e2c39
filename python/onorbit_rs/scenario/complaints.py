"""What pydantic complains of, in our words and with its place in the YAML."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from onorbit_rs.counting import count
from onorbit_rs.exceptions import ScenarioError
from onorbit_rs.names import did_you_mean, nearest
from onorbit_rs.scenario.place import dotted, scenario_error
from onorbit_rs.scenario.refusals import shown
from onorbit_rs.scenario.yaml_lines import Lines, Location, line_of


def first_complaint(error: ValidationError, data: Any, file: Path | None, lines: Lines) -> ScenarioError:
    """One line for the complaint that stands first in the file, and how many more there are."""
    found: list[tuple[int, Location, str]] = []
    for details in error.errors(include_url=False):
        at, message = _place_and_message(details, data)
        found.append((line_of(at, lines) or lines.get((), 0), at, message))
    line, at, message = min(found, key=lambda complaint: complaint[0])
    more = f" (and {len(found) - 1} more)" if len(found) > 1 else ""
    return scenario_error(message + more, file, line or None, dotted(at))


def _place_and_message(details: ErrorDetails, data: Any) -> tuple[Location, str]:
    """Where in the YAML, and what in our words."""
    kind, context = details["type"], details.get("ctx", {})
    at = _yaml_location(details["loc"], data, is_missing=kind == "missing")
    if kind == "unknown_key":
        return (*at, context["key"]), details["msg"]
    if kind == "misfit":
        return context["at"], details["msg"]
    if kind == "union_tag_invalid":
        known = [tag.strip(" '") for tag in context["expected_tags"].split(",")]
        return (*at, "kind"), f"unknown kind {context['tag']!r}{did_you_mean(context['tag'], known)}"
    if kind == "missing":
        return at, "is missing" + _FORMS.get(at[-1] if at else "", "")
    return at, _said(kind, details, context)


_FORMS: dict[str | int, str] = {
    "robot": ": a bundled name (humanoid_torso), a URDF, or {rigid_body: {mass: ..., inertia: ...}}",
    "simulation": ": at least {duration: 10 s}",
}
"""What to write where a whole part is missing."""

_MUST_BE = {
    "int": "a whole number",
    "float": "a number",
    "bool": "true or false",
    "list": "a list ([a, b], or lines that begin with '- ')",
    "dict": "a mapping of keys to values",
    "model": "a mapping of keys to values",
    "string": "text (a number wants quotes)",
    "path": "the path of a file",
}
"""By what pydantic's complaints of another type begin with."""


def _said(kind: str, details: ErrorDetails, context: Mapping[str, Any]) -> str:
    """A complaint about one value, in our words."""
    given = details["input"]
    if kind == "value_error":
        return str(context["error"])
    if kind == "literal_error":
        return f"{shown(given)} is not one of {context['expected']}{_near(given, context)}"
    if kind in ("too_short", "too_long"):
        needed = context["min_length" if kind == "too_short" else "max_length"]
        got = count(context["actual_length"], "entry", "entries")
        return f"has {got}, needs {'at least 1' if needed == 1 else needed}"
    if kind == "greater_than_equal":
        return f"{shown(given)} is below {context['ge']}, the least that is allowed"
    if kind == "less_than_equal":
        return f"{shown(given)} is above {context['le']}, the most that is allowed"
    if kind == "string_pattern_mismatch":
        return f"{shown(given)} has characters other than letters, digits, '_' and '-'"
    what = kind.split("_")[0]
    if what in _MUST_BE and kind.endswith(("_type", "_parsing", "_from_float", "_size")):
        return f"must be {_MUST_BE[what]}, not {shown(given)}"
    return details["msg"]


def _near(given: object, context: Mapping[str, Any]) -> str:
    """``, did you mean ...`` where one of the expected words is close."""
    near = nearest(str(given), re.findall(r"'([^']*)'", context["expected"]))
    return f", did you mean {near!r}?" if near else ""


def _yaml_location(loc: Location, data: Any, *, is_missing: bool) -> Location:
    """Pydantic's location without the tags of unions, which are not in the file."""
    at: list[str | int] = []
    for index, step in enumerate(loc):
        inside = (isinstance(data, dict) and step in data) or (
            isinstance(data, list) and isinstance(step, int)
        )
        if inside:
            data = data[step]
            at.append(step)
        elif is_missing and index == len(loc) - 1:
            at.append(step)
    return tuple(at)
