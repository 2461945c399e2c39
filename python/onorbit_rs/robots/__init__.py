"""Bundled robots, one URDF each, and those of others from their files."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from onorbit_rs import bundled

if TYPE_CHECKING:
    from onorbit_rs._core import Model

_FOLDER = Path(__file__).parent


def names() -> list[str]:
    """Names that :func:`load` and a scenario's ``robot`` take."""
    return bundled.names(_FOLDER, ".urdf")


def path(name: str) -> Path:
    """The URDF of a bundled robot.

    Raises
    ------
    NotFoundError
        No bundled robot has this name; suggests the nearest.
    """
    return bundled.path(name, "robot", _FOLDER, ".urdf")


def load(
    name: str | os.PathLike[str],
    *,
    package_paths: Sequence[str | os.PathLike[str]] | None = None,
    xacro_arguments: Mapping[str, object] | None = None,
    xacro: bool = False,
) -> Model:
    """A bundled robot, or one from a file; its root link floats.

    Parameters
    ----------
    name : str or path
        One of :func:`names`, or a URDF or xacro file: what has a folder or one of their endings.
    package_paths, xacro_arguments, xacro
        As for :meth:`onorbit_rs.Model.from_urdf`, for files.

    Raises
    ------
    NotFoundError
        No bundled robot has this name, or there is no such file.
    """
    from onorbit_rs._core import Model

    if not is_file(name):
        return Model.from_urdf(path(os.fspath(name)))
    return Model.from_urdf(name, package_paths=package_paths, xacro_arguments=xacro_arguments, xacro=xacro)


def is_file(name: str | os.PathLike[str]) -> bool:
    """Whether a robot is named by a path: ``arms/my_arm.urdf``, and not ``humanoid_torso``."""
    text = os.fspath(name)
    has_ending = text.lower().endswith((".urdf", ".xml", ".xacro"))
    return not isinstance(name, str) or has_ending or "/" in text or "\\" in text
