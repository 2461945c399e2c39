"""Selects the tool and the joints that a control law controls."""

from __future__ import annotations

from fnmatch import fnmatchcase
from typing import Any

from onorbit_rs.common.suggestions import did_you_mean, nearest
from onorbit_rs.exceptions import FrameError


def tool_of(law: Any, tool: str | None) -> str | None:
    """Return the tool of a control law, which by default is the ``tool`` of the scenario."""
    return getattr(law, "tool", None) or tool


def joint_group(wanted: list[str], joints: list[str]) -> list[str]:
    """Return the joints selected by names and patterns, in the order of ``wanted``.

    Joints that match the same pattern are in the order of the robot.

    Raises
    ------
    FrameError
        If a name or a pattern matches no joint.
    """
    found: list[str] = []
    for name in wanted:
        is_pattern = name not in joints and any(sign in name for sign in "*?[")
        matching = [joint for joint in joints if (fnmatchcase(joint, name) if is_pattern else joint == name)]
        if not matching:
            what = f"no joint matches {name!r}" if is_pattern else f"no joint is named {name!r}"
            raise FrameError(
                f"joints: {what}{did_you_mean(name, joints)}",
                name=name, kind="joint", known=joints, suggestion=nearest(name, joints),
            )  # fmt: skip
        found += matching
    return found


def joint_columns(law: Any, joints: list[str]) -> list[int]:
    """Return the indices of a control law's joints in ``joints``, the names of the robot's joints."""
    wanted = getattr(law, "joints", None)
    return [joints.index(name) for name in (joints if wanted is None else joint_group(wanted, joints))]
