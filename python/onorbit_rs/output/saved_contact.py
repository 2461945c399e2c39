"""Recorded distances and forces of a contact, read from a file or from a pickle."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs._core import COLUMNS

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import ContactTrace

    Floats = NDArray[np.float64]

_PART_OF = {"slip": "sliding_speed"}
"""Parts of the column whose attributes have another name."""


@dataclass(frozen=True, eq=False)
class SavedContact:
    """Contact with the attributes of :class:`onorbit_rs.ContactTrace`."""

    values: Floats
    """All quantities, (T, 19), in the order of ``onorbit_rs.COLUMNS["contacts"].parts``."""

    def __getattr__(self, name: str) -> Floats:
        """Return a quantity of the contact: (T,), or (T, 3) for a vector."""
        parts = COLUMNS["contacts"].parts
        wanted = _PART_OF.get(name, name)
        if name == "values" or wanted not in parts or name in _PART_OF.values():
            known = ", ".join([*(part for part in parts if part not in _PART_OF.values()), *_PART_OF])
            raise AttributeError(f"a contact has no attribute {name!r}; its quantities are {known}")
        entries, _ = parts[wanted]
        return self.values[:, entries.start] if entries.stop == entries.start + 1 else self.values[:, entries]

    def __len__(self) -> int:
        """Return the number of rows."""
        return len(self.values)


def reduced_contact(contact: ContactTrace) -> tuple[Any, ...]:
    """Return the class and argument that rebuild a contact from a pickle."""
    return SavedContact, (np.asarray(contact.values),)
