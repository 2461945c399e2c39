"""Where in a scenario something stands, in words."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from onorbit_rs.exceptions import OnOrbitError, ScenarioError

if TYPE_CHECKING:
    from onorbit_rs.scenario.schema import Scenario


def dotted(at: tuple[str | int, ...]) -> str:
    """``environment[0].force``."""
    return "".join(f"[{step}]" if isinstance(step, int) else f".{step}" for step in at).removeprefix(".")


def file_and_line(file: Path | None, line: int | None) -> str:
    """``mine.yaml:11``; ``scenario`` for one made in Python."""
    return f"{file or 'scenario'}" + (f":{line}" if line else "")


def scenario_error(message: str, file: Path | None, line: int | None, path: str = "") -> ScenarioError:
    """An error with its place before the message."""
    where = f"{file_and_line(file, line)}: {path}: " if path else f"{file_and_line(file, line)}: "
    return ScenarioError(where + message, file=str(file) if file else None, path=path or None, line=line)


@contextmanager
def located(scenario: Scenario, *at: str | int) -> Iterator[None]:
    """Put file, line and place before the message of an error of ours; its class stays."""
    try:
        yield
    except OnOrbitError as error:
        if getattr(error, "located", False):
            raise
        where = file_and_line(scenario.file, scenario.line_of(*at))
        error.message = f"{where}: {dotted(at)}: {error.message}"
        error.located = True  # type: ignore[attr-defined]  # set once, read above
        raise
