"""What runs, but hardly as it was meant: warned of before the run, and kept in its summary."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs import _core
from onorbit_rs.exceptions import OnOrbitError
from onorbit_rs.scenario.path import CustomPathOrbit, Sgp4Orbit
from onorbit_rs.scenario.sampled_gains import sampled_too_slowly

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from onorbit_rs.scenario.schema import Scenario
    from onorbit_rs.scenario.trial import Flight

    Floats = NDArray[np.float64]

_NEAR = 1.0
"""A robot that drifts less than this, m, or than its own size, is where one expects it."""
_INSTANTS = 33
"""Of the run at which its reference is compared with free fall."""
_MOMENT = 0.05
"""Before and after the start, s: a central difference of places is good to `h² n³ r / 6`, 4 µm/s."""


def doubts(scenario: Scenario, flight: Flight, effects: Sequence[_core.Effect]) -> Iterator[str]:
    """In one line each, with the way out."""
    yield from _left_behind(scenario, flight, effects)
    yield from sampled_too_slowly(scenario, flight.model, flight.q)


def _left_behind(scenario: Scenario, flight: Flight, effects: Sequence[_core.Effect]) -> Iterator[str]:
    """That a robot will fall away from its reference, where nobody said that it shall.

    Free fall with the reference from its start, under the planet's point mass, Sun and Moon, against the
    reference itself. Where a field is on, whoever gave it has seen to that.
    """
    part, orbit = scenario.orbit, flight.orbit
    if not isinstance(part, (Sgp4Orbit, CustomPathOrbit)) or "gravity_mode" in part.model_fields_set:
        return
    if orbit is None or orbit.mu is None or any(isinstance(one, _core.GravityField) for one in effects):
        return
    duration = scenario.simulation.duration
    times = np.linspace(0.0, duration, _INSTANTS)
    others = [effect for effect in effects if isinstance(effect, _core.ThirdBody)]
    try:
        start, velocity = _leaving(orbit, is_sgp4=isinstance(part, Sgp4Orbit))
        fall = _core.Numerical(
            start, velocity, environment=others, earth=flight.earth, mu=orbit.mu,
            axes="TEME" if orbit.axes == "TEME" else "GCRF",
        ).state(times)[0]  # fmt: skip
    except OnOrbitError:  # into the ground, or beyond what is known of Sun and Moon: the run says so
        return
    drift = float(np.linalg.norm(np.asarray(fall) - np.asarray(orbit.state(times)[0]), axis=1).max())
    if drift > max(_NEAR, _size(flight)):
        yield (
            f"orbit: this {part.kind} reference does not fall freely in the gravity of a point mass, and the "
            f"robot, which does, will be {_distance(drift)} away from it within {duration:g} s: add a "
            "gravity_field to the environment, or take gravity_mode: carried (or true, if that is meant)"
        )


def _leaving(orbit: _core.Orbit, *, is_sgp4: bool) -> tuple[Floats, Floats]:
    """Place and velocity at the start; SGP4's own velocity is up to 1 m/s off the derivative of its place."""
    start, velocity = map(np.asarray, orbit.state(0.0))
    if is_sgp4:
        before, after = np.asarray(orbit.state(np.array([-_MOMENT, _MOMENT]))[0])
        velocity = (after - before) / (2.0 * _MOMENT)
    return start, velocity


def _size(flight: Flight) -> float:
    """Diagonal of the box around the robot's frames, m."""
    places = np.array([np.asarray(flight.model.frame_pose(flight.q, frame.name))[:3, 3]
                       for frame in flight.model.frames])  # fmt: skip
    return float(np.linalg.norm(np.ptp(places, axis=0))) if len(places) else 0.0


def _distance(metres: float) -> str:
    return f"{metres / 1e3:.3g} km" if metres >= 1e3 else f"{metres:.3g} m"
