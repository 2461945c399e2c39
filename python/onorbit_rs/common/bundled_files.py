"""Names and paths of the files that are part of the package."""

from __future__ import annotations

from pathlib import Path

from onorbit_rs.common.suggestions import did_you_mean, nearest
from onorbit_rs.exceptions import NotFoundError


def names(folder: Path, ending: str) -> list[str]:
    """Return the sorted names, without ``ending``, of the files in ``folder`` that end in ``ending``."""
    return sorted(file.stem for file in folder.glob(f"*{ending}"))


def path(name: str, kind: str, folder: Path, ending: str) -> Path:
    """Return the path of a bundled file.

    Parameters
    ----------
    name : str
        Name without its ending.
    kind : str
        Kind of the file, such as ``robot``, for messages.
    folder : path
        Folder of the package that contains the files.
    ending : str
        Ending of the file names, such as ``.yaml``.

    Raises
    ------
    NotFoundError
        If there is no such file; suggests the nearest name.
    """
    known = names(folder, ending)
    if name not in known:
        hint = did_you_mean(name, known) or "; onorbit list prints the names"
        message = f"no bundled {kind} is named {name!r}{hint}"
        raise NotFoundError(message, path=name, kind=kind, suggestion=nearest(name, known))
    return folder / f"{name}{ending}"
