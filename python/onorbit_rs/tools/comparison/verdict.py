"""Names, tolerance and verdict of a comparison of two runs."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeVar

from onorbit_rs.exceptions import CompareError

Entry = TypeVar("Entry")


@dataclass(frozen=True)
class Verdict(ABC):
    """Whether run ``b`` agrees with run ``a`` within a tolerance; ``a`` and ``b`` are their names."""

    a: str
    b: str
    tolerance: float

    @property
    @abstractmethod
    def parts_at(self) -> float | None:
        """First time at which a quantity exceeds its tolerance, s; None if the runs agree."""

    @property
    def agrees(self) -> bool:
        """True if no quantity exceeds the tolerance at any time."""
        return self.parts_at is None

    def as_dict(self) -> dict[str, Any]:
        """Return the verdict as plain data."""
        names = ("a", "b", "tolerance", "agrees", "parts_at")
        return {name: getattr(self, name) for name in names}


def entry(entries: Mapping[str, Entry], name: str, kind: str) -> Entry:
    """Return the entry with a name; ``kind`` describes the entries in messages.

    Raises
    ------
    CompareError
        If no entry has this name; the message lists the known names.
    """
    if name not in entries:
        known = ", ".join(entries)
        raise CompareError(f"{name!r} is not a {kind}; available: {known}", name=name, expected=known)
    return entries[name]
