"""Converts the validation errors of pydantic to messages with their location in the YAML file."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, cast

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from onorbit_rs.common.counting import count
from onorbit_rs.common.suggestions import did_you_mean, nearest
from onorbit_rs.exceptions import OnOrbitError, ScenarioError
from onorbit_rs.scenario.errors import shortened
from onorbit_rs.scenario.locations import dotted, scenario_error, spot_of
from onorbit_rs.scenario.yaml_lines import Lines, Location, line_of

MOST_ERRORS = 20
"""Largest number of errors in a message."""


def first_error(
    error: ValidationError,
    data: Any,
    file: Path | None,
    lines: Lines,
    location: Callable[..., Location] = lambda *at: at,
) -> ScenarioError:
    """Return the errors in the order of the file as one error; its attributes are those of the first one.

    ``location`` converts the location of an entry in ``data`` to the location in the file.
    """
    errors = []
    for details in error.errors(include_url=False):
        at, message = _location_and_message(details, data)
        at = location(*at)
        errors.append(scenario_error(message, file, line_of(at, lines) or lines.get(()), dotted(at)))
    return cast("ScenarioError", combined(errors))


def combined(errors: Sequence[OnOrbitError]) -> OnOrbitError:
    """Return several errors of a scenario as one error with a line for each, and the location of the first.

    The errors are in the order of the file. A single error is returned unchanged.
    """
    given = [own for error in errors for own in (getattr(error, "errors", None) or (error,))]
    found = sorted(
        {str(error): error for error in given}.values(), key=lambda error: spot_of(error).line or 0
    )
    if len(found) == 1:
        return found[0]
    lines = [str(error) for error in found[:MOST_ERRORS]]
    if len(found) > MOST_ERRORS:
        lines.append(f"and {len(found) - MOST_ERRORS} more")
    return ScenarioError("\n".join(lines), **spot_of(found[0])._asdict(), errors=tuple(found))


def _location_and_message(details: ErrorDetails, data: Any) -> tuple[Location, str]:
    """Return the location of an error in the YAML file and its message."""
    kind, context = details["type"], details.get("ctx", {})
    at = _yaml_location(details["loc"], data, is_missing=kind == "missing")
    if kind == "unknown_key":
        return (*at, context["key"]), details["msg"]
    if kind == "inconsistent":
        return (*at, *context["at"]), details["msg"]
    if kind == "union_tag_invalid":
        known = [tag.strip(" '") for tag in context["expected_tags"].split(",")]
        return (*at, "kind"), f"unknown kind {context['tag']!r}{did_you_mean(context['tag'], known)}"
    if kind == "missing":
        return at, "is missing; give " + _FORMS.get(at[-1] if at else "", "this key")
    return at, _message(kind, details, context)


_FORMS: dict[str | int, str] = {
    "robot": "a bundled name (humanoid_torso), a URDF, or {rigid_body: {mass: ..., inertia: ...}}",
    "simulation": "at least {duration: 10 s}",
}
"""Suggested content of required sections, for messages about a missing section."""

_MUST_BE = {
    "int": "a whole number",
    "float": "a number",
    "bool": "true or false",
    "list": "a list ([a, b], or lines that start with '- ')",
    "dict": "a mapping of keys to values",
    "model": "a mapping of keys to values",
    "string": "text (put a number in quotes)",
    "path": "the path of a file",
}
"""Names of the required types in messages, by the first word of pydantic's error type."""


def _message(kind: str, details: ErrorDetails, context: Mapping[str, Any]) -> str:
    """Return the message about an invalid value; ``kind`` is pydantic's type of the error."""
    given = details["input"]
    if kind == "value_error":
        return str(context["error"])
    if kind == "literal_error":
        return f"{shortened(given)} is not one of {context['expected']}{_near(given, context)}"
    if kind in ("too_short", "too_long"):
        needed = context["min_length" if kind == "too_short" else "max_length"]
        got = count(context["actual_length"], "entry", "entries")
        return f"has {got}; give {'at least one' if needed == 1 else needed}"
    if kind == "greater_than_equal":
        return f"{shortened(given)} is below the minimum, {context['ge']}"
    if kind == "less_than_equal":
        return f"{shortened(given)} is above the maximum, {context['le']}"
    if kind == "string_pattern_mismatch":
        return f"{shortened(given)} has characters other than letters, digits, '_' and '-'; remove them"
    what = kind.split("_")[0]
    if what in _MUST_BE and kind.endswith(("_type", "_parsing", "_from_float", "_size")):
        return f"must be {_MUST_BE[what]}, not {shortened(given)}"
    return details["msg"]


def _near(given: object, context: Mapping[str, Any]) -> str:
    """Return ``; did you mean ...?`` if one of the expected words is similar, otherwise an empty string."""
    near = nearest(str(given), re.findall(r"'([^']*)'", context["expected"]))
    return f"; did you mean {near!r}?" if near else ""


def _yaml_location(loc: Location, data: Any, *, is_missing: bool) -> Location:
    """Return pydantic's location without the tags of unions, which are not in the file."""
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
