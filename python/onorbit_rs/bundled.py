"""Files that come with the package: which there are, and where one is."""

from __future__ import annotations

from pathlib import Path

from onorbit_rs.exceptions import NotFoundError
from onorbit_rs.names import did_you_mean, nearest


def names(folder: Path, ending: str) -> list[str]:
    """Files of this ending in a folder of the package, without it."""
    return sorted(file.stem for file in folder.glob(f"*{ending}"))


def path(name: str, kind: str, folder: Path, ending: str) -> Path:
    """One of them; ``kind`` is what they are.

    Raises
    ------
    NotFoundError
        None has this name; suggests the nearest.
    """
    known = names(folder, ending)
    if name not in known:
        message = f"no bundled {kind} is named {name!r}{did_you_mean(name, known)}"
        raise NotFoundError(message, path=name, kind=kind, suggestion=nearest(name, known))
    return folder / f"{name}{ending}"
