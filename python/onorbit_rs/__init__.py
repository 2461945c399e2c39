"""A simulator for free-floating robots in orbit.

>>> import onorbit_rs as oo
>>> model = oo.Model.rigid_body(120.0, [[4.0, 0, 0], [0, 22.0, 0], [0, 0, 24.0]])
>>> model.nv
6

SI and radians everywhere; frames and layouts are those of ``docs/``: ``q = [p(3), quat_xyzw(4), joints]``,
``v = [v_body(3), w_body(3), joint rates]``, linear before angular.
"""

from __future__ import annotations

import copyreg
import importlib
from typing import TYPE_CHECKING, Any

from onorbit_rs import exceptions, relative, robots, scenarios
from onorbit_rs._core import (
    MU_EARTH,
    Atmosphere,
    BodyWrench,
    Cannonball,
    Checkpoint,
    Circle,
    Compliance,
    ComputedTorque,
    ConstantAtmosphere,
    Control,
    CustomPath,
    Drag,
    Earth,
    ExponentialAtmosphere,
    Faces,
    FixedFrame,
    FreeFloating,
    FreeFloatingDerivatives,
    Goal,
    GravityField,
    GravityGradient,
    HarrisPriester,
    Hold,
    JointComputedTorque,
    JointHold,
    JointPid,
    JointReference,
    JointSampled,
    JointWaypoints,
    Kepler,
    Line,
    LineParabola,
    Model,
    ModelBuilder,
    Nrlmsise00,
    Numerical,
    Orbit,
    Plates,
    RadiationPressure,
    Reference,
    Sampled,
    Screw,
    Sgp4,
    Simulation,
    State,
    Surface,
    Target,
    ThirdBody,
    Trace,
    Waypoints,
    attach,
    build_info,
    propagate,
    rollout,
)
from onorbit_rs.control import Controller
from onorbit_rs.exceptions import OnOrbitError

if TYPE_CHECKING:
    from onorbit_rs import layouts, plants
    from onorbit_rs.comparison import Comparison, compare
    from onorbit_rs.running import Run, resume, run
    from onorbit_rs.scenario import Scenario

__all__ = [
    "MU_EARTH",
    "Atmosphere",
    "BodyWrench",
    "Cannonball",
    "Checkpoint",
    "Circle",
    "Comparison",
    "Compliance",
    "ComputedTorque",
    "ConstantAtmosphere",
    "Control",
    "Controller",
    "CustomPath",
    "Drag",
    "Earth",
    "ExponentialAtmosphere",
    "Faces",
    "FixedFrame",
    "FreeFloating",
    "FreeFloatingDerivatives",
    "Goal",
    "GravityField",
    "GravityGradient",
    "HarrisPriester",
    "Hold",
    "JointComputedTorque",
    "JointHold",
    "JointPid",
    "JointReference",
    "JointSampled",
    "JointWaypoints",
    "Kepler",
    "Line",
    "LineParabola",
    "Model",
    "ModelBuilder",
    "Nrlmsise00",
    "Numerical",
    "OnOrbitError",
    "Orbit",
    "Plates",
    "RadiationPressure",
    "Reference",
    "Run",
    "Sampled",
    "Scenario",
    "Screw",
    "Sgp4",
    "Simulation",
    "State",
    "Surface",
    "Target",
    "ThirdBody",
    "Trace",
    "Waypoints",
    "attach",
    "build_info",
    "compare",
    "exceptions",
    "layouts",
    "plants",
    "propagate",
    "relative",
    "resume",
    "robots",
    "rollout",
    "run",
    "scenarios",
]

__version__: str = build_info()["version"]

_LATER = {
    "Comparison": "comparison", "compare": "comparison", "Scenario": "scenario",
    "Run": "running", "resume": "running", "run": "running",
}  # fmt: skip
"""Where names come from that are loaded when first asked for: numpy and pydantic take half a second."""
_LATER_MODULES = ("layouts", "plants", "comparison", "running", "scenario")


if not TYPE_CHECKING:  # or every misspelt name would have a type

    def __getattr__(name: str) -> object:
        """Load what is asked for."""
        if name in _LATER_MODULES:
            return importlib.import_module(f"onorbit_rs.{name}")
        if name not in _LATER:
            raise AttributeError(f"module 'onorbit_rs' has no attribute {name!r}")
        globals()[name] = found = getattr(importlib.import_module(f"onorbit_rs.{_LATER[name]}"), name)
        return found


def _reduced(trace: Trace) -> tuple[Any, ...]:
    """How a trace pickles; what of it travels is numpy's, and loaded when the first one does."""
    from onorbit_rs.output.travel import reduced

    return reduced(trace)


copyreg.pickle(Trace, _reduced)


def __dir__() -> list[str]:
    """Public names alone, for completion."""
    return [*__all__, "__version__"]
