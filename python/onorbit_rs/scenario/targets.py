"""Target spacecraft that the references of a scenario follow, and the frame of the path of a tool."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from onorbit_rs.scenario.attitude import quaternion_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs.scenario.schema import Scenario

    Floats = NDArray[np.float64]

PathFrame = Literal["world", "lvlh", "base"]


@dataclass(frozen=True)
class Target:
    """Motion of a free-flying spacecraft in W, in SI: pose at time zero, constant velocity and spin."""

    position: Floats
    quat_xyzw: Floats
    velocity: Floats
    spin: Floats
    size: tuple[float, ...] = ()
    """Edge lengths of the target's box, m; empty if only the axes of the target are drawn."""

    def position_at(self, t: Floats) -> Floats:
        """Return the positions (T, 3) in W, m, at the times ``t``, (T,), s."""
        position: Floats = self.position + np.outer(t, self.velocity)
        return position


def targets(scenario: Scenario) -> tuple[Target, ...]:
    """Return the targets of all references, without duplicates."""
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
    """Yield the references of tools; references of joints, which have no frame, are omitted."""
    parts = [scenario.reference, *(control.reference for control in scenario.controllers or [])]
    return (part for part in parts if hasattr(part, "frame"))


def path_frame(scenario: Scenario) -> PathFrame:
    """Return the frame of the first reference of a tool if it is L or the base, otherwise W."""
    frames: tuple[PathFrame, ...] = ("lvlh", "base")
    first = next((reference.frame for reference in task_references(scenario)), None)
    return next((frame for frame in frames if frame == first), "world")
