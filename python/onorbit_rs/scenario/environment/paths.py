"""Paths of links in a scenario with several systems."""

from __future__ import annotations

from collections.abc import Collection


def split_link(path: str, systems: Collection[str]) -> tuple[str, str]:
    """Return the system and the link of a path.

    The link is empty for a path ``SYSTEM`` without a link. If there is a single system, its name may be
    omitted. The system is empty for an invalid path.
    """
    system, slash, link = path.partition("/")
    if system in systems and (link or not slash):
        return system, link
    return (next(iter(systems)), path) if len(systems) == 1 else ("", "")
