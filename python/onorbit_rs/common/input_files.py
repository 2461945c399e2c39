"""Reads regular files given by the user, up to a size limit."""

from __future__ import annotations

import os
import stat
from collections.abc import Callable
from pathlib import Path
from typing import BinaryIO

from onorbit_rs.common.files import open_to_read, read_bounded
from onorbit_rs.exceptions import NotFoundError, ReadError

LARGEST_TEXT = 16_000_000
"""Size limit of an element set, a resolved scenario or a robot, bytes."""

LARGEST_TABLE = 256_000_000
"""Size limit of a CSV file, bytes; corresponds to about three million rows."""

LARGEST_MESH = 256_000_000
"""Size limit of a mesh, bytes; corresponds to about five million triangles in STL."""


def check_regular(path: str | os.PathLike[str], kind: str = "file") -> None:
    """Check that a path is a regular file, since reading a device may never end and a pipe may block.

    Parameters
    ----------
    path : path
        Path of the file.
    kind : str
        Kind of the file, for messages.

    Raises
    ------
    NotFoundError, ReadError
        If there is no such file, or it is a folder, a pipe, a device or not accessible.
    """
    try:
        mode = Path(path).stat().st_mode
    except FileNotFoundError:
        raise NotFoundError(f"no such file: {path}; check the path", path=str(path), kind=kind) from None
    except (OSError, ValueError) as error:  # ValueError: a null character in the name
        raise _unreadable(path, str(getattr(error, "strerror", None) or error), kind) from None
    if stat.S_ISDIR(mode):
        raise ReadError(
            f"{path} is a folder; give the path of a file{'' if kind == 'file' else f' ({kind})'}",
            path=str(path),
            kind=kind,
        )
    if not stat.S_ISREG(mode):
        raise _unreadable(path, "it is a pipe or a device; save its content as a file", kind)


def read_bytes(path: str | os.PathLike[str], limit: int, kind: str = "file") -> bytes:
    """Return the content of a file.

    Parameters
    ----------
    path : path
        Path of the file.
    limit : int
        Size limit, bytes.
    kind : str
        Kind of the file, for messages.

    Raises
    ------
    NotFoundError, ReadError
        As for :func:`check_regular`, or if the file is larger than ``limit``.
    """
    return _read(path, kind, lambda stream: read_bounded(stream, limit))


def read_head(path: str | os.PathLike[str], most: int, kind: str = "file") -> bytes:
    """Return up to ``most`` bytes from the start of a file; errors are those of :func:`check_regular`."""
    return _read(path, kind, lambda stream: stream.read(most))


def _read(path: str | os.PathLike[str], kind: str, how: Callable[[BinaryIO], bytes]) -> bytes:
    check_regular(path, kind)
    try:
        with open_to_read(Path(path)) as stream:  # raises an error if the file has become a pipe since
            return how(stream)
    except (OSError, ValueError) as error:  # ValueError: too large
        raise _unreadable(path, getattr(error, "strerror", None) or str(error), kind) from None


def read_text(path: str | os.PathLike[str], limit: int = LARGEST_TEXT, kind: str = "file") -> str:
    """Return the text of a UTF-8 file.

    Parameters
    ----------
    path : path
        Path of the file.
    limit : int
        Size limit, bytes.
    kind : str
        Kind of the file, for messages.

    Raises
    ------
    NotFoundError, ReadError
        As for :func:`read_bytes`, or if the file is not UTF-8.
    """
    try:
        return read_bytes(path, limit, kind).decode("utf-8-sig")
    except UnicodeDecodeError:
        raise _unreadable(path, "it is not UTF-8 text; save it as UTF-8", kind) from None


def _unreadable(path: str | os.PathLike[str], why: str, kind: str) -> ReadError:
    return ReadError(f"{path} cannot be read: {why}", path=str(path), kind=kind)
