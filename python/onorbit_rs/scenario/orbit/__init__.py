"""Reference orbits of scenarios.

To add a kind of orbit, write its class in a new file, and add the class to the union.
"""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BeforeValidator, Field

from onorbit_rs.scenario.orbit.conic import KeplerOrbit, NumericalOrbit
from onorbit_rs.scenario.orbit.custom_path import CustomPathOrbit
from onorbit_rs.scenario.orbit.fixed_frame import FixedFrameOrbit
from onorbit_rs.scenario.orbit.sgp4 import Sgp4Orbit
from onorbit_rs.scenario.part import of_kind

__all__ = [
    "AnyOrbit",
    "CustomPathOrbit",
    "FixedFrameOrbit",
    "KeplerOrbit",
    "NumericalOrbit",
    "Orbit",
    "Sgp4Orbit",
    "StartOrbit",
]


def _with_kind(value: Any) -> Any:
    """Return the data of an orbit, with the default ``kepler`` for ``kind``."""
    return {"kind": "kepler"} | value if isinstance(value, dict) else value


AnyOrbit = KeplerOrbit | NumericalOrbit | Sgp4Orbit | CustomPathOrbit | FixedFrameOrbit
Orbit = Annotated[AnyOrbit, Field(discriminator="kind"), of_kind(AnyOrbit), BeforeValidator(_with_kind)]

_AnyStart = KeplerOrbit | Sgp4Orbit
StartOrbit = Annotated[
    _AnyStart, Field(discriminator="kind"), of_kind(_AnyStart), BeforeValidator(_with_kind)
]
"""Orbit whose state at time zero is the initial state of a system."""
