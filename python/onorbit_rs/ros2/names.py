"""Names of ROS topics and frames for the names of systems, controls and links."""

from __future__ import annotations

import re
import warnings
from collections.abc import Collection, Iterable

_INVALID = re.compile(r"[^A-Za-z0-9_]")


def ros_name(name: str) -> str:
    """Return a name with characters that a ROS topic may contain; the others become single underscores."""
    cleaned = re.sub(r"_{2,}", "_", _INVALID.sub("_", name)).rstrip("_") or "x"
    return f"n{cleaned}" if cleaned[0].isdigit() else cleaned


def ros_names(names: Iterable[str], kind: str) -> dict[str, str]:
    """Return a distinct ROS name for each name; warn where it differs. Valid names keep theirs.

    Parameters
    ----------
    names : iterable of str
        Names of things of one kind.
    kind : str
        What they are, for the warning, such as ``system``.
    """
    given = list(names)
    taken = {name for name in given if ros_name(name) == name}
    found: dict[str, str] = {}
    for name in given:
        base = ros_name(name)
        number, candidate = 1, base
        while candidate != name and candidate in taken:
            number += 1
            candidate = f"{base}_{number}"
        taken.add(candidate)
        found[name] = candidate
    changed = [f"{name!r} → {other!r}" for name, other in found.items() if name != other]
    if changed:
        warnings.warn(
            f"ROS names contain letters, digits and single underscores; the topics of a {kind} use: "
            f"{', '.join(changed)}",
            UserWarning,
            stacklevel=3,
        )
    return found


def frame_names(names: Iterable[str], reserved: Collection[str]) -> dict[str, str]:
    """Return a distinct name for each frame; warn where it differs. Only reserved names get another one.

    Parameters
    ----------
    names : iterable of str
        Links and frames of a robot.
    reserved : collection of str
        Names of other frames of the tree, such as ``world``.
    """
    given = dict.fromkeys(names)
    taken = {*given, *reserved}
    found: dict[str, str] = {}
    for name in given:
        number, candidate = 1, name
        while name in reserved and candidate in taken:
            number += 1
            candidate = f"{name}_{number}"
        taken.add(candidate)
        found[name] = candidate
    changed = [f"{name!r} → {other!r}" for name, other in found.items() if name != other]
    if changed:
        warnings.warn(
            f"the tree of frames has other frames of these names; links and frames of the robot become: "
            f"{', '.join(changed)}",
            UserWarning,
            stacklevel=3,
        )
    return found
