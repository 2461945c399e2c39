"""Scenario of several systems, with their contacts and events."""

from __future__ import annotations

from functools import cached_property
from pathlib import Path
from typing import Annotated, Any

from pydantic import Field, model_validator

from onorbit_rs.common.suggestions import did_you_mean
from onorbit_rs.exceptions import ScenarioError
from onorbit_rs.scenario.actuators import check_actuators
from onorbit_rs.scenario.contact import Contact, check_contacts
from onorbit_rs.scenario.document import Document
from onorbit_rs.scenario.engine import check_world_engine
from onorbit_rs.scenario.environment import AnyEffect, BodyWrenchEffect, PythonEffect
from onorbit_rs.scenario.environment.paths import split_link
from onorbit_rs.scenario.environment.surface_effects import SurfaceEffect
from onorbit_rs.scenario.errors import inconsistent
from onorbit_rs.scenario.events import Event, ItsName, check_events
from onorbit_rs.scenario.loops import Loop, check_loops
from onorbit_rs.scenario.materials import MaterialPair, check_materials, look_up
from onorbit_rs.scenario.orbit import StartOrbit
from onorbit_rs.scenario.schema import InWorld, RobotKeys, Scenario
from onorbit_rs.scenario.settings import ControlSettings, WorldSettings
from onorbit_rs.scenario.user_code import UserClass
from onorbit_rs.scenario.validation_errors import combined
from onorbit_rs.scenario.watches import check_names
from onorbit_rs.scenario.yaml_lines import Lines, Location


class System(RobotKeys, ControlSettings):
    """One spacecraft of a scenario: robot, initial state and controllers."""

    orbit: StartOrbit | None = None
    """Orbit on which the base starts, ``kepler`` or ``sgp4``, as an alternative to ``position`` and
    ``linear_velocity`` in ``initial``. Its epoch may differ from the epoch of the reference orbit."""
    knows: list[str] = Field(default_factory=list)
    """Other systems whose models the controllers know: while such a system is connected to this system,
    model-based control laws use the model of the connected tree. Default: the model of this system only."""

    @classmethod
    def _hint(cls, key: str, free: list[str]) -> str:
        if key in ("sensors", "estimators"):
            return "; sensors and estimators are not available yet; omit the key"
        if key == "loops":
            return "; it belongs beside 'systems', with frames written SYSTEM/FRAME"
        return super()._hint(key, free)


