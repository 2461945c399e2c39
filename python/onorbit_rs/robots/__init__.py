"""Loads bundled robots, each of which is one URDF file, and robots from user files."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from onorbit_rs.common.bundled_files import BundledFiles

if TYPE_CHECKING:
    from onorbit_rs._core import Model

_ROBOTS = BundledFiles("robot", Path(__file__).parent, ".urdf")


def names() -> list[str]:
    """Return the names of the bundled robots, for :func:`load` and the key ``robot`` of scenarios."""
    return _ROBOTS.names()


def path(name: str) -> Path:
    """Return the path of the URDF of a bundled robot.

    Raises
    ------
    NotFoundError
        If no bundled robot has this name; the message suggests a similar name, if there is one.
    """
    return _ROBOTS.path(name)


def load(
    name: str | os.PathLike[str],
    *,
    package_paths: Sequence[str | os.PathLike[str]] | None = None,
    xacro_arguments: dict[str, Any] | None = None,
    xacro: bool = False,
) -> Model:
    """Return a bundled robot or one from a file; its root link is free-floating.

    Parameters
    ----------
    name : str or path
        One of :func:`names`, or a URDF or xacro file; see :func:`is_file`.
    package_paths, xacro_arguments, xacro
        As in :meth:`onorbit_rs.Model.from_urdf`; ignored for bundled robots.

    Returns
    -------
    Model

    Raises
    ------
    NotFoundError
        If there is no such bundled robot or file.
    ReadError, ModelError
        If the file cannot be read, or does not describe a robot that can be simulated.
    """
    from onorbit_rs._core import Model

    if not is_file(name):
        return Model.from_urdf(path(os.fspath(name)))
    return Model.from_urdf(name, package_paths=package_paths, xacro_arguments=xacro_arguments, xacro=xacro)


def is_file(name: str | os.PathLike[str]) -> bool:
    """Return whether a robot is given by a path, such as ``arms/my_arm.urdf``, instead of a bundled name.

    A string is a path if it contains a folder or ends in ``.urdf``, ``.xml`` or ``.xacro``.
    """
    text = os.fspath(name)
    has_ending = text.lower().endswith((".urdf", ".xml", ".xacro"))
    return not isinstance(name, str) or has_ending or "/" in text or "\\" in text
