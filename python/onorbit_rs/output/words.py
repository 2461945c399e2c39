"""What entries of a summary are called where a person reads them."""

from __future__ import annotations

import re
from typing import NamedTuple

_ERROR = re.compile(
    r"tracking_(?:(?P<whose>.+)_)?(?P<what>position|attitude|joint)_error_(?P<which>max|final)_(?P<unit>rad|m)"
)
_GOAL = re.compile(r"control_(.+)_result")
_WHICH = {"max": "largest", "final": "at the end"}

EXCEEDED = {
    "joint_limits_exceeded": "joint limits",
    "joint_rates_exceeded": "rate limits of joints",
    "joint_efforts_exceeded": "effort limits of joints",
}
"""Entries of a summary that name joints beyond a limit of the robot, and what to call the limits."""


class Tracking(NamedTuple):
    """A tracking error: of a controller by name, or of the one there is (``whose`` is empty)."""

    whose: str
    words: str
    unit: str
    is_largest: bool


def tracking(key: str) -> Tracking | None:
    """What the key of a tracking error says; None of another key."""
    found = _ERROR.fullmatch(key)
    if found is None:
        return None
    whose, what, which, unit = found.group("whose", "what", "which", "unit")
    error = "error of a sliding joint" if (what, unit) == ("joint", "m") else f"{what} error"
    owner = f"{whose}: " if whose else "tool " if what != "joint" else ""
    return Tracking(whose or "", f"{owner}{error}, {_WHICH[which]}", unit, which == "max")


def goal_of(key: str) -> str | None:
    """Whose goal's outcome a key holds; None of another key."""
    found = _GOAL.fullmatch(key)
    return found[1] if found else None