class WorldScenario(Document):
    """Several systems on one reference orbit, with their contacts and events."""

    systems: Annotated[dict[ItsName, System], Field(min_length=1)]
    contacts: list[Contact] = Field(default_factory=list)
    """Contacts between links. Default: systems pass through each other."""
    materials: dict[str, MaterialPair] = Field(default_factory=dict)
    """Coefficients of friction by pair, such as ``rubber-aluminium``, for ``materials`` of contacts."""
    events: list[Event] = Field(default_factory=list)
    loops: list[Loop] = Field(default_factory=list)
    """Closed loops of the robots. Default: every robot is a tree."""
    simulation: WorldSettings

    @classmethod
    def _hint(cls, key: str, free: list[str]) -> str:
        if key in ControlSettings.model_fields:
            return "; it belongs in each entry of 'systems'"
        if key in RobotKeys.model_fields:
            return "; it belongs to a single robot: give either 'systems' or the keys of one robot"
        return super()._hint(key, free)

    def _validate(self, data: dict[str, Any], file: Path | None, lines: Lines) -> None:
        super()._validate(data, file, lines)
        for name, scenario in self.scenarios.items():
            self.systems[name].reference = scenario.reference  # with the default

    @cached_property
    def scenarios(self) -> dict[str, Scenario]:
        """Scenario of each system alone, with the orbit and environment of the world."""
        shared = {name: getattr(self, name) for name in Document.model_fields}
        settings = self.simulation.model_dump(exclude={"weld_time_constant"})
        events = [event.name for event in self.events]
        found: dict[str, Scenario] = {}
        errors: list[ScenarioError] = []
        for name, system in self.systems.items():
            own = {key: getattr(system, key) for key in RobotKeys.model_fields}
            control = {key: getattr(system, key) for key in ControlSettings.model_fields}
            effects = self._effects_on(name)
            own["environment"] = list(effects.values())
            others = [other for other in self.systems if other != name]
            loops = {index: loop.of_system(name) for index, loop in enumerate(self.loops)}
            loops = {index: loop for index, loop in loops.items() if loop is not None}
            own["loops"] = list(loops.values())
            data = shared | own | {"simulation": settings | control}
            place = InWorld(name, [*effects], events, others, [*loops])
            try:
                found[name] = Scenario.of_system(place, data, self._file, self._lines)
            except ScenarioError as error:
                errors.append(error)
        if errors:
            raise combined(errors)
        return found

    @property
    def effects(self) -> list[AnyEffect]:
        """Effects of the environment, whose links are given as paths ``SYSTEM/LINK``."""
        return self.environment

    @property
    def user_classes(self) -> list[UserClass]:
        """Classes written in Python by the user: effects, and the controllers of all systems."""
        effects = [effect for effect in self.environment if isinstance(effect, UserClass)]
        return effects + [part for alone in self.scenarios.values() for part in alone.user_classes]

    def _effects_on(self, name: str) -> dict[int, AnyEffect]:
        """Return the effects that act on a system, by their index in ``environment``."""
        found: dict[int, AnyEffect] = {}
        for index, effect in enumerate(self.environment):
            own: AnyEffect | None = effect
            if isinstance(effect, (SurfaceEffect, BodyWrenchEffect, PythonEffect)):
                own = effect.of_system(name, self.systems)
            if own is not None:
                found[index] = own
        return found

    @property
    def order(self) -> list[str]:
        """Names of the systems; a system follows the one to which its initial state is relative."""
        found: list[str] = []
        for name in self.systems:
            chain = [name]
            while (other := self.systems[chain[-1]].initial.neighbour) is not None:
                chain.append(other[0])
            found += [system for system in reversed(chain) if system not in found]
        return found

    @model_validator(mode="after")
    def _is_consistent(self) -> WorldScenario:
        names = list(self.systems)
        for index, effect in enumerate(self.environment):
            if isinstance(effect, (SurfaceEffect, BodyWrenchEffect)):
                self._check_surfaces(index, effect)
                for at, path in effect.paths:
                    self._check_path(("environment", index, *at), path, is_link=at == ("body",))
        for name, system in self.systems.items():
            self._check_neighbour(name, system)
            self._check_start(name, system)
            self._check_knows(name, system)
            check_actuators(("systems", name), system.actuators)
        check_contacts(self.contacts, names)
        check_materials(self.materials)
        look_up(self.contacts, self.materials)
        check_names(self)
        brakes = {name: [brake.brake for brake in self.systems[name].actuators] for name in names}
        check_events(self.events, names, brakes, [contact.label for contact in self.contacts])
        check_loops(self.loops, names)
        check_world_engine(self)
        return self

    def _check_surfaces(self, index: int, effect: AnyEffect) -> None:
        """Raise an error if a surface of one body is given for several systems."""
        one = getattr(effect, "surfaces", None)
        if one is not None and one.kind != "faces" and len(self.systems) > 1:
            message = (
                f"a surface of kind {one.kind} belongs to one body; give the surface in 'bodies', or in "
                "'surfaces' of a system"
            )
            raise inconsistent(("environment", index, "surfaces"), message)

    def _check_path(self, at: Location, path: str, *, is_link: bool) -> None:
        """Raise an error if a path does not begin with a system, or lacks the required link."""
        names = list(self.systems)
        system, link = split_link(path, names)
        if system and (link or not is_link):
            return
        example = f"{names[0]}/LINK"
        name, slash, _ = path.partition("/")
        if slash and name not in names:
            raise inconsistent(at, f"no system is named {name!r}{did_you_mean(name, names)}")
        if is_link or slash or not (hint := did_you_mean(path, names)).startswith("; did"):
            hint = f"; write {'SYSTEM/LINK' if is_link else 'SYSTEM or SYSTEM/LINK'}, such as {example}"
        raise inconsistent(at, f"{path!r} is not a link of a system{hint}")

    def _check_start(self, name: str, system: System) -> None:
        """Raise an error if a system's orbit lacks a reference orbit or contradicts its initial state."""
        if system.orbit is None:
            return
        at = ("systems", name)
        if self.orbit is None:
            message = "the orbit of a system requires the reference orbit; add 'orbit' beside 'systems'"
            raise inconsistent((*at, "orbit"), message)
        for key in ("position", "linear_velocity"):
            if key in system.initial.model_fields_set:
                message = f"'orbit' defines the start of the system; omit {key!r}, or omit the orbit"
                raise inconsistent((*at, "initial", key), message)
        if "gravity_mode" in system.orbit.model_fields_set:
            message = "'gravity_mode' is a key of the reference orbit; move it to 'orbit' beside 'systems'"
            raise inconsistent((*at, "orbit", "gravity_mode"), message)

    def _check_knows(self, name: str, system: System) -> None:
        """Raise an error if ``knows`` contains the system itself or a system that does not exist."""
        others = [other for other in self.systems if other != name]
        for index, known in enumerate(system.knows):
            if known not in others:
                what = (
                    "the system itself; omit it"
                    if known == name
                    else f"{known!r}, which is not a system{did_you_mean(known, others)}"
                )
                raise inconsistent(("systems", name, "knows", index), f"'knows' contains {what}")

    def _check_neighbour(self, name: str, system: System) -> None:
        """Raise an error if an initial state is relative to an unknown system, or depends on itself."""
        at = ("systems", name, "initial", "frame")
        chain, other = [name], system.initial.neighbour
        while other is not None:
            if other[0] not in self.systems:
                hint = did_you_mean(other[0], list(self.systems))
                raise inconsistent(at, f"no system is named {other[0]!r}{hint}")
            if other[0] in chain:
                cycle = ", ".join([*chain, other[0]])
                raise inconsistent(
                    at,
                    f"the frames of initial states form a cycle: {cycle}; give one state in another frame",
                )
            chain.append(other[0])
            other = self.systems[other[0]].initial.neighbour
