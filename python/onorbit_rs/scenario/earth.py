"""When a run takes place, and how the Earth turns meanwhile."""

from __future__ import annotations

from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from pydantic import BeforeValidator, Field, model_validator

from onorbit_rs import _core
from onorbit_rs.exceptions import EarthError
from onorbit_rs.scenario.fields import Angle, AngularRate, FilePath, Time
from onorbit_rs.scenario.part import Part
from onorbit_rs.scenario.refusals import wrong

if TYPE_CHECKING:
    from onorbit_rs.scenario.schema import Scenario


def _epoch(value: object) -> str:
    if not isinstance(value, (str, datetime)):
        message = f"{value!r} is no instant, write one such as 2024-03-01T12:00:00 UTC"
        raise EarthError(message, name="epoch", got=value)
    epoch = _core.Earth(value, rotation="about_z").epoch  # refuses what is no instant
    assert epoch is not None  # it was given
    return value if isinstance(value, str) else epoch


Epoch = Annotated[str, BeforeValidator(_epoch)]


class EarthPart(Part):
    """How the Earth turns: as IAU 2006 has it, with measured UT1 and pole, or evenly about z."""

    rotation: Literal["iau2006", "about_z"] = "iau2006"
    ut1_minus_utc: Time | None = None
    polar_motion: Annotated[list[Angle], Field(min_length=2, max_length=2)] | None = None
    eop: FilePath | None = None
    """A file of Earth-orientation parameters, beside the scenario unless its path is absolute."""
    angle: Angle | None = None
    rate: AngularRate | None = None
    ephemeris: FilePath | None = None
    """A SPICE kernel with Sun and Moon, beside the scenario unless its path is absolute."""

    @model_validator(mode="after")
    def _is_one_rotation(self) -> EarthPart:
        is_even, iau = self.rotation == "about_z", (self.ut1_minus_utc, self.polar_motion, self.eop)
        if is_even and any(given is not None for given in iau):
            raise wrong("ut1_minus_utc, polar_motion and eop are for rotation: iau2006")
        if not is_even and (self.angle is not None or self.rate is not None):
            raise wrong("angle and rate are for rotation: about_z")
        if self.eop is not None and (self.ut1_minus_utc is not None or self.polar_motion is not None):
            raise wrong("give eop, or ut1_minus_utc and polar_motion, not both")
        return self


def make_earth(scenario: Scenario, orbit: _core.Orbit | None, beside: Path) -> _core.Earth | None:
    """The Earth of a run, in the axes of its orbit; its epoch is the element set's where there is no other.

    SGP4's positions are in TEME, 37 km on the ground from GCRF in 2024.
    """
    axes: Any = "GCRF" if orbit is None else orbit.axes
    epoch = scenario.epoch
    if epoch is None and isinstance(orbit, _core.Sgp4) and orbit.epoch >= FIRST_UTC:
        epoch = orbit.epoch
    if scenario.earth is None:
        return None if epoch is None else _core.Earth(epoch, axes=axes)
    given: dict[str, Any] = scenario.earth.model_dump(exclude_none=True)
    if scenario.earth.polar_motion is not None:
        given["polar_motion"] = np.array(scenario.earth.polar_motion)
    for name in ("eop", "ephemeris"):
        if name in given:
            given[name] = beside / given[name]
    return _core.Earth(epoch, axes=axes, **given)


FIRST_UTC = "1972"
"""Older element sets have no epoch that leap seconds lead to."""
