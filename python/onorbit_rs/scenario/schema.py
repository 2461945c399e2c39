"""The whole scenario: one YAML mapping, checked before anything runs."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal, get_args

from pydantic import Field, PrivateAttr, ValidationError, model_validator

from onorbit_rs.scenario.complaints import first_complaint
from onorbit_rs.scenario.control import AnyController, Controller
from onorbit_rs.scenario.control_fit import check_control
from onorbit_rs.scenario.controls import AnyControl
from onorbit_rs.scenario.earth import EarthPart, Epoch
from onorbit_rs.scenario.environment import BodyWrenchEffect, Effect
from onorbit_rs.scenario.initial import InitialState
from onorbit_rs.scenario.part import Part
from onorbit_rs.scenario.path import AnyOrbit, Orbit
from onorbit_rs.scenario.plant import check_plant
from onorbit_rs.scenario.reference_parts import Reference
from onorbit_rs.scenario.refusals import misfit
from onorbit_rs.scenario.robot import Robot
from onorbit_rs.scenario.settings import SimulationSettings
from onorbit_rs.scenario.yaml_lines import Lines, line_of


class Scenario(Part):
    """A robot, where it flies, what acts on it, what it tracks, and how long.

    Read one with :func:`onorbit_rs.scenario.load`, or make one in Python:
    ``Scenario(robot="humanoid_torso", simulation={"duration": "5 s"})``.
    """

    name: str = "scenario"
    description: str = ""
    robot: Robot
    plant: Literal["native", "mujoco"] = "native"
    """Whose equations move the robot: ours, or MuJoCo's, as an independent check."""
    tool: str | None = None
    """The frame that is tracked and recorded."""
    epoch: Epoch | None = None
    """Time zero, with its time scale: ``2024-03-01T12:00:00 UTC``; an element set's own where not given."""
    earth: EarthPart | None = None
    """How the Earth turns, by IAU 2006 where there is an epoch."""
    orbit: Orbit | None = None
    """An orbit always brings gravity; without one nothing pulls."""
    environment: list[Effect] = Field(default_factory=list)
    controller: Controller | None = None
    """Joints are limp where not given."""
    controllers: Annotated[list[AnyControl], Field(min_length=1)] | None = None
    """Or several, each on joints of its own and with its own reference."""
    reference: Reference | None = None
    initial: InitialState = Field(default_factory=InitialState)
    simulation: SimulationSettings

    _file: Path | None = PrivateAttr(default=None)
    _lines: Lines = PrivateAttr(default_factory=dict)

    def __init__(self, **data: Any) -> None:
        """Check what is given; raises :class:`onorbit_rs.exceptions.ScenarioError`."""
        try:
            self.__pydantic_validator__.validate_python(data, self_instance=self)
        except ValidationError as error:
            raise first_complaint(error, data, None, {}) from None

    @classmethod
    def checked(cls, data: dict[str, Any]) -> Scenario:
        """From plain data; raises pydantic's own error, which a reader of files tells with file and line."""
        scenario = cls.__new__(cls)
        cls.__pydantic_validator__.validate_python(data, self_instance=scenario)
        return scenario

    @classmethod
    def _hint(cls, key: str, free: list[str]) -> str:
        """The part that a key belongs into, where it is one's own word."""
        parts = {"orbit": get_args(AnyOrbit), "initial": [InitialState], "simulation": [SimulationSettings]}
        homes = [repr(name) for name, kinds in parts.items()
                 if key != "kind" and any(key in part.yaml_keys() for part in kinds)]  # fmt: skip
        return f"; it belongs into {' or '.join(homes)}" if homes else super()._hint(key, free)

    @property
    def file(self) -> Path | None:
        """The YAML it was read from."""
        return self._file

    @property
    def gravity_mode(self) -> Literal["true", "carried"]:
        """``true``, or ``carried`` where the orbit says so; a Kepler orbit obeys its field, both are one."""
        return "carried" if getattr(self.orbit, "gravity_mode", None) == "carried" else "true"

    @property
    def laws(self) -> list[AnyController]:
        """The controllers of the run, one or several."""
        return [self.controller] if self.controller is not None else list(self.controllers or [])

    @property
    def tracked_tool(self) -> str | None:
        """The frame that is recorded: the scenario's, else that of the first control that has one."""
        tools = (getattr(control, "tool", None) for control in self.controllers or [])
        return self.tool or next(filter(None, tools), None)

    def line_of(self, *at: str | int) -> int | None:
        """Line in the YAML of an entry, or of the nearest entry around it."""
        return line_of(at, self._lines)

    def remember_source(self, file: Path | None, lines: Lines) -> None:
        """Where it was read from, for messages."""
        self._file, self._lines = file, lines

    def resolved(self, folder: Path | None = None) -> dict[str, Any]:
        """Plain data in SI with every default written out; reading it back gives the same scenario.

        Paths are absolute, from ``folder``, where one is given.
        """
        return self.model_dump(mode="json", by_alias=True, exclude_none=True, context=folder)

    @model_validator(mode="after")
    def _parts_fit(self) -> Scenario:
        check_control(self)
        check_plant(self)
        if self.orbit is None:
            for index, effect in enumerate(self.environment):
                if not isinstance(effect, BodyWrenchEffect):
                    what = effect.kind.replace("_", " ")
                    raise misfit(("environment", index), f"the {what} needs an 'orbit'")
            if self.initial.frame != "world":
                raise misfit(("initial", "frame"), f"the frame {self.initial.frame} needs an 'orbit'")
        return self
