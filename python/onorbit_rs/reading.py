"""Files that a user names: regular ones alone, read no further than they may be long."""

from __future__ import annotations

import os
import stat
from collections.abc import Callable
from pathlib import Path
from typing import BinaryIO

from onorbit_rs.exceptions import NotFoundError, ReadError
from onorbit_rs.files import open_to_read, read_bounded

LARGEST_TEXT = 16_000_000
"""Bytes of an element set, a scenario's resolved text or a robot."""

LARGEST_TABLE = 256_000_000
"""Bytes of a CSV: three million rows."""

LARGEST_MESH = 256_000_000
"""Bytes of a mesh: five million triangles of STL."""


def check_regular(path: str | os.PathLike[str], kind: str = "file") -> None:
    """Refuse what is no file on a disk: a device never ends, a pipe waits for ever.

    Raises
    ------
    NotFoundError, ReadError
        No such file; a folder, a pipe, a device, or no permission.
    """
    try:
        mode = Path(path).stat().st_mode
    except FileNotFoundError:
        raise NotFoundError(f"no such file: {path}", path=str(path), kind=kind) from None
    except (OSError, ValueError) as error:  # ValueError: a null character in the name
        raise _unreadable(path, str(getattr(error, "strerror", None) or error), kind) from None
    if stat.S_ISDIR(mode):
        raise ReadError(f"{path} is a folder, not a {kind}", path=str(path), kind=kind)
    if not stat.S_ISREG(mode):
        raise _unreadable(path, "a pipe or a device: save its content as a file", kind)


def read_bytes(path: str | os.PathLike[str], limit: int, kind: str = "file") -> bytes:
    """The content of a file of at most ``limit`` bytes.

    Raises
    ------
    NotFoundError, ReadError
        As :func:`check_regular`; larger than ``limit``.
    """
    return _read(path, kind, lambda stream: read_bounded(stream, limit))


def read_head(path: str | os.PathLike[str], most: int, kind: str = "file") -> bytes:
    """The first ``most`` bytes of a file, or all of it; raises as :func:`check_regular`."""
    return _read(path, kind, lambda stream: stream.read(most))


def _read(path: str | os.PathLike[str], kind: str, how: Callable[[BinaryIO], bytes]) -> bytes:
    check_regular(path, kind)
    try:
        with open_to_read(Path(path)) as stream:  # it may have become a pipe meanwhile
            return how(stream)
    except (OSError, ValueError) as error:  # ValueError: too large
        raise _unreadable(path, getattr(error, "strerror", None) or str(error), kind) from None


def read_text(path: str | os.PathLike[str], limit: int = LARGEST_TEXT, kind: str = "file") -> str:
    """The text of a UTF-8 file of at most ``limit`` bytes.

    Raises
    ------
    NotFoundError, ReadError
        As :func:`read_bytes`; not UTF-8.
    """
    try:
        return read_bytes(path, limit, kind).decode("utf-8-sig")
    except UnicodeDecodeError:
        raise _unreadable(path, "is no UTF-8 text", kind) from None


def _unreadable(path: str | os.PathLike[str], why: str, kind: str) -> ReadError:
    return ReadError(f"{path} cannot be read: {why}", path=str(path), kind=kind)
