"""Parts of file names and entity paths from names that a user defined."""

from __future__ import annotations


def file_part(name: str) -> str:
    """Return the first 60 characters of a name; all but letters, digits, ``-`` and ``_`` become ``_``."""
    return "".join(char if char.isalnum() or char in "-_" else "_" for char in name)[:60]


def numbered_part(number: int, name: str) -> str:
    """Return the part for one of several names, with its number (from 0) if the name had to change."""
    part = file_part(name)
    return part if part == name else f"{number + 1}_{part}"
