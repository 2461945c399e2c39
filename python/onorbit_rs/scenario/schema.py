"""Scenario: one YAML mapping, validated before the run."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal, get_args

from pydantic import Field, PrivateAttr, ValidationError, model_validator

from onorbit_rs.scenario.control import AnyControl, AnyController, Controller
from onorbit_rs.scenario.control.check import check_control
from onorbit_rs.scenario.engine import check_engine
from onorbit_rs.scenario.environment import BodyWrenchEffect, Effect
from onorbit_rs.scenario.environment.earth import EarthPart, Epoch
from onorbit_rs.scenario.errors import inconsistent
from onorbit_rs.scenario.initial import InitialState
from onorbit_rs.scenario.locations import scenario_error
from onorbit_rs.scenario.orbit import AnyOrbit, Orbit
from onorbit_rs.scenario.part import Part
from onorbit_rs.scenario.reference import Reference
from onorbit_rs.scenario.robot import Robot
from onorbit_rs.scenario.settings import SimulationSettings
from onorbit_rs.scenario.validation_errors import first_error
from onorbit_rs.scenario.yaml_lines import Lines, line_of


class Scenario(Part):
    """Robot, orbit, environment, controllers and integrator settings of a run.

    :func:`onorbit_rs.scenario.load` reads one from a file. In Python:
    ``Scenario(robot="humanoid_torso", simulation={"duration": "5 s"})``.
    """

    name: str = "scenario"
    """Name in results and messages; the default of a file is its name."""
    description: str = ""
    """One sentence for lists and reports."""
    robot: Robot
    engine: Literal["native", "mujoco"] = "native"
    """Physics engine that integrates the motion of the robot; ``mujoco`` is an independent check.
    Former name of the key: ``plant``."""
    tool: str | None = None
    """Frame that is tracked and recorded."""
    epoch: Epoch | None = None
    """Time zero with its time scale: ``2024-03-01T12:00:00 UTC``. Default: the epoch of an element set."""
    earth: EarthPart | None = None
    """Orientation of the Earth. Default: IAU 2006 if there is an epoch."""
    orbit: Orbit | None = None
    """Reference orbit. Without an orbit there is no gravity."""
    environment: list[Effect] = Field(default_factory=list)
    """Effects besides the gravity of a point mass."""
    controller: Controller | None = None
    """Single controller. Default: no joint torques."""
    controllers: Annotated[list[AnyControl], Field(min_length=1)] | None = None
    """Several controllers, each with a joint group and a reference, instead of ``controller``."""
    reference: Reference | None = None
    """Reference of ``controller``. Default: the tool or the joints are held."""
    initial: InitialState = Field(default_factory=InitialState)
    """Initial state. Default: at rest in the neutral configuration."""
    simulation: SimulationSettings

    _file: Path | None = PrivateAttr(default=None)
    _lines: Lines = PrivateAttr(default_factory=dict)

    def __init__(self, **data: Any) -> None:
        """Validate the arguments; raises :class:`onorbit_rs.exceptions.ScenarioError`."""
        self._validate(data, None, {})

    @classmethod
    def checked(cls, data: dict[str, Any], file: Path | None, lines: Lines) -> Scenario:
        """Return the scenario of plain data; ``file`` and ``lines`` locate errors in the YAML."""
        scenario = cls.__new__(cls)
        scenario._validate(data, file, lines)
        if file is not None and "name" not in data:
            scenario.name = file.stem
        return scenario

    def _validate(self, data: dict[str, Any], file: Path | None, lines: Lines) -> None:
        former = ("plant",)
        if "plant" in data:
            if "engine" in data:
                message = "'plant' is the former name of 'engine'; give only 'engine'"
                raise scenario_error(message, file, lines.get(former), "plant")
            data = {"engine" if key == "plant" else key: value for key, value in data.items()}
            lines = lines | {("engine",): lines[former]} if former in lines else lines
        try:
            self.__pydantic_validator__.validate_python(data, self_instance=self)
        except ValidationError as error:
            raise first_error(error, data, file, lines) from None
        self._file, self._lines = file, lines

    @classmethod
    def _hint(cls, key: str, free: list[str]) -> str:
        """Return the hint for an unknown key: the section that accepts it, or the nearest key."""
        parts = {"orbit": get_args(AnyOrbit), "initial": [InitialState], "simulation": [SimulationSettings]}
        sections = [repr(name) for name, kinds in parts.items()
                    if key != "kind" and any(key in part.yaml_keys() for part in kinds)]  # fmt: skip
        return f"; it belongs in {' or '.join(sections)}" if sections else super()._hint(key, free)

    @property
    def file(self) -> Path | None:
        """The YAML file, or None for a scenario made in Python."""
        return self._file

    @property
    def folder(self) -> Path:
        """Folder of the YAML file, at which relative paths start."""
        return self._file.parent if self._file else Path()

    @property
    def gravity_mode(self) -> Literal["true", "carried"]:
        """Gravity mode of the orbit; ``true`` for orbits that have no such key."""
        return "carried" if getattr(self.orbit, "gravity_mode", None) == "carried" else "true"

    @property
    def laws(self) -> list[AnyController]:
        """Control laws of the run: those of ``controller`` or ``controllers``."""
        return [self.controller] if self.controller is not None else list(self.controllers or [])

    @property
    def tracked_tool(self) -> str | None:
        """Frame that is recorded: that of the scenario, otherwise the first tool among the controls."""
        tools = (getattr(control, "tool", None) for control in self.controllers or [])
        return self.tool or next(filter(None, tools), None)

    def line_of(self, *at: str | int) -> int | None:
        """Return the line of an entry in the YAML file, or of the nearest entry that contains it."""
        return line_of(at, self._lines)

    def resolved(self, folder: Path | None = None) -> dict[str, Any]:
        """Return the scenario as plain data in SI with all defaults; reading it gives the same scenario.

        Parameters
        ----------
        folder : path, optional
            If given, relative paths become absolute, starting at this folder.

        Returns
        -------
        dict
        """
        return self.model_dump(mode="json", by_alias=True, exclude_none=True, context=folder)

    @model_validator(mode="after")
    def _is_consistent(self) -> Scenario:
        check_control(self)
        check_engine(self)
        if self.orbit is None:
            for index, effect in enumerate(self.environment):
                if not isinstance(effect, BodyWrenchEffect):
                    what = effect.kind.replace("_", " ")
                    raise inconsistent(("environment", index), f"the {what} requires an orbit; add 'orbit'")
            if self.initial.frame != "world":
                raise inconsistent(
                    ("initial", "frame"),
                    f"frame {self.initial.frame} requires an orbit; add 'orbit' or use another frame",
                )
        return self
