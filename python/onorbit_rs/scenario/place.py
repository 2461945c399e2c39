"""Where in a scenario something stands, in words."""

from __future__ import annotations

from pathlib import Path

from onorbit_rs.exceptions import ScenarioError


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
