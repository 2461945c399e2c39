"""Labels of the entries of a summary."""

from __future__ import annotations

import re
from typing import NamedTuple

_ERROR = re.compile(
    r"tracking_(?:(?P<owner>.+)_)?(?P<what>position|attitude|joint|joint_rate|force)_error_(?P<which>max|final)"
    r"_(?P<unit>rad|m|n|rad_s|m_s)"
)
_GOAL = re.compile(r"control_(.+)_result")
_WHICH = {"max": "largest", "final": "at the end"}

EXCEEDED = {
    "joint_limits_exceeded": "joint limits",
    "joint_rates_exceeded": "rate limits of joints",
    "joint_efforts_exceeded": "effort limits of joints",
}
"""Labels of the summary entries that list the joints beyond a limit of the robot."""


class Tracking(NamedTuple):
    """A tracking error of the controller ``owner``.

    ``owner`` is empty for the error of the recorded tool, and for the joint error of a single controller.
    """

    owner: str
    label: str
    unit: str
    is_largest: bool


def tracking(key: str) -> Tracking | None:
    """Return the tracking error that a key of the summary describes; None for other keys."""
    found = _ERROR.fullmatch(key)
    if found is None:
        return None
    owner, what, which, unit = found.group("owner", "what", "which", "unit")
    is_of_joints = what.startswith("joint")
    kind = "prismatic " if is_of_joints and unit in ("m", "m_s") else ""
    prefix = f"{owner}: " if owner else "" if is_of_joints else "tool "
    label = f"{prefix}{kind}{what.replace('_', ' ')} error, {_WHICH[which]}"
    return Tracking(owner or "", label, unit.replace("n", "N").replace("_", "/"), which == "max")


def goal_of(key: str) -> str | None:
    """Return the name of the control if a key of the summary describes its goal; None for other keys."""
    found = _GOAL.fullmatch(key)
    return found[1] if found else None
