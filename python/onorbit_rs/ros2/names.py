"""Names of ROS topics and frames for the names of systems, controls and links."""

from __future__ import annotations

import re
import warnings
from collections.abc import Collection, Iterable, Mapping

_INVALID = re.compile(r"[^A-Za-z0-9_]")


def ros_name(name: str) -> str:
    """Return a name that is valid in a ROS topic, given the name of a system, control or link.

    Runs of underscores and invalid characters become one underscore, except at the end, where they are
    removed. An underscore at the start is kept: the name is valid, and tools of ROS 2 do not list its topics
    by default. The letter ``n`` is put before a digit at the start, and an empty name becomes ``x``.
    """
    cleaned = re.sub(r"_{2,}", "_", _INVALID.sub("_", name)).rstrip("_") or "x"
    return f"n{cleaned}" if cleaned[0].isdigit() else cleaned


def ros_names(names: Iterable[str], kind: str) -> dict[str, str]:
    """Return a distinct ROS name for each name; warn of names that change. Valid names do not change.

    Parameters
    ----------
    names : iterable of str
        Names of one kind of object.
    kind : str
        Kind of the objects in the warning, for example ``system``.
    """
    wanted = {name: ros_name(name) for name in names}
    kept = {name for name, ros in wanted.items() if ros == name}
    reason = (
        "names in ROS topics must be distinct, contain only letters, digits and single underscores, and "
        f"neither begin with a digit nor end with an underscore; renamed {kind}s"
    )
    return _numbered(wanted, kept, kept, reason)


def frame_names(names: Iterable[str], reserved: Collection[str]) -> dict[str, str]:
    """Return a distinct name for each frame; warn of names that change. Only reserved names change.

    Parameters
    ----------
    names : iterable of str
        Links and frames of a robot.
    reserved : collection of str
        Names of other frames of the tree, such as ``world``.
    """
    wanted = {name: name for name in names}
    reason = "links and frames whose names other frames in /tf already have are renamed there"
    return _numbered(wanted, wanted.keys() - reserved, {*wanted, *reserved}, reason)


def _numbered(
    wanted: Mapping[str, str], kept: Collection[str], taken: Collection[str], reason: str
) -> dict[str, str]:
    """Return the wanted names, with a number added to each that is taken; warn of the names that differ.

    The names in ``kept`` do not change. The warning begins with ``reason``.
    """
    used = set(taken)
    found: dict[str, str] = {}
    for name, base in wanted.items():
        number, candidate = 1, base
        while name not in kept and candidate in used:
            number += 1
            candidate = f"{base}_{number}"
        used.add(candidate)
        found[name] = candidate
    changed = [f"{name!r} → {other!r}" for name, other in found.items() if name != other]
    if changed:
        warnings.warn(f"{reason}: {', '.join(changed)}", UserWarning, stacklevel=4)
    return found
