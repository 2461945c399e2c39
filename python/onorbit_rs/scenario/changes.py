"""Changes of entries of a scenario, given by path: ``simulation.time_step`` or ``environment[0].force``."""

from __future__ import annotations

import copy
import re
from collections.abc import Mapping
from typing import Any

from onorbit_rs.common.suggestions import did_you_mean, nearest
from onorbit_rs.exceptions import InputError, ScenarioError
from onorbit_rs.scenario.locations import dotted
from onorbit_rs.scenario.yaml_lines import Lines, Location, parse_yaml

_STEP = re.compile(r"\.?(?P<key>[^.\[\]]+)|\[(?P<index>[0-9]{1,6})\]")

Changes = Mapping[str, Any]
"""Mapping from the paths of entries of a scenario to their new values."""


def parsed_changes(assignments: list[str] | None) -> dict[str, Any]:
    """Return changes written as ``PATH=VALUE``; the value is YAML, such as ``0.5 mm`` or ``[1, 0, 0]``.

    Raises
    ------
    InputError
        If an assignment has no ``=``, or its path or value cannot be read.
    """
    changes: dict[str, Any] = {}
    for assignment in assignments or ():
        path, equals, text = assignment.partition("=")
        if not equals:
            raise _invalid(assignment, "it has no '='; write KEY=VALUE, such as simulation.time_step=2e-3")
        location_of(path)
        try:
            changes[path], _ = parse_yaml(text, None)
        except ScenarioError as error:
            raise _invalid(assignment, f"its value is not YAML ({str(error).partition(': ')[2]})") from None
    return changes


def location_of(path: str) -> Location:
    """Return the keys and indices of a path.

    Raises
    ------
    InputError
        If the path cannot be read.
    """
    at: list[str | int] = []
    end = 0
    while end < len(path):
        found = _STEP.match(path, end)
        if found is None or (end == 0 and path.startswith(".")):
            break
        at.append(found["key"] if found["index"] is None else int(found["index"]))
        end = found.end()
    if not at or end < len(path):
        raise _invalid(
            path, "it is not a path of keys; write it like simulation.duration or environment[0].force"
        )
    return tuple(at)


def changed(data: Any, lines: Lines, changes: Changes) -> tuple[Any, Lines]:
    """Return a copy of the data of a scenario with the changes, and the lines of the other entries.

    Mappings that a path contains and the scenario does not are created.

    Raises
    ------
    InputError
        If a path leads through an entry that is neither a mapping nor a list, or to an entry of a list that
        does not exist.
    """
    data, lines = copy.deepcopy(data), dict(lines)
    for path, value in changes.items():
        at = location_of(path)
        inner = data
        for depth, step in enumerate(at[:-1]):
            inner = _entry(inner, step, path, at[:depth], at[depth + 1])
        if isinstance(inner, list):
            _index(inner, at[-1], path, at[:-1])
        elif not isinstance(inner, dict):
            raise _not_inside(path, at[:-1], inner)
        inner[at[-1]] = value
        lines = {where: line for where, line in lines.items() if where[: len(at)] != at}
    return data, lines


def misspelt(data: Any, path: str, changes: Changes) -> str:
    """Return a suggestion, ``; did you mean ...?``, for a key that a change adds; otherwise an empty string.

    ``data`` is the scenario without the changes. The suggested key is similar to the last key of ``path`` and
    is in the same mapping.
    """
    if not any(change == path or change.startswith((f"{path}.", f"{path}[")) for change in changes):
        return ""
    *above, last = location_of(path)
    for step in above:
        data = data.get(step) if isinstance(data, dict) else None
    if not isinstance(data, dict) or last in data:
        return ""
    near = nearest(str(last), data)
    return f"; did you mean {near!r}?" if near else ""


def _entry(inner: Any, step: str | int, path: str, at: Location, following: str | int) -> Any:
    """Return the entry ``step``, which is created if it is missing in a mapping."""
    if isinstance(inner, list):
        return inner[_index(inner, step, path, at)]
    if not isinstance(inner, dict) or isinstance(step, int):
        raise _not_inside(path, at, inner)
    if inner.get(step) is None:
        if isinstance(following, int):
            hint = did_you_mean(str(step), inner) or "; set the whole list"
            raise _invalid(path, f"the scenario has no list {dotted((*at, step))!r}{hint}")
        inner[step] = {}
    return inner[step]


def _index(inner: list[Any], step: str | int, path: str, at: Location) -> int:
    """Return the index of an entry of a list; raise InputError if there is no such entry."""
    if not isinstance(step, int) or step >= len(inner):
        if not inner:
            raise _invalid(path, f"{dotted(at)} is an empty list; set the whole list")
        what = f"{dotted(at) or 'the scenario'} is a list of length {len(inner)}"
        valid = "the index [0]" if len(inner) == 1 else f"an index from [0] to [{len(inner) - 1}]"
        raise _invalid(path, f"{what}; give {valid}")
    return step


def _not_inside(path: str, at: Location, inner: Any) -> InputError:
    where = dotted(at) or "the scenario"
    if at and at[-1] == "robot" and isinstance(inner, str):
        hint = "a campaign can vary robot.links and robot.joints, but a run takes them from the robot's file"
        return _invalid(path, f"{where} is {inner!r:.40}, which has no such entry; {hint}")
    if isinstance(inner, dict):
        return _invalid(path, f"{where} is a mapping, which has no indices{did_you_mean('', inner)}")
    return _invalid(path, f"{where} is {inner!r:.40}, which has no such entry; set {where} itself")


def _invalid(path: str, why: str) -> InputError:
    return InputError(f"cannot set {path!r}: {why}", name="set", got=path)
