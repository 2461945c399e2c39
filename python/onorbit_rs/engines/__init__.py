"""Other physics engines that integrate the motion of the robot in place of the native equations of motion.

Pass one to :class:`onorbit_rs.Simulation` as ``engine=``, or write ``engine: mujoco`` in a scenario. Robot,
controllers, environment, schedule, trace and certificate do not depend on the engine. Outside this folder,
only ``tools.validation`` imports MuJoCo, as an independent oracle that shares no code with this engine.
"""

from __future__ import annotations

import contextlib
import importlib.metadata

from onorbit_rs.engines.mujoco import Mujoco
from onorbit_rs.engines.mujoco_model import missing

__all__ = ["Mujoco", "versions"]


def versions(engine: str) -> dict[str, str]:
    """Return the name of an engine as ``engine`` and, unless it is native, its version as ``NAME_version``.

    Raises
    ------
    EngineError
        If the engine is not installed.
    """
    if engine == "native":
        return {"engine": engine}
    for package in (f"{engine}-core", engine):  # the bindings alone, or with viewer and renderer
        with contextlib.suppress(importlib.metadata.PackageNotFoundError):
            return {"engine": engine, f"{engine}_version": importlib.metadata.version(package)}
    raise missing()
