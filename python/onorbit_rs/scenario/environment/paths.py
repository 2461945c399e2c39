"""Paths of links in a scenario with several systems."""

from __future__ import annotations

from collections.abc import Collection


def split_link(path: str, systems: Collection[str]) -> tuple[str, str]:
    """Return system and link of a path.

    The link of ``SYSTEM`` alone is empty. With a single system its name may be left out. The system of an
    invalid path is empty.
    """
    system, slash, link = path.partition("/")
    if system in systems and (link or not slash):
        return system, link
    return (next(iter(systems)), path) if len(systems) == 1 else ("", "")
