"""Content of every scenario: name, engine, orbit and environment, and the locations of its entries."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Literal, Self

from pydantic import Field, PrivateAttr, ValidationError

from onorbit_rs.scenario.environment import Effect
from onorbit_rs.scenario.environment.earth import EarthPart, Epoch
from onorbit_rs.scenario.locations import scenario_error
from onorbit_rs.scenario.orbit import Orbit
from onorbit_rs.scenario.part import Part
from onorbit_rs.scenario.validation_errors import first_error
from onorbit_rs.scenario.watches import KeepOutZone, LeastDistance
from onorbit_rs.scenario.yaml_lines import Lines, Location, line_of


class Document(Part):
    """Base class of scenarios with the keys that do not describe a robot."""

    name: str = "scenario"
    """Name in results and messages. Default: the name of the file."""
    description: str = ""
    """Description in one sentence, for lists and reports."""
    engine: Literal["native", "mujoco"] = "native"
    """Physics engine that integrates the motion of the robot; ``mujoco`` is an independent check.
    The former name of this key is ``plant``."""
    epoch: Epoch | None = None
    """Time zero with its time scale: ``2024-03-01T12:00:00 UTC``. Default: the epoch of an SGP4 orbit, if it
    is not before 1972."""
    earth: EarthPart | None = None
    """Orientation of the Earth. Default: IAU 2006 if there is an epoch."""
    orbit: Orbit | None = None
    """Reference orbit. Without an orbit there is no gravity."""
    environment: list[Effect] = Field(default_factory=list)
    """Effects besides the gravity of a point mass."""
    keep_out: list[KeepOutZone] = Field(default_factory=list)
    """Zones that links must not enter. Entries are reported; no force acts."""
    distances: list[LeastDistance] = Field(default_factory=list)
    """Least distances between links, which are recorded. Overlaps are reported; no force acts."""

    _file: Path | None = PrivateAttr(default=None)
    _lines: Lines = PrivateAttr(default_factory=dict)

    def __init__(self, **data: Any) -> None:
        """Validate the arguments; raise :class:`onorbit_rs.exceptions.ScenarioError` if they are invalid."""
        self._validate(data, None, {})

    @classmethod
    def checked(cls, data: dict[str, Any], file: Path | None, lines: Lines) -> Self:
        """Return a validated scenario from plain data; ``file`` and ``lines`` locate errors in the YAML."""
        scenario = cls.__new__(cls)
        named = data if file is None or "name" in data else data | {"name": file.stem}
        scenario._validate(named, file, lines)
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

    @property
    def file(self) -> Path | None:
        """YAML file of the scenario; None for a scenario created in Python."""
        return self._file

    @property
    def folder(self) -> Path:
        """Folder of the YAML file; relative paths start there."""
        return self._file.parent if self._file else Path()

    @property
    def gravity_mode(self) -> Literal["true", "carried"]:
        """Gravity mode of the orbit; ``true`` for kinds of orbit without the key ``gravity_mode``."""
        return "carried" if getattr(self.orbit, "gravity_mode", None) == "carried" else "true"

    def location(self, *at: str | int) -> Location:
        """Return the location of an entry in the YAML file."""
        return at

    def line_of(self, *at: str | int) -> int | None:
        """Return the line of an entry in the YAML file, or of the nearest entry that contains it."""
        return line_of(self.location(*at), self._lines)

    def resolved(self, folder: Path | None = None) -> dict[str, Any]:
        """Return the scenario as plain data in SI with all defaults; loading them gives an equal scenario.

        Parameters
        ----------
        folder : path, optional
            If given, relative paths become absolute, starting at this folder.

        Returns
        -------
        dict
        """
        return self.model_dump(mode="json", by_alias=True, exclude_none=True, context=folder)
