"""Target spacecraft of a scenario: what its references follow."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.scenario.start import quaternion_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs.scenario.schema import Scenario

    Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Target:
    """A spacecraft that nothing acts on: pose at time zero, constant velocity and spin; W axes, m, rad."""

    position: Floats
    quat_xyzw: Floats
    velocity: Floats
    spin: Floats
    size: tuple[float, ...] = ()
    """Edges of its box, m; axes alone are drawn where empty."""

    def position_at(self, t: Floats) -> Floats:
        """(T, 3), W, m."""
        place: Floats = self.position + np.outer(t, self.velocity)
        return place


def targets(scenario: Scenario) -> tuple[Target, ...]:
    """Every target that a reference follows, once."""
    found: dict[str, Target] = {}
    for reference in task_references(scenario):
        motion = getattr(reference.frame, "target", None)
        if motion is not None:
            found[repr(motion)] = Target(
                np.array(motion.position), quaternion_of(motion.attitude),
                np.array(motion.velocity), np.array(motion.spin), tuple(motion.size or ()),
            )  # fmt: skip
    return tuple(found.values())


def task_references(scenario: Scenario) -> Iterator[Any]:
    """Those of tools, which alone have a frame."""
    parts = [scenario.reference, *(control.reference for control in scenario.controllers or [])]
    return (part for part in parts if hasattr(part, "frame"))
