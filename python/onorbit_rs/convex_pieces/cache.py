"""Cache of convex pieces on disk, one file per mesh and options.

A file holds an array and its checksum, so that damage is detected and the pieces are computed again.
Files are replaced atomically, so two processes can write the same file. Without write access, nothing is
cached.
"""

from __future__ import annotations

import hashlib
import io
import os
import sys
import tempfile
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

CHECKSUM = 32
"""Length of the checksum, bytes."""


def folder() -> Path | None:
    """Return the folder of the cache in the user's folder for caches; None without such a folder."""
    variable = {"win32": "LOCALAPPDATA"}.get(sys.platform, "XDG_CACHE_HOME")
    usual = "Library/Caches" if sys.platform == "darwin" else ".cache"
    try:
        base = Path(os.environ.get(variable) or Path.home() / usual)
    except RuntimeError:  # no home folder
        return None
    return base / "onorbit_rs" / "convex_pieces" if base.is_absolute() else None


def read(key: str) -> list[Floats] | None:
    """Return the pieces with this key; None if they are not cached or the file is damaged."""
    home = folder()
    if home is None:
        return None
    try:
        content = (home / key).read_bytes()
        if hashlib.sha256(content[CHECKSUM:]).digest() != content[:CHECKSUM]:
            return None
        return split(np.load(io.BytesIO(content[CHECKSUM:]), allow_pickle=False))
    except (OSError, ValueError, EOFError):
        return None


def write(key: str, pieces: list[Floats]) -> None:
    """Write pieces, each given by its corners (k, 3), to the cache; do nothing without write access."""
    home = folder()
    if home is None:
        return
    rows = [np.column_stack([np.full(len(corners), i), corners]) for i, corners in enumerate(pieces)]
    data = io.BytesIO()
    np.save(data, np.vstack(rows), allow_pickle=False)
    content = hashlib.sha256(data.getvalue()).digest() + data.getvalue()
    with suppress(OSError):
        home.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(dir=home, prefix=".")
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(content)
            Path(name).replace(home / key)
        except BaseException:
            Path(name).unlink(missing_ok=True)
            raise


def split(rows: Floats) -> list[Floats]:
    """Return the corners (k, 3) of each piece from rows (n, 4): index of the piece, then coordinates."""
    numbers = rows[:, 0]
    return [np.ascontiguousarray(rows[numbers == number, 1:]) for number in np.unique(numbers)]
