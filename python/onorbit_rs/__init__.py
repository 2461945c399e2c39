"""A simulator for free-floating robots in orbit.

>>> import onorbit_rs as oo
>>> model = oo.Model.rigid_body(120.0, [[4.0, 0, 0], [0, 22.0, 0], [0, 0, 24.0]])
>>> model.nv
6

All quantities are in SI and radians. ``q = [p(3), quat_xyzw(4), joints]`` and
``v = [v_body(3), w_body(3), joint rates]``, linear before angular; ``docs/`` defines the frames.

Data flow: ``scenario`` reads YAML and builds a :class:`Simulation`, ``simulation`` runs it and returns a
:class:`Trace`, ``output`` writes trace, summary and manifest, and ``viewer``, ``figures`` and ``report`` show
them. The design page in ``docs`` has a diagram.
"""

from __future__ import annotations

import copyreg
import importlib
from typing import TYPE_CHECKING, Any

from onorbit_rs import exceptions, relative, robots, scenarios
from onorbit_rs._core import (
    COLUMNS,
    MU_EARTH,
    Atmosphere,
    BodyStates,
    BodyWrench,
    Brake,
    Cannonball,
    Capture,
    Checkpoint,
    Circle,
    Column,
    Compliance,
    ComputedTorque,
    ConstantAtmosphere,
    ConstrainedFreeFloating,
    Contact,
    ContactTrace,
    Control,
    CustomPath,
    Disengage,
    Distance,
    Drag,
    Earth,
    Effect,
    Engage,
    EventRecord,
    ExponentialAtmosphere,
    External,
    Faces,
    FixedFrame,
    FreeFloating,
    FreeFloatingDerivatives,
    Friction,
    Goal,
    GravityField,
    GravityGradient,
    GripForce,
    HarrisPriester,
    Hold,
    HuntCrossley,
    ImpactLaw,
    InternalForce,
    JointComputedTorque,
    JointHold,
    JointPid,
    JointReference,
    JointSampled,
    JointWaypoints,
    Kepler,
    Line,
    LineParabola,
    Loop,
    LoopTrace,
    Model,
    ModelBuilder,
    Nrlmsise00,
    Numerical,
    Orbit,
    Plates,
    RadiationPressure,
    Reference,
    Release,
    Sampled,
    Screw,
    Sgp4,
    Shape,
    Simulation,
    SpringDashpot,
    State,
    Stepper,
    Surface,
    System,
    SystemStepper,
    Target,
    ThirdBody,
    Trace,
    Waypoints,
    World,
    WorldTrace,
    attach,
    build_info,
    distance,
    propagate,
    rollout,
)
from onorbit_rs.exceptions import OnOrbitError
from onorbit_rs.simulation.controller import Controller

if TYPE_CHECKING:
    from onorbit_rs import engines, layouts, ros2
    from onorbit_rs.campaigns.run import campaign, campaign_case
    from onorbit_rs.clearance import Clearance, KeepOut, MinimumDistance, Violation, clearances
    from onorbit_rs.displays.scene import show
    from onorbit_rs.figures.plot import plot
    from onorbit_rs.scenario import Scenario, WorldScenario
    from onorbit_rs.simulation.batch import run_batch
    from onorbit_rs.simulation.command_format import read_commands
    from onorbit_rs.simulation.commands import CommandLog
    from onorbit_rs.simulation.replay import replay_commands
    from onorbit_rs.simulation.run import Run, resume, run
    from onorbit_rs.tables import RecordedRun, read_run
    from onorbit_rs.tools.comparison import Comparison, compare

__all__ = [
    "COLUMNS",
    "MU_EARTH",
    "Atmosphere",
    "BodyStates",
    "BodyWrench",
    "Brake",
    "Cannonball",
    "Capture",
    "Checkpoint",
    "Circle",
    "Clearance",
    "Column",
    "CommandLog",
    "Comparison",
    "Compliance",
    "ComputedTorque",
    "ConstantAtmosphere",
    "ConstrainedFreeFloating",
    "Contact",
    "ContactTrace",
    "Control",
    "Controller",
    "CustomPath",
    "Disengage",
    "Distance",
    "Drag",
    "Earth",
    "Effect",
    "Engage",
    "EventRecord",
    "ExponentialAtmosphere",
    "External",
    "Faces",
    "FixedFrame",
    "FreeFloating",
    "FreeFloatingDerivatives",
    "Friction",
    "Goal",
    "GravityField",
    "GravityGradient",
    "GripForce",
    "HarrisPriester",
    "Hold",
    "HuntCrossley",
    "ImpactLaw",
    "InternalForce",
    "JointComputedTorque",
    "JointHold",
    "JointPid",
    "JointReference",
    "JointSampled",
    "JointWaypoints",
    "KeepOut",
    "Kepler",
    "Line",
    "LineParabola",
    "Loop",
    "LoopTrace",
    "MinimumDistance",
    "Model",
    "ModelBuilder",
    "Nrlmsise00",
    "Numerical",
    "OnOrbitError",
    "Orbit",
    "Plates",
    "RadiationPressure",
    "RecordedRun",
    "Reference",
    "Release",
    "Run",
    "Sampled",
    "Scenario",
    "Screw",
    "Sgp4",
    "Shape",
    "Simulation",
    "SpringDashpot",
    "State",
    "Stepper",
    "Surface",
    "System",
    "SystemStepper",
    "Target",
    "ThirdBody",
    "Trace",
    "Violation",
    "Waypoints",
    "World",
    "WorldScenario",
    "WorldTrace",
    "attach",
    "build_info",
    "campaign",
    "campaign_case",
    "clearances",
    "compare",
    "distance",
    "engines",
    "exceptions",
    "layouts",
    "plot",
    "propagate",
    "read_commands",
    "read_run",
    "relative",
    "replay_commands",
    "resume",
    "robots",
    "rollout",
    "ros2",
    "run",
    "run_batch",
    "scenarios",
    "show",
]

