"""Limit on the nesting of elements, macros and includes in a xacro file, below Python's recursion limit."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

_MOST_FRAMES = 700
"""Largest number of nested calls for a file; Python allows 1000, including those of the caller."""
_ELEMENT, _MACRO, _INCLUDE = 2, 3, 4
"""Numbers of nested calls for an element, and in addition for a macro call and for an include."""

HINT = "check for a macro that calls itself or a file that includes itself"
TOO_DEEP = f"macros, includes or elements are nested too deeply; {HINT}"


class NestingError(RecursionError):
    """Raised if a file is nested too deeply; the message names the macro or the included file, if any."""


class Nesting:
    """Counts the nested calls of one expansion."""

    def __init__(self) -> None:
        """Start with no nested call."""
        self._frames = 0
        self._names: list[str] = []

    @contextmanager
    def element(self) -> Iterator[None]:
        """Count an element during the block; raise NestingError at the limit."""
        self._frames += _ELEMENT
        try:
            self._check()
            yield
        finally:
            self._frames -= _ELEMENT

    @contextmanager
    def macro(self, name: str) -> Iterator[None]:
        """Count a macro call during the block; raise NestingError at the limit."""
        with self._named(f"the macro {name!r}", _MACRO):
            yield

    @contextmanager
    def include(self, name: str) -> Iterator[None]:
        """Count an include during the block; raise NestingError at the limit."""
        with self._named(f"the file {name!r}", _INCLUDE):
            yield

    @contextmanager
    def _named(self, name: str, frames: int) -> Iterator[None]:
        self._frames += frames
        self._names.append(name)
        try:
            self._check()
            yield
        finally:
            self._frames -= frames
            self._names.pop()

    def _check(self) -> None:
        if self._frames <= _MOST_FRAMES:
            return
        if not self._names:
            raise NestingError(TOO_DEEP)
        name, times = self._names[-1], self._names.count(self._names[-1])
        place = f"{name} contains itself on {times} levels" if times > 1 else f"in {name}"
        raise NestingError(f"macros, includes or elements are nested too deeply: {place}; {HINT}")


def check_depth(document: Any) -> None:
    """Raise NestingError if the elements of a parsed document are nested too deeply."""
    level, depth = [document.documentElement], 0
    while level:
        depth += 1
        if depth * _ELEMENT > _MOST_FRAMES:
            raise NestingError("elements are nested too deeply; reduce their depth")
        level = [child for node in level for child in node.childNodes if child.nodeType == child.ELEMENT_NODE]
