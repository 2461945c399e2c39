"""The trace of a run with several systems, read from a file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from onorbit_rs.exceptions import WorldError
from onorbit_rs.output.saved_trace import SavedTrace


def systems_in(arrays: Mapping[str, Any]) -> list[str]:
    """Return the names of the systems with a configuration among columns by path."""
    return [path.removesuffix("/q") for path in arrays if path.endswith("/q")]


@dataclass(frozen=True)
class SavedWorldTrace:
    """Columns by path, such as ``chaser/q`` and ``events/time``."""

    arrays: Mapping[str, Any]

    @property
    def names(self) -> list[str]:
        """Names of the systems."""
        return systems_in(self.arrays)

    def __getitem__(self, name: str) -> SavedTrace:
        """Return the columns of a system."""
        if name not in self.names:
            known = ", ".join(self.names)
            raise WorldError(f"there is no system {name!r}; the systems are: {known}", name=name)
        prefix = f"{name}/"
        return SavedTrace({path.removeprefix(prefix): values for path, values in self.arrays.items()
                           if path.startswith(prefix)})  # fmt: skip

    @property
    def time(self) -> Any:
        """Times of the rows that all systems share, (T,), s."""
        return self.arrays["time"]

    @property
    def momentum(self) -> Any:
        """Momentum of all systems, (T, 6), as that of :class:`onorbit_rs.WorldTrace`."""
        return self.arrays["momentum"]

    @property
    def events(self) -> dict[str, Any]:
        """Columns of the events, one row each, by name; the summary has the names of the events."""
        return {path.removeprefix("events/"): values for path, values in self.arrays.items()
                if path.startswith("events/")}  # fmt: skip
