"""Locations in a scenario, as written in messages."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from onorbit_rs.exceptions import OnOrbitError, ScenarioError

if TYPE_CHECKING:
    from onorbit_rs.scenario.document import Document


class Spot(NamedTuple):
    """Entry of a scenario to which an error refers."""

    file: str | None
    path: str | None
    line: int | None


def dotted(at: tuple[str | int, ...]) -> str:
    """Return a location as text, such as ``environment[0].force``."""
    return "".join(f"[{step}]" if isinstance(step, int) else f".{step}" for step in at).removeprefix(".")


def file_and_line(file: Path | None, line: int | None) -> str:
    """Return the file and the line, as in ``mine.yaml:11``; ``scenario`` for a scenario made in Python."""
    return f"{file or 'scenario'}" + (f":{line}" if line else "")


def scenario_error(message: str, file: Path | None, line: int | None, path: str = "") -> ScenarioError:
    """Return an error whose message starts with its location."""
    where = f"{file_and_line(file, line)}: {path}: " if path else f"{file_and_line(file, line)}: "
    return ScenarioError(where + message, file=str(file) if file else None, path=path or None, line=line)


@contextmanager
def located(scenario: Document, *at: str | int) -> Iterator[None]:
    """Add file, line and key to the message of an :class:`OnOrbitError` raised in the block."""
    try:
        yield
    except OnOrbitError as error:
        if getattr(error, "located", False):
            raise
        line, path = scenario.line_of(*at), dotted(scenario.location(*at))
        error.message = f"{file_and_line(scenario.file, line)}: {path}: {error.message}"
        file = str(scenario.file) if scenario.file else None
        error.located = Spot(file, path, line)  # type: ignore[attr-defined]  # inner blocks are more specific
        raise


def spot_of(error: OnOrbitError) -> Spot:
    """Return the entry of a scenario that caused an error; unknown fields have the value None."""
    if isinstance(error, ScenarioError):
        return Spot(error.file, error.path, error.line)
    spot: Spot = getattr(error, "located", None) or Spot(None, None, None)
    return spot


@contextmanager
def located_warnings(scenario: Document, *at: str | int) -> Iterator[None]:
    """Issue the warnings of the block after its end, with file, line and key in front of their messages."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        yield
    where = f"{file_and_line(scenario.file, scenario.line_of(*at))}: {dotted(scenario.location(*at))}"
    for warning in caught:
        warnings.warn(f"{where}: {warning.message}", warning.category, stacklevel=3)
