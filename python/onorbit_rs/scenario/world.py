"""Scenario of several systems, with their events."""

from __future__ import annotations

from functools import cached_property
from pathlib import Path
from typing import Annotated, Any

from pydantic import Field, model_validator

from onorbit_rs.common.suggestions import did_you_mean
from onorbit_rs.scenario.document import Document
from onorbit_rs.scenario.environment import BodyWrenchEffect
from onorbit_rs.scenario.environment.surface_effects import SurfaceEffect
from onorbit_rs.scenario.errors import inconsistent
from onorbit_rs.scenario.events import Event, ItsName, check_events
from onorbit_rs.scenario.locations import scenario_error
from onorbit_rs.scenario.schema import RobotKeys, Scenario
from onorbit_rs.scenario.settings import ControlSettings, WorldSettings
from onorbit_rs.scenario.yaml_lines import Lines


class System(RobotKeys, ControlSettings):
    """One spacecraft: robot, initial state and controllers."""

    @classmethod
    def _hint(cls, key: str, free: list[str]) -> str:
        if key in ("actuators", "sensors", "estimators", "loops", "knows"):
            return "; it is not available yet"
        return super()._hint(key, free)


class WorldScenario(Document):
    """Several systems on one reference orbit, and the events that connect and separate them."""

    systems: Annotated[dict[ItsName, System], Field(min_length=1)]
    events: list[Event] = Field(default_factory=list)
    simulation: WorldSettings

    @classmethod
    def _hint(cls, key: str, free: list[str]) -> str:
        if key in ("contacts", "loops"):
            return "; it is not available yet"
        if key in ControlSettings.model_fields:
            return "; each of 'systems' has its own"
        return super()._hint(key, free)

    def _validate(self, data: dict[str, Any], file: Path | None, lines: Lines) -> None:
        for key in RobotKeys.model_fields:
            if key in data:
                message = f"{key!r} belongs to a single robot; give either 'systems' or the keys of one robot"
                raise scenario_error(message, file, lines.get((key,)), key)
        super()._validate(data, file, lines)
        for name, scenario in self.scenarios.items():
            self.systems[name].reference = scenario.reference  # with the default

    @cached_property
    def scenarios(self) -> dict[str, Scenario]:
        """Scenario of each system alone, with the orbit and environment of the world."""
        shared = {name: getattr(self, name) for name in Document.model_fields}
        settings = self.simulation.model_dump()
        found = {}
        for name, system in self.systems.items():
            own = {key: getattr(system, key) for key in RobotKeys.model_fields}
            control = {key: getattr(system, key) for key in ControlSettings.model_fields}
            data = shared | own | {"simulation": settings | control}
            found[name] = Scenario.of_system(name, data, self._file, self._lines)
        return found

    @property
    def order(self) -> list[str]:
        """Names of the systems; each is after the one to whose frame its initial state is relative."""
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
        if self.engine != "native":
            raise inconsistent("engine", f"engine {self.engine} does not support 'systems'; use native")
        if len(names) > 1:
            for index, effect in enumerate(self.environment):
                if isinstance(effect, (SurfaceEffect, BodyWrenchEffect)):
                    what = effect.kind.replace("_", " ")
                    message = (
                        f"{what} acts on the bodies of one robot and does not support several systems yet"
                    )
                    raise inconsistent(("environment", index), message)
        for name, system in self.systems.items():
            self._check_neighbour(name, system)
        check_events(self.events, names)
        return self

    def _check_neighbour(self, name: str, system: System) -> None:
        """Raise an error if the initial state is relative to no other system, or to itself in a circle."""
        at = ("systems", name, "initial", "frame")
        chain, other = [name], system.initial.neighbour
        while other is not None:
            if other[0] not in self.systems:
                hint = did_you_mean(other[0], list(self.systems))
                raise inconsistent(at, f"no system is named {other[0]!r}{hint}")
            if other[0] in chain:
                circle = ", ".join([*chain, other[0]])
                raise inconsistent(at, f"initial states are relative to each other: {circle}")
            chain.append(other[0])
            other = self.systems[other[0]].initial.neighbour
