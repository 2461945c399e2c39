"""Epoch of the run and orientation of the Earth."""

from __future__ import annotations

from datetime import datetime
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BeforeValidator, Field, model_validator

from onorbit_rs import _core
from onorbit_rs.exceptions import EarthError
from onorbit_rs.scenario.errors import invalid
from onorbit_rs.scenario.fields import Angle, AngularRate, FilePath, Time
from onorbit_rs.scenario.part import Part


def _epoch(value: object) -> str:
    if not isinstance(value, (str, datetime)):
        message = f"{value!r} is not an epoch; write an epoch such as 2024-03-01T12:00:00 UTC"
        raise EarthError(message, name="epoch", got=value)
    epoch = _core.Earth(value, rotation="about_z").epoch  # raises an error for an invalid epoch
    assert epoch is not None
    return value if isinstance(value, str) else epoch


Epoch = Annotated[str, BeforeValidator(_epoch)]


class EarthPart(Part):
    """Orientation of the Earth: IAU 2006, with UT1 and polar motion if given, or uniform rotation about z."""

    rotation: Literal["iau2006", "about_z"] = "iau2006"
    ut1_minus_utc: Time | None = None
    polar_motion: Annotated[list[Angle], Field(min_length=2, max_length=2)] | None = None
    eop: FilePath | None = None
    """File of Earth-orientation parameters, relative to the scenario."""
    angle: Angle | None = None
    rate: AngularRate | None = None
    ephemeris: FilePath | None = None
    """SPICE kernel with the Sun and the Moon, relative to the scenario."""

    @model_validator(mode="after")
    def _is_one_rotation(self) -> EarthPart:
        is_uniform = self.rotation == "about_z"
        other, keys = (
            ("iau2006", ("ut1_minus_utc", "polar_motion", "eop"))
            if is_uniform
            else ("about_z", ("angle", "rate"))
        )
        for key in keys:
            if getattr(self, key) is not None:
                raise invalid(f"{key} applies only to rotation: {other}; omit {key}, or set that rotation")
        if self.eop is not None and (self.ut1_minus_utc is not None or self.polar_motion is not None):
            raise invalid(
                "eop is given together with ut1_minus_utc or polar_motion, which the EOP file already "
                "contains; omit eop, or omit the other keys"
            )
        return self


def build_earth(
    earth: EarthPart | None, epoch: str | None, orbit: _core.Orbit | None, folder: Path
) -> _core.Earth | None:
    """Return the Earth of a run in the axes of its orbit; None if neither ``earth`` nor an epoch is given.

    Without ``epoch``, the epoch is that of an :class:`onorbit_rs.Sgp4` orbit, unless it is before 1972, when
    leap seconds began.

    SGP4's positions are in TEME, which in 2024 differs from GCRF by a rotation of 0.33 deg (37 km on the
    Earth's surface).
    """
    axes: Any = "GCRF" if orbit is None else orbit.axes
    if epoch is None and isinstance(orbit, _core.Sgp4) and orbit.epoch >= FIRST_UTC:
        epoch = orbit.epoch
    if earth is None:
        return None if epoch is None else _core.Earth(epoch, axes=axes)
    given: dict[str, Any] = earth.model_dump(exclude_none=True)
    if earth.polar_motion is not None:
        given["polar_motion"] = np.array(earth.polar_motion)
    for name in ("eop", "ephemeris"):
        if name in given:
            given[name] = folder / given[name]
    return _core.Earth(epoch, axes=axes, **given)


FIRST_UTC = "1972"
"""First date of UTC with leap seconds; epochs of older element sets cannot be converted."""
