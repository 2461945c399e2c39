"""Collects the errors of independent parts of a scenario, which are then raised together."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from onorbit_rs.exceptions import OnOrbitError
from onorbit_rs.scenario.validation_errors import combined


class Faults:
    """Errors of the parts that were checked so far; true if there are any."""

    def __init__(self) -> None:
        """Start without errors."""
        self.errors: list[OnOrbitError] = []

    def __bool__(self) -> bool:
        """Return True if an error was kept."""
        return bool(self.errors)

    @contextmanager
    def kept(self) -> Iterator[None]:
        """Keep an :class:`OnOrbitError` that is raised in the block, and continue after the block."""
        try:
            yield
        except OnOrbitError as error:
            self.errors.append(error)

    def check(self) -> None:
        """Raise the kept errors: one unchanged, several as one ScenarioError."""
        if self.errors:
            raise combined(self.errors)
