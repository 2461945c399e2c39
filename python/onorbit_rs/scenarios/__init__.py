"""Bundled scenarios: one YAML each."""

from __future__ import annotations

from pathlib import Path

_FOLDER = Path(__file__).parent


def names() -> list[str]:
    """Names that ``onorbit run`` and :func:`onorbit_rs.run` take."""
    return sorted(file.stem for file in _FOLDER.glob("*.yaml"))


def path(name: str) -> Path:
    """The YAML of a bundled scenario; copy it to start your own."""
    return _FOLDER / f"{name}.yaml"
