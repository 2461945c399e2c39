"""Bundled scenarios, one YAML file each."""

from __future__ import annotations

from pathlib import Path

from onorbit_rs.common.bundled_files import BundledFiles

SCENARIOS = BundledFiles("scenario", Path(__file__).parent, ".yaml")
"""Scenarios for ``onorbit run`` and :func:`onorbit_rs.run`."""


def names() -> list[str]:
    """Return the names of the bundled scenarios, for ``onorbit run`` and :func:`onorbit_rs.run`."""
    return SCENARIOS.names()


def files_of(name: str) -> list[Path]:
    """Return the Python files of the package that a bundled scenario uses.

    Raises
    ------
    NotFoundError
        As for :func:`path`.
    """
    text = path(name).read_text(encoding="utf-8")
    return [file for file in sorted(SCENARIOS.folder.glob("*.py")) if f"file: {file.name}" in text]


def path(name: str) -> Path:
    """Return the path of the YAML file of a bundled scenario.

    Raises
    ------
    NotFoundError
        If no bundled scenario has this name; the message suggests a similar name, if there is one.
    """
    return SCENARIOS.path(name)
