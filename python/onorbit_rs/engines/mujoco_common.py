"""Names and settings that the parts of a MuJoCo model share."""

from __future__ import annotations

from typing import Any

import numpy as np

HARDEST = (0.9999, 0.9999, 0.001, 0.5, 2.0)
"""``solimp`` of all constraints except contacts; with the impedance ``d = 0.9999``, a constraint leaves a
fraction ``1 - d`` of the unconstrained acceleration."""


def path(system: str, name: str) -> str:
    """Return the name of a link or joint in a world, ``SYSTEM/NAME``; the name itself for a single robot."""
    return f"{system}/{name}" if system else name


def link_name(name: str) -> str:
    """Return the MuJoCo name of a body; the prefix avoids the reserved name ``world``."""
    return f"link {name}"


def harden(equality: Any, time_constant: float) -> None:
    """Make an equality a critically damped spring with a time constant, s, and the stiffest impedance."""
    equality.solref, equality.solimp = np.array([time_constant, 1.0]), np.array(HARDEST)