__version__: str = build_info()["version"]

_LAZY = {
    "Clearance": "clearance", "KeepOut": "clearance", "MinimumDistance": "clearance",
    "Violation": "clearance", "clearances": "clearance", "Comparison": "tools.comparison",
    "compare": "tools.comparison", "Scenario": "scenario", "WorldScenario": "scenario",
    "CommandLog": "simulation.commands", "campaign": "campaigns.run", "campaign_case": "campaigns.run",
    "read_commands": "simulation.command_format", "replay_commands": "simulation.replay",
    "plot": "figures.plot", "Run": "simulation.run", "resume": "simulation.run", "run": "simulation.run",
    "run_batch": "simulation.batch", "RecordedRun": "tables", "read_run": "tables",
    "show": "displays.scene",
}  # fmt: skip
"""Module of each name that is imported on first access, since importing numpy and pydantic takes 0.5 s."""
_LAZY_MODULES = ("engines", "layouts", "ros2", "scenario")


if not TYPE_CHECKING:  # otherwise every misspelt name would have a type

    def __getattr__(name: str) -> object:
        """Return a name that is imported on first access."""
        if name in _LAZY_MODULES:
            return importlib.import_module(f"onorbit_rs.{name}")
        if name not in _LAZY:
            raise AttributeError(f"module 'onorbit_rs' has no attribute {name!r}")
        globals()[name] = found = getattr(importlib.import_module(f"onorbit_rs.{_LAZY[name]}"), name)
        return found


def _reduced(trace: Trace) -> tuple[Any, ...]:
    """Return the pickled form of a trace; the pickling module is imported here, on first use."""
    from onorbit_rs.output.pickling import reduced

    return reduced(trace)


def _reduced_world(trace: WorldTrace) -> tuple[Any, ...]:
    """Return the pickled form of the trace of a world."""
    from onorbit_rs.output.saved_world import reduced_world

    return reduced_world(trace)


def _reduced_contact(contact: ContactTrace) -> tuple[Any, ...]:
    """Return the pickled form of the recorded values of a contact."""
    from onorbit_rs.output.saved_column import reduced_contact

    return reduced_contact(contact)


def _reduced_loop(loop: LoopTrace) -> tuple[Any, ...]:
    """Return the pickled form of the recorded values of a closed loop."""
    from onorbit_rs.output.saved_column import reduced_loop

    return reduced_loop(loop)


def _model_html(model: Model) -> str | None:
    """Return the tree of a robot as HTML for notebooks; the module that draws it is imported on first use."""
    from onorbit_rs.displays import model_html, or_plain

    return or_plain(model_html, model)


def _world_html(world: World) -> str | None:
    """Return the systems, orbit, effects, contacts and events of a world as HTML for notebooks."""
    from onorbit_rs.displays import or_plain, world_html

    return or_plain(world_html, world)


def _simulation_html(simulation: Simulation) -> str | None:
    """Return the systems and the settings of a simulation as HTML for notebooks."""
    from onorbit_rs.displays import or_plain, simulation_html

    return or_plain(simulation_html, simulation)


def _trace_png(trace: Trace | WorldTrace) -> bytes | None:
    """Return a plot of a trace as PNG for notebooks."""
    from onorbit_rs.displays import or_plain, trace_png

    return or_plain(trace_png, trace)


def _plain(shown: object) -> str:
    """Return the class of an object with its constructor's arguments, for ``repr``."""
    from onorbit_rs.displays.plain import plain

    return plain(shown)


for _class in [found for found in globals().values() if isinstance(found, type)]:
    if _class.__module__ == "onorbit_rs" and vars(object)["__repr__"] is _class.__repr__:
        _class.__repr__ = _plain  # type: ignore[assignment]

Model._repr_html_ = _model_html  # type: ignore[attr-defined]
World._repr_html_ = _world_html  # type: ignore[attr-defined]
Simulation._repr_html_ = _simulation_html  # type: ignore[attr-defined]
Trace._repr_png_ = _trace_png  # type: ignore[attr-defined]
WorldTrace._repr_png_ = _trace_png  # type: ignore[attr-defined]

copyreg.pickle(Trace, _reduced)
copyreg.pickle(LoopTrace, _reduced_loop)
copyreg.pickle(ContactTrace, _reduced_contact)
copyreg.pickle(WorldTrace, _reduced_world)


def __dir__() -> list[str]:
    """Return the public names, for completion."""
    return [*__all__, "__version__"]
