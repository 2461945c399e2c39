"""What pydantic complains of, in our words and with its place in the YAML."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from onorbit_rs.exceptions import ScenarioError
from onorbit_rs.names import did_you_mean, nearest
from onorbit_rs.scenario.place import dotted, scenario_error
from onorbit_rs.scenario.yaml_lines import Lines, Location


def first_complaint(error: ValidationError, data: Any, file: Path | None, lines: Lines) -> ScenarioError:
    """One line for the complaint that stands first in the file, and how many more there are."""
    found: list[tuple[int, Location, str]] = []
    for details in error.errors(include_url=False):
        at, message = _place_and_message(details, data)
        found.append((_line_of(at, lines) or 0, at, message))
    line, at, message = min(found, key=lambda complaint: complaint[0])
    more = f" (and {len(found) - 1} more)" if len(found) > 1 else ""
    return scenario_error(message + more, file, line or None, dotted(at))


def _place_and_message(details: ErrorDetails, data: Any) -> tuple[Location, str]:
    """Where in the YAML, and what in our words."""
    kind, context = details["type"], details.get("ctx", {})
    at = _yaml_location(details["loc"], data, is_missing=kind == "missing")
    if kind == "unknown_key":
        return (*at, context["key"]), details["msg"]
    if kind == "parts":
        return context["at"], details["msg"]
    if kind == "missing":
        return at, "is missing"
    if kind in ("union_tag_not_found", "union_tag_invalid"):
        return _unknown_kind(at, context)
    if kind == "value_error":
        return at, str(context["error"])
    if kind == "literal_error":
        return (
            at,
            f"{details['input']!r} is not one of {context['expected']}{_near(details['input'], context)}",
        )
    if kind in ("too_short", "too_long"):
        return at, f"has {context['actual_length']} entries, needs {_needed_length(kind, context)}"
    if kind in ("model_type", "model_attributes_type", "dict_type"):
        return at, f"must be a mapping of keys to values, not {details['input']!r}"
    return (
        at,
        f"{_lower_first(details['msg'])}, got {details['input']!r}"
        if kind in _WITH_INPUT
        else details["msg"],
    )


_WITH_INPUT = {
    "int_type",
    "int_parsing",
    "int_from_float",
    "list_type",
    "string_type",
    "greater_than_equal",
    "path_type",
}


def _near(given: object, context: Mapping[str, Any]) -> str:
    """``, did you mean ...`` where one of the expected words is close."""
    near = nearest(str(given), re.findall(r"'([^']*)'", context["expected"]))
    return f", did you mean {near!r}?" if near else ""


def _unknown_kind(at: Location, context: Mapping[str, Any]) -> tuple[Location, str]:
    if "tag" not in context:
        return at, "needs a 'kind'"
    known = [tag.strip(" '") for tag in context["expected_tags"].split(",")]
    return (*at, "kind"), f"unknown kind {context['tag']!r}{did_you_mean(context['tag'], known)}"


def _needed_length(kind: str, context: Mapping[str, Any]) -> int:
    return int(context["min_length"] if kind == "too_short" else context["max_length"])


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


def _line_of(at: Location, lines: Lines) -> int | None:
    for end in range(len(at), -1, -1):
        if at[:end] in lines:
            return lines[at[:end]]
    return None


def _lower_first(text: str) -> str:
    return text[:1].lower() + text[1:]
