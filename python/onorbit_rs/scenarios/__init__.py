"""Bundled scenarios: one YAML each."""

from __future__ import annotations

from pathlib import Path

from onorbit_rs.exceptions import NotFoundError
from onorbit_rs.names import did_you_mean, nearest

_FOLDER = Path(__file__).parent


def names() -> list[str]:
    """Names that ``onorbit run`` and :func:`onorbit_rs.run` take."""
    return sorted(file.stem for file in _FOLDER.glob("*.yaml"))


def path(name: str) -> Path:
    """The YAML of a bundled scenario; copy it to start your own.

    Raises
    ------
    NotFoundError
        No bundled scenario has this name; suggests the nearest.
    """
    if name not in names():
        message = f"no bundled scenario is named {name!r}{did_you_mean(name, names())}"
        raise NotFoundError(message, path=name, kind="scenario", suggestion=nearest(name, names()))
    return _FOLDER / f"{name}.yaml"
