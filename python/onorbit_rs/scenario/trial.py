"""Trial step before the run, which detects errors that would stop the run at once and locates their keys."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from onorbit_rs import _core
from onorbit_rs.exceptions import (
    ControlError,
    EarthError,
    EffectError,
    FrameError,
    InputError,
    OnOrbitError,
    OrbitError,
    ShapeError,
    SimulationError,
    WorldError,
)
from onorbit_rs.scenario.divergence import divergence
from onorbit_rs.scenario.environment.surface_effects import SurfaceEffect
from onorbit_rs.scenario.locations import located
from onorbit_rs.scenario.schema import Scenario

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Flight:
    """Robot in its initial state, with the orbit and the Earth of the run."""

    model: _core.Model
    q: Floats
    v: Floats
    orbit: _core.Orbit | None
    earth: _core.Earth | None


@contextmanager
def about_controllers(scenario: Scenario) -> Iterator[None]:
    """Add file, line and key of the controllers to control and shape errors raised in the block."""
    try:
        yield
    except (ControlError, ShapeError):
        with located(scenario, "controller" if scenario.controllers is None else "controllers"):
            raise


@contextmanager
def about_start(scenario: Scenario) -> Iterator[None]:
    """Add file, line and key to input and world errors raised in the block.

    The key is ``initial`` for errors about ``q`` and ``v``, the entry of a brake or loop for errors about it,
    and ``simulation`` for all others.
    """
    try:
        yield
    except WorldError as error:
        brakes = [brake.brake for brake in scenario.actuators]
        index = next((i for i, name in enumerate(brakes) if f"brake '{name}'" in str(error)), None)
        with located(scenario, *(("simulation",) if index is None else ("actuators", index))):
            raise
    except InputError as error:
        names = [loop.name for loop in scenario.loops]
        at: tuple[str | int, ...] = ("initial" if error.name in ("q", "v") else "simulation",)
        if error.name in names:
            at = ("loops", names.index(error.name))
        with located(scenario, *at):
            raise


def try_one_step(scenario: Scenario, model: _core.Model, simulation: _core.Simulation) -> None:
    """Run one step, so that errors which would stop the run at once are raised before anything is written."""
    try:
        with about_controllers(scenario):
            simulation.run(scenario.simulation.time_step)
    except SimulationError as stop:
        stop.message = divergence(stop, scenario, model)
        with located(scenario, "simulation"):
            raise
    except OnOrbitError as error:
        is_about_orbit = isinstance(error, (OrbitError, EffectError)) and scenario.orbit is not None
        with located(scenario, "orbit" if is_about_orbit else "simulation"):
            raise


def try_effects(scenario: Scenario, effects: list[Any], flight: Flight) -> None:
    """Run one step with each drag or radiation-pressure effect alone, to locate its errors.

    Only errors about the Earth, effects and frames are raised.
    """
    for index, (part, effect) in enumerate(zip(scenario.environment, effects, strict=True)):
        if not isinstance(part, SurfaceEffect):
            continue
        with located(scenario, "environment", index), warnings.catch_warnings():
            warnings.simplefilter("ignore")  # the run itself issues these warnings
            try:
                alone = _core.Simulation(
                    flight.model, flight.q, flight.v, orbit=flight.orbit, earth=flight.earth,
                    environment=[effect], time_step=scenario.simulation.time_step,
                )  # fmt: skip
                alone.run(scenario.simulation.time_step)
            except OnOrbitError as error:
                if isinstance(error, (EarthError, EffectError, FrameError)):
                    raise
