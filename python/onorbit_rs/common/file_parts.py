"""Parts of file names and entity paths from names that a user defined."""

from __future__ import annotations


def file_part(name: str) -> str:
    """Return the first 60 characters of a name; all but letters, digits, ``-`` and ``_`` become ``_``."""
    return "".join(char if char.isalnum() or char in "-_" else "_" for char in name)[:60]


def numbered_part(number: int, name: str) -> str:
    """Return the file part of a name; a part that differs from the name is prefixed with ``number + 1``.

    ``number`` is the index of the name, from 0, so that different names give different parts.
    """
    part = file_part(name)
    return part if part == name else f"{number + 1}_{part}"
