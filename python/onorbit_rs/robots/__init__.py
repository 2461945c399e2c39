"""Bundled robots: one URDF each."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from onorbit_rs.exceptions import NotFoundError
from onorbit_rs.names import did_you_mean, nearest

if TYPE_CHECKING:
    from onorbit_rs._core import Model

_FOLDER = Path(__file__).parent


def names() -> list[str]:
    """Names that :func:`load` and a scenario's ``robot`` take."""
    return sorted(file.stem for file in _FOLDER.glob("*.urdf"))


def path(name: str) -> Path:
    """The URDF of a bundled robot.

    Raises
    ------
    NotFoundError
        No bundled robot has this name; suggests the nearest.
    """
    if name not in names():
        message = f"no bundled robot is named {name!r}{did_you_mean(name, names())}"
        raise NotFoundError(message, path=name, kind="robot", suggestion=nearest(name, names()))
    return _FOLDER / f"{name}.urdf"


def load(name: str) -> Model:
    """A bundled robot; its root link floats.

    Parameters
    ----------
    name : str
        One of :func:`names`.

    Raises
    ------
    NotFoundError
        No bundled robot has this name.
    """
    from onorbit_rs._core import Model

    return Model.from_urdf(path(name))
