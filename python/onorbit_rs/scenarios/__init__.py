"""Bundled scenarios: one YAML each."""

from __future__ import annotations

from pathlib import Path

from onorbit_rs import bundled

_FOLDER = Path(__file__).parent


def names() -> list[str]:
    """Names that ``onorbit run`` and :func:`onorbit_rs.run` take."""
    return bundled.names(_FOLDER, ".yaml")


def path(name: str) -> Path:
    """The YAML of a bundled scenario; copy it to start your own.

    Raises
    ------
    NotFoundError
        No bundled scenario has this name; suggests the nearest.
    """
    return bundled.path(name, "scenario", _FOLDER, ".yaml")
