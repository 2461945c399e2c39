"""A mapping in an OnOrbitROS file, the part of a scenario converted from it, and notes on its lines."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

from onorbit_rs.common.suggestions import nearest
from onorbit_rs.exceptions import OnOrbitError, QuantityError
from onorbit_rs.robots.wording import option
from onorbit_rs.scenario.locations import dotted, scenario_error
from onorbit_rs.scenario.yaml_lines import Lines, Location
from onorbit_rs.tools.interop.expressions import evaluate

Verdict = Literal["understood", "corrected", "no meaning"]


@dataclass(frozen=True)
class Note:
    """Note on the conversion of one line."""

    file: Path
    line: int | None
    key: str
    verdict: Verdict
    text: str

    def __str__(self) -> str:
        """Return the note as text, such as ``orbit.yaml:4: semi_major_axix: corrected: ...``."""
        where = f"{self.file}:{self.line}" if self.line else f"{self.file}"
        return f"{where}: {self.key}: {self.verdict}: {self.text}"


@dataclass
class Source:
    """Mapping in a file; conversions add to ``result``, ``comments`` and ``notes``."""

    file: Path
    lines: Lines
    at: Location
    data: dict[str, Any]
    keep_going: bool
    notes: list[Note]
    result: dict[str, Any] = field(default_factory=dict)
    comments: dict[Location, str] = field(default_factory=dict)

    def note(self, key: str, verdict: Verdict, text: str) -> None:
        """Add a note on the line of ``key``."""
        at = (*self.at, *key.split("/"))
        line = self.lines.get(at) or self.lines.get((*self.at, key)) or self.lines.get(self.at)
        self.notes.append(Note(self.file, line, key, verdict, text))

    def put(self, at: Location, value: Any, key: str) -> None:
        """Set the entry ``at`` of the scenario, with a comment that refers to the line of ``key``."""
        part = self.result
        for step in at[:-1]:
            part = part.setdefault(str(step), {})
        part[str(at[-1])] = value
        line = self.lines.get((*self.at, key))
        given = self.data.get(key, "not given")
        text = "" if isinstance(given, list) else f": {given}"
        self.comments[at] = f"{self.file.name}{f':{line}' if line else ''}: {key}{text}"

    def fail(self, key: str, message: str) -> OnOrbitError:
        """Return an error located at the line of ``key``."""
        at = (*self.at, key)
        return scenario_error(message, self.file, self.lines.get(at), dotted(at))

    def refuse_unknown(self, known: Sequence[str]) -> None:
        """Raise a ScenarioError for keys that are not ``known``; with ``keep_going``, add a note instead."""
        for key in self.data:
            if key in known:
                continue
            near = nearest(key, known)
            hint = f" (did you mean {near!r}?)" if near else f" (the keys here are {', '.join(known)})"
            if not self.keep_going:
                ignore = option("--keep-going", "keep_going=True")
                fix = f"correct or remove the key, or use {ignore} to ignore it"
                raise self.fail(key, f"{key!r} is not a key of OnOrbitROS{hint}; {fix}")
            self.note(key, "no meaning", f"not a key of OnOrbitROS{hint}")

    def number(self, key: str, default: float | None = None) -> float:
        """Return the value of ``key``, which may be arithmetic, or ``default`` if it is not given.

        Raises ScenarioError for any other value, or if neither is given.
        """
        if key not in self.data:
            if default is None:
                raise self.fail(key, "is missing; give a number, or arithmetic such as (60.0*pi)/180.0")
            return default
        try:
            return evaluate(self.data[key])
        except QuantityError as error:
            raise self.fail(key, str(error)) from None

    def inside(self, key: str, *, apart: bool = False) -> Source:
        """Return the mapping at ``key``; if ``apart`` is True, its conversion has a separate ``result``."""
        result: dict[str, Any] = {} if apart else self.result
        comments: dict[Location, str] = {} if apart else self.comments
        at = (*self.at, key)
        return Source(
            self.file, self.lines, at, self.data[key], self.keep_going, self.notes, result, comments
        )
