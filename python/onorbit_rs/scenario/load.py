"""From a name, a file or a mapping to a checked :class:`Scenario`; complaints say file, line and place."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from onorbit_rs import scenarios
from onorbit_rs.exceptions import DtypeError, NotFoundError
from onorbit_rs.names import did_you_mean
from onorbit_rs.scenario.complaints import first_complaint
from onorbit_rs.scenario.place import scenario_error
from onorbit_rs.scenario.schema import Scenario
from onorbit_rs.scenario.yaml_lines import Lines, read_yaml


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
    DtypeError
        Nothing that names or holds a scenario.
    ScenarioError
        Broken, misspelt or senseless; carries ``file``, ``path`` (the place in the YAML) and ``line``.
    """
    if isinstance(source, Scenario):
        return source
    if isinstance(source, Mapping):
        return check(dict(source), None, {})
    if not isinstance(source, (str, os.PathLike)):
        kind = type(source).__name__
        raise DtypeError(
            f"{source!s:.60} ({kind}) is no scenario: give a bundled name, a YAML file, a mapping or a "
            "Scenario",
            name="scenario", got=kind, expected="str, path, mapping or Scenario",
        )  # fmt: skip
    file = locate(source)
    data, lines = read_yaml(file)
    return check(data, file, lines)


def locate(source: str | os.PathLike[str]) -> Path:
    """The YAML file of a bundled name or a path; a file of that name in the working folder wins."""
    if not os.fspath(source):
        raise NotFoundError("no scenario is named: the name is empty", path="", kind="scenario")
    path = Path(source)
    if path.is_file() or (path.exists() and path.name not in scenarios.names()):
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
        message = (
            f"a scenario is a mapping of keys to values, this is {what}; onorbit new writes one to start from"
        )
        raise scenario_error(message, file, None)
    try:
        scenario = Scenario.checked(data)
    except ValidationError as error:
        raise first_complaint(error, data, file, lines) from None
    scenario.remember_source(file, lines)
    if file is not None and "name" not in data:
        scenario.name = file.stem
    return scenario
