"""Other physics engines that move the robot in the place of our own equations.

Give one to :class:`onorbit_rs.Simulation` as ``plant=``, or say ``plant: mujoco`` in a scenario: robot,
controller, environment, schedule, trace and certificate are those of every run, the motion is another
engine's. Beside this folder only ``validation`` imports mujoco: an oracle that shares nothing with the plant.
"""

from __future__ import annotations

import contextlib
import importlib.metadata

from onorbit_rs.plants.mujoco import Mujoco
from onorbit_rs.plants.mujoco_model import missing

__all__ = ["Mujoco", "versions"]


def versions(plant: str) -> dict[str, str]:
    """The plant of a run, and the version of an engine that is not ours: ``mujoco_version``."""
    if plant == "native":
        return {"plant": plant}
    for package in (f"{plant}-core", plant):  # the bindings alone, or with viewer and renderer
        with contextlib.suppress(importlib.metadata.PackageNotFoundError):
            return {"plant": plant, f"{plant}_version": importlib.metadata.version(package)}
    raise missing()
