"""Writes a scenario as YAML text with a comment on each entry."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from onorbit_rs.common.printable import json_text

_COLUMN = 44


def scenario_text(
    scenario: Mapping[str, Any], comments: Mapping[tuple[str | int, ...], str], head: str
) -> str:
    """Return a scenario as YAML text.

    Parameters
    ----------
    scenario : mapping
        Mappings and lists of mappings become indented blocks, other values are JSON on one line.
    comments : mapping
        Comment of each entry, by its location.
    head : str
        Comment at the top of the text.
    """
    lines = [f"# {line}".rstrip() for line in head.splitlines()]
    return "\n".join([*lines, "", *_lines(scenario, comments, ())]) + "\n"


def _lines(part: Mapping[str, Any], comments: Mapping[Any, str], at: tuple[str | int, ...]) -> Iterator[str]:
    indent = "  " * len(at)
    for key, value in part.items():
        here = (*at, key)
        if not at and isinstance(value, list) and all(isinstance(entry, dict) for entry in value):
            yield f"{key}:"
            for index, entry in enumerate(value):
                first, *rest = _lines(entry, comments, (*here, index))
                yield from ("  - " + first.removeprefix("    "), *rest)
            continue
        is_nested = isinstance(value, dict) and not at
        # JSON is YAML 1.2, in which 1e-05 needs no dot
        start = f"{indent}{key}:" if is_nested else f"{indent}{key}: {json_text(value)}"
        comment = " ".join(comments.get(here, "").split())
        yield f"{start:<{_COLUMN - 1}} # {comment}" if comment else start
        if is_nested:
            yield from _lines(value, comments, here)
