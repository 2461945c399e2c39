"""Parts of file names and entity paths from names that a user defined."""

from __future__ import annotations


def file_part(name: str) -> str:
    """Return a user-defined name with characters replaced that a file name may not contain."""
    return "".join(char if char.isalnum() or char in "-_" else "_" for char in name)[:60]
