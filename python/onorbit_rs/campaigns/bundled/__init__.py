"""Bundled campaigns, one YAML file each."""

from __future__ import annotations

from pathlib import Path

from onorbit_rs.common import bundled_files

_FOLDER = Path(__file__).parent


def names() -> list[str]:
    """Return the names of the bundled campaigns, for ``onorbit campaign`` and :func:`onorbit_rs.campaign`."""
    return bundled_files.names(_FOLDER, ".yaml")


def path(name: str) -> Path:
    """Return the path of the YAML file of a bundled campaign.

    Raises
    ------
    NotFoundError
        If no bundled campaign has this name; the message suggests the nearest name.
    """
    return bundled_files.path(name, "campaign", _FOLDER, ".yaml")
