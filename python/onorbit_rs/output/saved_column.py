"""Recorded quantities of one contact or one closed loop, read from a file or from a pickle."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from onorbit_rs._core import COLUMNS

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import ContactTrace, LoopTrace

    Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class SavedColumn:
    """Column of several quantities, each of which is an attribute."""

    values: Floats
    """All quantities, one row per instant, in the order of the parts of the column."""

    column: ClassVar[str]
    """Name of the column in ``onorbit_rs.COLUMNS``."""
    noun: ClassVar[str]
    """Name of the owner in messages, with its article, such as ``a contact``."""
    renamed: ClassVar[dict[str, str]] = {}
    """Parts of the column whose attributes have another name, by the name of the attribute."""

    def __getattr__(self, name: str) -> Floats:
        """Return a quantity of the column: (T,), or (T, n) if it has n components."""
        parts = COLUMNS[self.column].parts
        attributes = {part: part for part in parts if part not in self.renamed.values()} | self.renamed
        if name not in attributes:
            known = ", ".join(attributes)
            raise AttributeError(f"{self.noun} has no attribute {name!r}; its quantities are {known}")
        entries, _ = parts[attributes[name]]
        return self.values[:, entries.start] if entries.stop == entries.start + 1 else self.values[:, entries]

    def __len__(self) -> int:
        """Return the number of rows."""
        return len(self.values)


class SavedContact(SavedColumn):
    """Contact with the attributes of :class:`onorbit_rs.ContactTrace`; its values are (T, 19)."""

    column = "contacts"
    noun = "a contact"
    renamed: ClassVar = {"slip": "sliding_speed"}


class SavedLoop(SavedColumn):
    """Closed loop with the attributes of :class:`onorbit_rs.LoopTrace`; its values are (T, 11)."""

    column = "loops"
    noun = "a loop"


def reduced_contact(contact: ContactTrace) -> tuple[Any, ...]:
    """Return the class and argument that rebuild a contact from a pickle."""
    return SavedContact, (np.asarray(contact.values),)


def reduced_loop(loop: LoopTrace) -> tuple[Any, ...]:
    """Return the class and argument that rebuild a loop from a pickle."""
    return SavedLoop, (np.asarray(loop.values),)
