"""A YAML file as plain data, with the line of every entry, so that an error can point at it.

Numbers and booleans follow YAML 1.2: ``1e-3`` is a number, ``on`` is text, ``12:30`` is not 750.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import yaml

from onorbit_rs.exceptions import ScenarioError
from onorbit_rs.reading import read_head
from onorbit_rs.scenario.place import scenario_error

Location = tuple[str | int, ...]
"""Keys and indices from the top of the file, as in ``("environment", 0, "force")``."""

Lines = dict[Location, int]
"""Line, from 1, of every entry."""

MAX_BYTES = 4_000_000
MAX_NODES = 200_000


class _Loader(yaml.SafeLoader):
    """SafeLoader with the scalars of YAML 1.2."""


_Loader.yaml_implicit_resolvers = {}  # none of YAML 1.1's


for _tag, _pattern, _first in [
    ("tag:yaml.org,2002:null", r"^(?:~|null|Null|NULL|)$", ["~", "n", "N", ""]),
    ("tag:yaml.org,2002:bool", r"^(?:true|True|TRUE|false|False|FALSE)$", list("tTfF")),
    ("tag:yaml.org,2002:int", r"^[-+]?[0-9]+$", list("-+0123456789")),
    (
        "tag:yaml.org,2002:float",
        r"^[-+]?(?:\.[0-9]+|[0-9]+(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?$",
        list("-+.0123456789"),
    ),
    ("tag:yaml.org,2002:float", r"^(?:[-+]?\.(?:inf|Inf|INF)|\.(?:nan|NaN|NAN))$", list("-+.")),
]:
    _Loader.add_implicit_resolver(_tag, re.compile(_pattern), _first)


def read_yaml(path: Path) -> tuple[Any, Lines]:
    """Data of a YAML file and the line of each entry.

    Raises
    ------
    NotFoundError, ReadError
        No such file; a folder, a pipe, a device or no permission.
    ScenarioError
        Binary, too large, not UTF-8 or not YAML; carries ``file`` and ``line``.
    """
    return parse_yaml(_read_text(path), path)


def parse_yaml(text: str, file: Path | None) -> tuple[Any, Lines]:
    """Data of a YAML text and the line of each entry; ``file`` is for messages."""
    walk = _Walk(file)
    try:
        loader = _Loader(text)
        root = loader.get_single_node()
        data = walk.value(loader, root, ()) if root is not None else None
    except yaml.YAMLError as error:
        raise _syntax_error(error, file) from None
    except RecursionError:
        raise _at(file, None, "the YAML is nested too deeply") from None
    return data, walk.lines


class _Walk:
    """Turns nodes into data and remembers their lines; aliases count every time, so a bomb is caught."""

    def __init__(self, file: Path | None) -> None:
        self.file = file
        self.lines: Lines = {}
        self.nodes = 0

    def value(self, loader: _Loader, node: yaml.Node, at: Location) -> Any:
        line = node.start_mark.line + 1
        self.lines.setdefault(at, line)
        self.nodes += 1
        if self.nodes > MAX_NODES:
            raise _at(self.file, line, f"more than {MAX_NODES} entries (aliases counted): not a scenario")
        if isinstance(node, yaml.MappingNode):
            return self._mapping(loader, node, at)
        if isinstance(node, yaml.SequenceNode):
            return [self.value(loader, entry, (*at, index)) for index, entry in enumerate(node.value)]
        try:
            return loader.construct_object(node)
        except ValueError as error:  # an integer of thousands of digits
            raise _at(self.file, line, str(error)) from None

    def _mapping(self, loader: _Loader, node: yaml.MappingNode, at: Location) -> dict[Any, Any]:
        data: dict[Any, Any] = {}
        own: dict[Any, int] = {}
        for key_node, value_node in node.value:
            line = key_node.start_mark.line + 1
            key = loader.construct_object(key_node) if isinstance(key_node, yaml.ScalarNode) else None
            if not isinstance(key, str):
                what = "a list or mapping" if key is None else f"{key!r}: put it in quotes"
                raise _at(self.file, line, f"a key must be text, not {what}")
            if key == "<<":
                raise _at(
                    self.file,
                    line,
                    "keys are not merged by '<<': name a whole part by its anchor, or write it out",
                )
            if key in own:
                raise _at(self.file, line, f"the key {key!r} is given twice, first on line {own[key]}")
            own[key] = line
            self.lines[(*at, key)] = line
            data[key] = self.value(loader, value_node, (*at, key))
        return data


def _read_text(path: Path) -> str:
    raw = read_head(path, MAX_BYTES + 1, "scenario")
    if len(raw) > MAX_BYTES:
        raise _at(path, None, f"larger than {MAX_BYTES} bytes: not a scenario")
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = raw.count(b"\n", 0, error.start) + 1
        raise _at(path, line, "not text in UTF-8 (binary?); a scenario is a YAML file") from None
    if "\0" in text:
        raise _at(
            path, text.count("\n", 0, text.index("\0")) + 1, "binary, not text; a scenario is a YAML file"
        )
    return text


def _syntax_error(error: yaml.YAMLError, file: Path | None) -> ScenarioError:
    mark = getattr(error, "problem_mark", None) or getattr(error, "context_mark", None)
    problem = getattr(error, "problem", None) or getattr(error, "reason", None) or "cannot be read"
    line = None if mark is None else mark.line + 1
    told = " ".join(str(problem).split())
    way_out = next((words for part, words in _WAYS_OUT.items() if part in told), None)
    return _at(file, line, f"broken YAML, {told}{f': {way_out}' if way_out else ''}")


_WAYS_OUT = {
    r"'\t'": "indent with spaces, not with tabs",
    "mapping values are not allowed": "is a ':' missing above, or a line further in than the one before it?",
    "could not find expected ':'": "a key is followed by ':' and a space",
    "expected <block end>": "is this line further in, or less far, than its neighbours?",
    "expected ',' or": "is a bracket or brace left open?",
    "unexpected end of stream": "is a quote left open?",
    "cannot start any token": "text that begins with such a character wants quotes",
    "another document": "a file holds one scenario",
    "constructor for the tag": "values are plain, without '!'",
    "undefined alias": "its '&' must stand above it",
}
"""What is likely meant by what PyYAML says."""


def _at(file: Path | None, line: int | None, message: str) -> ScenarioError:
    return scenario_error(message, file, line)


def line_of(at: Location, lines: Lines) -> int | None:
    """Of an entry, or of the nearest entry around it; the whole file is none."""
    return next((lines[at[:end]] for end in range(len(at), 0, -1) if at[:end] in lines), None)
