"""Reference orbits of the engine from a checked scenario."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from onorbit_rs import _core
from onorbit_rs.omm import entries
from onorbit_rs.reading import read_text
from onorbit_rs.scenario.orbit import ConicOrbit, NumericalOrbit
from onorbit_rs.scenario.path import CustomPathOrbit, FixedFrameOrbit, Sgp4Orbit
from onorbit_rs.scenario.path_file import GROUPS, read_points, two_lines
from onorbit_rs.scenario.start import quaternion_of


def make_orbit(
    orbit: ConicOrbit | Sgp4Orbit | CustomPathOrbit | FixedFrameOrbit, beside: Path
) -> _core.Orbit:
    """The orbit; its files lie ``beside`` the scenario unless their paths are absolute.

    Of a numerical one the conic that it leaves from: see :func:`integrated`.
    """
    if isinstance(orbit, Sgp4Orbit):
        return _sgp4(orbit, beside)
    if isinstance(orbit, CustomPathOrbit):
        given = {name: getattr(orbit, name) for name in GROUPS}
        points = (
            {name: np.array(rows) for name, rows in given.items() if rows is not None}
            if orbit.file is None
            else read_points(beside / orbit.file)
        )
        return _core.CustomPath(**points, mu=orbit.mu, ends=orbit.ends)
    if isinstance(orbit, FixedFrameOrbit):
        attitude = quaternion_of(orbit.attitude)
        return _core.FixedFrame(position=np.array(orbit.position), attitude=attitude, mu=orbit.mu)
    given = orbit.given()
    if orbit.is_from_state:
        position, velocity = given.pop("position"), given.pop("velocity")
        return _core.Kepler.from_state(np.array(position), np.array(velocity), **given)
    return _core.Kepler(**given)


def integrated(
    part: Any, orbit: _core.Orbit | None, effects: list[_core.Effect], earth: _core.Earth | None
) -> _core.Orbit | None:
    """The orbit itself, or where it is a numerical one its integral in the gravity among the effects."""
    if not isinstance(part, NumericalOrbit) or orbit is None:
        return orbit
    gravity = [effect for effect in effects if isinstance(effect, (_core.GravityField, _core.ThirdBody))]
    return _core.Numerical.from_orbit(orbit, environment=gravity, earth=earth)


def _sgp4(orbit: Sgp4Orbit, beside: Path) -> _core.Sgp4:
    if orbit.omm_file is not None:
        message = entries(read_text(beside / orbit.omm_file), orbit.satellite)
        return _core.Sgp4.from_omm(message, gravity=orbit.gravity, propagator=orbit.propagator)
    if orbit.tle_file is not None:
        file = beside / orbit.tle_file
        lines = two_lines(read_text(file), str(file), orbit.satellite)
    elif orbit.tle is not None:
        lines = two_lines(orbit.tle, "tle", orbit.satellite)
    else:
        assert orbit.line1 is not None and orbit.line2 is not None  # the schema lets no other through
        lines = (orbit.line1, orbit.line2)
    return _core.Sgp4(
        *lines,
        gravity=orbit.gravity,
        check_checksum=orbit.check_checksum,
        propagator=orbit.propagator,
    )
