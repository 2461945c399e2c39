"""From a name, a file or a mapping to a checked :class:`Scenario`; complaints say file, line and place."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from onorbit_rs import scenarios
from onorbit_rs.exceptions import NotFoundError, ScenarioError
from onorbit_rs.names import did_you_mean
from onorbit_rs.scenario.schema import Scenario
from onorbit_rs.scenario.yaml_lines import Lines, Location, read_yaml


def load(source: str | os.PathLike[str] | Mapping[str, Any] | Scenario) -> Scenario:
    """Read and check a scenario.

    Parameters
    ----------
    source : str, path, mapping or Scenario
        A bundled name (``"humanoid_reach"``), a YAML file, its content as a mapping, or one already read.

    Raises
    ------
    NotFoundError
        Neither a bundled name nor a file.
    ScenarioError
        Broken, misspelt or senseless; carries ``file``, ``path`` (the place in the YAML) and ``line``.
    """
    if isinstance(source, Scenario):
        return source
    if isinstance(source, Mapping):
        return check(dict(source), None, {})
    file = locate(source)
    data, lines = read_yaml(file)
    return check(data, file, lines)


def locate(source: str | os.PathLike[str]) -> Path:
    """The YAML file of a bundled name or a path; a file of that name in the working folder wins."""
    path = Path(source)
    if path.is_file() or (path.is_dir() and path.name not in scenarios.names()):
        return path
    name = os.fspath(source)
    if name in scenarios.names():
        return scenarios.path(name)
    hint = did_you_mean(path.stem, scenarios.names())
    raise NotFoundError(
        f"no such scenario: {name!r} is no file and no bundled name{hint}", path=name, kind="scenario"
    )


def check(data: Any, file: Path | None, lines: Lines) -> Scenario:
    """Validate plain data; ``lines`` is where each entry stands."""
    if not isinstance(data, dict):
        what = "empty" if data is None else f"a {type(data).__name__}"
        raise _error("", f"a scenario is a mapping of keys to values, this is {what}", file, None)
    try:
        scenario = Scenario.model_validate(data)
    except ValidationError as error:
        raise _first_complaint(error, data, file, lines) from None
    scenario.remember_source(file, lines)
    if file is not None and "name" not in data:
        scenario.name = file.stem
    return scenario


def _first_complaint(error: ValidationError, data: Any, file: Path | None, lines: Lines) -> ScenarioError:
    """One line for the complaint that stands first in the file, and how many more there are."""
    found: list[tuple[int, Location, str]] = []
    for details in error.errors(include_url=False):
        at, message = _place_and_message(details, data)
        found.append((_line_of(at, lines) or 0, at, message))
    line, at, message = min(found, key=lambda complaint: complaint[0])
    more = f" (and {len(found) - 1} more)" if len(found) > 1 else ""
    return _error(_dotted(at), message + more, file, line or None)


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
        return at, f"{details['input']!r} is not one of {context['expected']}"
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


def _dotted(at: Location) -> str:
    """``environment[0].force``."""
    text = "".join(f"[{step}]" if isinstance(step, int) else f".{step}" for step in at)
    return text.removeprefix(".")


def _lower_first(text: str) -> str:
    return text[:1].lower() + text[1:]


def _error(path: str, message: str, file: Path | None, line: int | None) -> ScenarioError:
    place = str(file) if file else "scenario"
    place += f":{line}" if line else ""
    text = f"{place}: {path}: {message}" if path else f"{place}: {message}"
    return ScenarioError(text, file=str(file) if file else None, path=path or None, line=line)
