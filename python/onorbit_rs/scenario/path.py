"""Orbits of other kinds than Kepler's. A new kind is one class with its ``kind``, added to the union."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, model_validator

from onorbit_rs.scenario.fields import (
    Acceleration3,
    FilePath,
    GravitationalParameter,
    Length3,
    Number4,
    Positive,
    Speed3,
    Time,
)
from onorbit_rs.scenario.initial import Attitude
from onorbit_rs.scenario.orbit import KeplerOrbit, NumericalOrbit
from onorbit_rs.scenario.part import Part, of_kind
from onorbit_rs.scenario.refusals import wrong

Mu = Annotated[GravitationalParameter, Positive]
GravityMode = Annotated[
    Literal["true", "carried"],
    BeforeValidator(lambda value: "true" if value is True else value),  # YAML reads true as a boolean
]
"""``true``: the robot falls away from a reference that does not fall freely; ``carried``: it goes along."""


SatelliteName = Annotated[str, BeforeValidator(lambda value: str(value) if type(value) is int else value)]


def _text_of_lines(value: Any) -> Any:
    """The lines as one text; a list of them is answered with how YAML writes that."""
    if isinstance(value, list):
        raise wrong(
            "must be one text: write 'tle: |' and under it the two lines, indented, or give 'line1' and"
            " 'line2'"
        )
    return value


class Sgp4Orbit(Part):
    """An element set: two lines, their text, or a file with them; time zero is its epoch."""

    kind: Literal["sgp4"] = "sgp4"
    line1: str | None = None
    line2: str | None = None
    tle: Annotated[str, BeforeValidator(_text_of_lines)] | None = None
    """Two lines, or three with a name before them."""
    tle_file: FilePath | None = None
    omm_file: FilePath | None = None
    """A CCSDS Orbit Mean-Elements Message: JSON, XML, CSV or KVN."""
    satellite: SatelliteName | None = None
    """Selects one of several sets in ``tle``, ``tle_file`` or ``omm_file``, by name or catalogue number."""
    gravity: Literal["wgs72", "wgs72old", "wgs84"] = "wgs72"
    check_checksum: bool = True
    propagator: Literal["native", "reference"] = "native"
    """``reference`` reads and propagates the set with PyPI's ``sgp4``, to check the engine's SGP4."""
    gravity_mode: GravityMode = "true"

    @model_validator(mode="after")
    def _is_one_set(self) -> Sgp4Orbit:
        if (self.line1 is None) != (self.line2 is None):
            raise wrong("a TLE has two lines: give both 'line1' and 'line2'")
        names = ("line1", "tle", "tle_file", "omm_file")
        given = [name for name in names if getattr(self, name) is not None]
        if len(given) != 1:
            ways = "'line1' and 'line2', 'tle', 'tle_file' or 'omm_file'"
            raise wrong(f"give one element set, by {ways}; given: {', '.join(given) or 'none'}")
        if self.satellite is not None and self.line1 is not None:
            raise wrong("'line1' and 'line2' are of one satellite: leave out 'satellite'")
        return self


class CustomPathOrbit(Part):
    """A path through points given here or in a CSV file, with continuous acceleration."""

    kind: Literal["custom_path"] = "custom_path"
    times: list[Time] | None = None
    positions: list[Length3] | None = None
    velocities: list[Speed3] | None = None
    accelerations: list[Acceleration3] | None = None
    attitudes: list[Number4] | None = None
    """Quaternions xyzw: path axes to inertial ones."""
    file: FilePath | None = None
    """Columns ``t,x,y,z[,vx,vy,vz[,ax,ay,az]][,qx,qy,qz,qw]`` under a header, SI."""
    mu: Mu | None = None
    """Gravitational parameter, m³/s²; around no planet, without gravity, where not given."""
    ends: Literal["error", "coast"] = "error"
    gravity_mode: GravityMode = "true"

    @model_validator(mode="after")
    def _is_one_path(self) -> CustomPathOrbit:
        inline = [name for name in ("times", "positions") if getattr(self, name) is not None]
        if self.file is not None:
            extra = [name for name in ("velocities", "accelerations", "attitudes") if getattr(self, name)]
            if inline or extra:
                raise wrong(f"give 'file' or points, not both: {', '.join(inline + extra)}")
        elif len(inline) != 2:
            raise wrong("give 'times' and 'positions', or a 'file' with them")
        return self


class FixedFrameOrbit(Part):
    """A reference that stands still in inertial axes."""

    kind: Literal["fixed_frame"] = "fixed_frame"
    position: Length3 = Field(default_factory=lambda: [0.0, 0.0, 0.0])
    attitude: Attitude | None = None
    mu: Mu | None = None
    gravity_mode: GravityMode = "true"


def _with_kind(value: Any) -> Any:
    """An orbit that does not say its kind is Kepler's."""
    return {"kind": "kepler"} | value if isinstance(value, dict) else value


AnyOrbit = KeplerOrbit | NumericalOrbit | Sgp4Orbit | CustomPathOrbit | FixedFrameOrbit
Orbit = Annotated[AnyOrbit, Field(discriminator="kind"), of_kind(AnyOrbit), BeforeValidator(_with_kind)]
