"""Reads YAML files as plain data, with the line of every entry for error messages.

Numbers and booleans follow YAML 1.2: ``1e-3`` is a number, ``on`` and ``12:30`` are text.
"""

from __future__ import annotations

import re
from contextlib import suppress
from pathlib import Path
from typing import Any

import yaml

from onorbit_rs.common.input_files import read_head
from onorbit_rs.exceptions import ScenarioError
from onorbit_rs.scenario.locations import scenario_error

Location = tuple[str | int, ...]
"""Keys and indices from the top of the file, as in ``("environment", 0, "force")``."""

Lines = dict[Location, int]
"""Line of every entry, starting at 1."""

MAX_BYTES = 4_000_000
MAX_NODES = 200_000


class _Loader(yaml.SafeLoader):
    """SafeLoader with the scalars of YAML 1.2."""


_Loader.yaml_implicit_resolvers = {}  # without the resolvers of YAML 1.1

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
    """Return the data of a YAML file and the line of each entry.

    Raises
    ------
    NotFoundError, ReadError
        If the file does not exist, is a folder, a pipe or a device, or is not readable.
    ScenarioError
        If the file is binary, too large, not UTF-8 or not YAML; the error has the attributes ``file``
        and ``line``.
    """
    return parse_yaml(_read_text(path), path)


def parse_yaml(text: str, file: Path | None) -> tuple[Any, Lines]:
    """Return the data of a YAML text and the line of each entry, or raise ScenarioError.

    Error messages start with the name of ``file``.
    """
    reader = _NodeReader(file)
    try:
        with suppress(
            RecursionError
        ):  # so that it is not the context of the error below, which programs may pickle
            loader = _Loader(text)
            root = loader.get_single_node()
            data = reader.value(loader, root, ()) if root is not None else None
            return data, reader.lines
    except yaml.YAMLError as error:
        raise _syntax_error(error, file) from None
    message = "lists and mappings are nested too deeply; a scenario requires fewer than ten levels"
    raise _at(file, None, message)


class _NodeReader:
    """Converts nodes to data and stores their lines; limits the number of nodes, which aliases multiply."""

    def __init__(self, file: Path | None) -> None:
        self.file = file
        self.lines: Lines = {}
        self.nodes = 0

    def value(self, loader: _Loader, node: yaml.Node, at: Location) -> Any:
        line = node.start_mark.line + 1
        self.lines.setdefault(at, line)
        self.nodes += 1
        if self.nodes > MAX_NODES:
            raise _at(
                self.file,
                line,
                f"the file has more than {MAX_NODES} entries, including those of aliases; remove "
                "some entries",
            )
        if isinstance(node, yaml.MappingNode):
            return self._mapping(loader, node, at)
        if isinstance(node, yaml.SequenceNode):
            return [self.value(loader, entry, (*at, index)) for index, entry in enumerate(node.value)]
        try:
            return loader.construct_object(node)
        except ValueError as error:  # an integer with thousands of digits
            digits = len(node.value)
            message = f"an integer has {digits} digits, which is too many; write it with an exponent"
            raise _at(self.file, line, message) from error

    def _mapping(self, loader: _Loader, node: yaml.MappingNode, at: Location) -> dict[Any, Any]:
        data: dict[Any, Any] = {}
        key_lines: dict[Any, int] = {}
        for key_node, value_node in node.value:
            line = key_node.start_mark.line + 1
            key = loader.construct_object(key_node) if isinstance(key_node, yaml.ScalarNode) else None
            if not isinstance(key, str):
                is_scalar = isinstance(key_node, yaml.ScalarNode)
                what = f"{key_node.value or 'null'}; put it in quotes" if is_scalar else "a list or mapping"
                raise _at(self.file, line, f"a key must be text, not {what}")
            if key == "<<":
                raise _at(
                    self.file,
                    line,
                    "merging keys with '<<' is not supported; use an alias for a section, or write the keys",
                )
            if key in key_lines:
                first = key_lines[key]
                message = f"key {key!r} is given twice, first on line {first}; remove one of them"
                raise _at(self.file, line, message)
            key_lines[key] = line
            self.lines[(*at, key)] = line
            data[key] = self.value(loader, value_node, (*at, key))
        return data


def _read_text(path: Path) -> str:
    raw = read_head(path, MAX_BYTES + 1, "scenario")
    if len(raw) > MAX_BYTES:
        raise _at(
            path,
            None,
            f"the file is larger than {MAX_BYTES} bytes, the limit for a YAML file; "
            "move tables of numbers into CSV files",
        )
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = raw.count(b"\n", 0, error.start) + 1
        raise _at(path, line, "the file is not UTF-8 text; give a YAML file saved as UTF-8") from None
    if "\0" in text:
        raise _at(
            path,
            text.count("\n", 0, text.index("\0")) + 1,
            "the file contains a null character, so it is binary; give a YAML file",
        )
    return text


def _syntax_error(error: yaml.YAMLError, file: Path | None) -> ScenarioError:
    mark = getattr(error, "problem_mark", None) or getattr(error, "context_mark", None)
    problem = getattr(error, "problem", None) or getattr(error, "reason", None) or "cannot be read"
    line = None if mark is None else mark.line + 1
    reason = " ".join(str(problem).split())
    fix = next((words for part, words in _FIXES.items() if part in reason), None)
    return _at(file, line, f"invalid YAML: {reason}{f'; {fix}' if fix else ''}")


_FIXES = {
    r"'\t'": "indent with spaces instead of tabs",
    "mapping values are not allowed": "is a ':' missing above, or is a line indented too far?",
    "could not find expected ':'": "write ':' and a space after a key",
    "expected <block end>": "does the indentation of this line differ from that of the adjacent lines?",
    "expected ',' or": "is a bracket or brace not closed?",
    "unexpected end of stream": "is a quote not closed?",
    "cannot start any token": "put text that starts with such a character in quotes",
    "another document": "a file contains one scenario",
    "constructor for the tag": "tags ('!') are not supported",
    "undefined alias": "define the alias with '&' above this line",
}
"""Likely fixes of errors reported by PyYAML."""


def _at(file: Path | None, line: int | None, message: str) -> ScenarioError:
    return scenario_error(message, file, line)


def line_of(at: Location, lines: Lines) -> int | None:
    """Return the line of an entry, or of the nearest entry that contains it; None for the whole file."""
    return next((lines[at[:end]] for end in range(len(at), 0, -1) if at[:end] in lines), None)
