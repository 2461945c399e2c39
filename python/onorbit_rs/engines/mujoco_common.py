"""Names and settings that the parts of a MuJoCo model share."""

from __future__ import annotations

HARDEST = (0.9999, 0.9999, 0.001, 0.5, 2.0)
"""``solimp`` of all constraints except contacts; a soft constraint leaves a fraction ``1 - d`` of the
acceleration."""


def path(system: str, name: str) -> str:
    """Return the name of a link or joint in a world, ``SYSTEM/NAME``; the name itself for a single robot."""
    return f"{system}/{name}" if system else name


def link_name(name: str) -> str:
    """Return the MuJoCo name of a body; the prefix avoids the reserved name ``world``."""
    return f"link {name}"
