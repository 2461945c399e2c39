"""Warnings about valid settings that are probably not intended; the summary of a run contains them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs import _core
from onorbit_rs.exceptions import OnOrbitError
from onorbit_rs.scenario.control.gain_warnings import gain_warnings
from onorbit_rs.scenario.orbit import CustomPathOrbit, Sgp4Orbit
from onorbit_rs.scenario.spring_warnings import spring_warnings

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from onorbit_rs.scenario.schema import Scenario
    from onorbit_rs.scenario.trial import Flight

    Floats = NDArray[np.float64]

_SMALL_DRIFT = 1.0
"""Smallest drift, m, that causes a warning; the drift must also exceed the size of the robot."""
_INSTANTS = 33
"""Number of times at which the reference is compared with free fall."""
_HALF_STEP = 0.05
"""Half step `h`, s, of the central difference of positions.

Its error is `h² n³ r / 6`, with mean motion `n` and radius `r`: 4 µm/s in a low orbit.
"""


def warnings_of(scenario: Scenario, flight: Flight, effects: Sequence[_core.Effect]) -> Iterator[str]:
    """Yield warnings about a scenario, each one line with a suggested fix."""
    yield from _drift_from_reference(scenario, flight, effects)
    yield from gain_warnings(scenario, flight.model, flight.q)
    yield from spring_warnings(scenario, flight.model, flight.q)


def _drift_from_reference(
    scenario: Scenario, flight: Flight, effects: Sequence[_core.Effect]
) -> Iterator[str]:
    """Yield a warning if the robot will drift from its reference although ``gravity_mode`` is not given.

    Compares the reference with free fall from its initial state in the gravity of the planet's point mass,
    the Sun and the Moon. If the effects include a gravity field, the drift is assumed to be intended.
    """
    part, orbit = scenario.orbit, flight.orbit
    if not isinstance(part, (Sgp4Orbit, CustomPathOrbit)) or "gravity_mode" in part.model_fields_set:
        return
    if orbit is None or orbit.mu is None or any(isinstance(effect, _core.GravityField) for effect in effects):
        return
    duration = scenario.simulation.duration
    times = np.linspace(0.0, duration, _INSTANTS)
    others = [effect for effect in effects if isinstance(effect, _core.ThirdBody)]
    try:
        start, velocity = _initial_state(orbit, is_sgp4=isinstance(part, Sgp4Orbit))
        fall = _core.Numerical(
            start, velocity, environment=others, earth=flight.earth, mu=orbit.mu,
            axes="TEME" if orbit.axes == "TEME" else "GCRF",
        ).state(times)[0]  # fmt: skip
    except OnOrbitError:  # impact, or no data of the Sun and the Moon; the run raises the same error
        return
    drift = float(np.linalg.norm(np.asarray(fall) - np.asarray(orbit.state(times)[0]), axis=1).max())
    if drift > max(_SMALL_DRIFT, _size(flight)):
        yield (
            f"orbit: this {part.kind} reference is not in free fall in the gravity of a point mass, but the "
            f"robot is, and will drift {_distance(drift)} from the reference in {duration:g} s; add a "
            "gravity_field to the environment, or set gravity_mode: carried; if the drift is intended, set "
            "gravity_mode: true"
        )


def _initial_state(orbit: _core.Orbit, *, is_sgp4: bool) -> tuple[Floats, Floats]:
    """Return the initial position, m, and its time derivative, m/s.

    The velocity that SGP4 reports differs from the derivative by up to 1 m/s and is therefore not used.
    """
    start, velocity = map(np.asarray, orbit.state(0.0))
    if is_sgp4:
        before, after = np.asarray(orbit.state(np.array([-_HALF_STEP, _HALF_STEP]))[0])
        velocity = (after - before) / (2.0 * _HALF_STEP)
    return start, velocity


def _size(flight: Flight) -> float:
    """Return the diagonal of the box around the robot's frames, m."""
    positions = np.array([np.asarray(flight.model.frame_pose(flight.q, frame.name))[:3, 3]
                       for frame in flight.model.frames])  # fmt: skip
    return float(np.linalg.norm(np.ptp(positions, axis=0))) if len(positions) else 0.0


def _distance(metres: float) -> str:
    return f"{metres / 1e3:.3g} km" if metres >= 1e3 else f"{metres:.3g} m"
