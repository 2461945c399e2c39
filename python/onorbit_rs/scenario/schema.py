"""Scenario of one robot: one YAML mapping, validated before the run."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, NamedTuple, get_args

from pydantic import Field, PrivateAttr, ValidationError, ValidationInfo, model_validator

from onorbit_rs.scenario.actuators import Brake, check_actuators
from onorbit_rs.scenario.collision import CollisionShape
from onorbit_rs.scenario.control import AnyControl, AnyController, Controller
from onorbit_rs.scenario.control.check import check_control
from onorbit_rs.scenario.document import Document
from onorbit_rs.scenario.engine import check_engine
from onorbit_rs.scenario.environment import AnyEffect, BodyWrenchEffect, PythonEffect
from onorbit_rs.scenario.environment.surface_effects import SurfaceEffect
from onorbit_rs.scenario.environment.surfaces import RobotSurfaces
from onorbit_rs.scenario.errors import inconsistent
from onorbit_rs.scenario.initial import InitialState
from onorbit_rs.scenario.loops import Loop, check_loops
from onorbit_rs.scenario.orbit import AnyOrbit
from onorbit_rs.scenario.part import Part
from onorbit_rs.scenario.reference import Reference
from onorbit_rs.scenario.robot import Robot
from onorbit_rs.scenario.settings import ControlSettings, SimulationSettings
from onorbit_rs.scenario.user_code import UserClass
from onorbit_rs.scenario.validation_errors import first_error
from onorbit_rs.scenario.watches import check_names
from onorbit_rs.scenario.yaml_lines import Lines, Location


class RobotKeys(Part):
    """Robot with its controllers and initial state: keys of a scenario of one robot, and of a system."""

    robot: Robot
    tool: str | None = None
    """Frame that tracks the reference and is recorded."""
    controller: Controller | None = None
    """Single controller. Without ``controller`` and ``controllers``, no joint torques are commanded."""
    controllers: Annotated[list[AnyControl], Field(min_length=1)] | None = None
    """Several controllers, each with a joint group and a reference; an alternative to ``controller``."""
    reference: Reference | None = None
    """Reference of ``controller``. Default: the tool or the joints are held."""
    initial: InitialState = Field(default_factory=InitialState)
    """Initial state. Default: at rest in the neutral configuration."""
    surfaces: RobotSurfaces | None = None
    """Surfaces for drag and radiation pressure, if the effect defines no surfaces: one surface for all links,
    or a mapping from link to surface. Default: the visual geometry."""
    collision: list[CollisionShape] = Field(default_factory=list)
    """Collision shapes in addition to those of the robot's file, or the division of its collision meshes into
    convex pieces. They take part in contacts and distances."""
    actuators: list[Brake] = Field(default_factory=list)
    """Brakes of joints."""

    @property
    def laws(self) -> list[AnyController]:
        """Control laws of the run: those of ``controller`` or ``controllers``."""
        return [self.controller] if self.controller is not None else list(self.controllers or [])

    @property
    def tracked_tool(self) -> str | None:
        """Recorded frame: the ``tool`` of the scenario, otherwise the first tool of a control, or None."""
        return self._tracked_tool[0]

    @property
    def place_of_tool(self) -> Location:
        """Location of :attr:`tracked_tool`."""
        return self._tracked_tool[1]

    @property
    def _tracked_tool(self) -> tuple[str | None, Location]:
        for index, control in enumerate(self.controllers or [] if self.tool is None else []):
            if tool := getattr(control, "tool", None):
                return tool, ("controllers", index, "tool")
        return self.tool, ("tool",)


class Scenario(RobotKeys, Document):
    """Robot, orbit, environment, controllers and integrator settings of a run.

    :func:`onorbit_rs.scenario.load` reads a scenario from a file. In Python:
    ``Scenario(robot="humanoid_torso", simulation={"duration": "5 s"})``.
    """

    loops: list[Loop] = Field(default_factory=list)
    """Closed loops of the robot. Default: the robot is a tree."""
    simulation: SimulationSettings

    _in_world: InWorld | None = PrivateAttr(default=None)

    @classmethod
    def of_system(cls, place: InWorld, data: dict[str, Any], file: Path | None, lines: Lines) -> Scenario:
        """Return the scenario of one system alone, from validated parts and the lines of the world."""
        scenario = cls.__new__(cls)
        try:
            context = {"events": place.events, "systems": place.systems}
            cls.__pydantic_validator__.validate_python(data, self_instance=scenario, context=context)
        except ValidationError as error:
            raise first_error(error, data, file, lines, lambda *at: place.location(at)) from None
        scenario._file, scenario._lines, scenario._in_world = file, lines, place
        return scenario

    def location(self, *at: str | int) -> Location:
        """Return the location of an entry in the YAML file, which may be the file of a world."""
        return at if self._in_world is None else self._in_world.location(at)

    @property
    def user_classes(self) -> list[UserClass]:
        """Classes written in Python by the user: controllers and effects."""
        return [part for part in (*self.laws, *self.effects) if isinstance(part, UserClass)]

    @property
    def event_names(self) -> list[str]:
        """Names of the events of the world; empty for a scenario with one robot."""
        return [] if self._in_world is None else self._in_world.events

    @property
    def effects(self) -> list[AnyEffect]:
        """Effects of the environment, with the surfaces of the robot as their default."""
        return [
            effect.with_default(self.surfaces) if isinstance(effect, SurfaceEffect) else effect
            for effect in self.environment
        ]

    @classmethod
    def _hint(cls, key: str, free: list[str]) -> str:
        """Return the hint for an unknown key: where the key belongs, or the most similar key."""
        parts = {"orbit": get_args(AnyOrbit), "initial": [InitialState], "simulation": [SimulationSettings]}
        sections = [repr(name) for name, kinds in parts.items()
                    if key != "kind" and any(key in part.yaml_keys() for part in kinds)]  # fmt: skip
        if key in ("contacts", "events", "materials"):
            return "; it requires 'systems', so move the keys of the robot into an entry of 'systems'"
        return f"; it belongs in {' or '.join(sections)}" if sections else super()._hint(key, free)

    @model_validator(mode="after")
    def _is_consistent(self, info: ValidationInfo) -> Scenario:
        context = info.context or {}
        check_control(self, context.get("events", []), context.get("systems", []))
        check_engine(self)
        check_names(self)
        if self._in_world is None and "systems" not in context:
            check_loops(self.loops, [])
            check_actuators((), self.actuators)
        if self.orbit is None:
            for index, effect in enumerate(self.environment):
                if not isinstance(effect, (BodyWrenchEffect, PythonEffect)):
                    message = f"the effect {effect.kind} requires an orbit; add 'orbit'"
                    raise inconsistent(("environment", index), message)
            if self.initial.frame in ("lvlh", "path"):
                raise inconsistent(
                    ("initial", "frame"),
                    f"frame {self.initial.frame} requires an orbit; add 'orbit' or use another frame",
                )
        return self


class InWorld(NamedTuple):
    """Location of the scenario of one system within the scenario of a world."""

    system: str
    effects: list[int]
    """Index of each effect on the system in the environment of the world."""
    events: list[str]
    """Names of the events of the world, after which a control may start."""
    systems: list[str]
    """Names of the other systems, in whose frames references may be given."""
    loops: list[int]
    """Index of each loop of the system in the loops of the world."""

    def location(self, at: Location) -> Location:
        """Return the location in the world's file of an entry of the system's scenario."""
        if at and at[0] in RobotKeys.model_fields:
            return ("systems", self.system, *at)
        if len(at) > 1 and at[0] == "simulation" and at[1] in ControlSettings.model_fields:
            return ("systems", self.system, *at[1:])
        if len(at) > 1 and at[0] == "environment" and isinstance(at[1], int):
            return ("environment", self.effects[at[1]], *at[2:])
        if len(at) > 1 and at[0] == "loops" and isinstance(at[1], int):
            return ("loops", self.loops[at[1]], *at[2:])
        return at
