"""Builds the world of a scenario with several systems."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING

from onorbit_rs import _core
from onorbit_rs.common.coordinates import LINEAR, POSITION, QUATERNION
from onorbit_rs.common.rotations import matrix_from_quaternion
from onorbit_rs.common.suggestions import did_you_mean, nearest
from onorbit_rs.common.user_warnings import warn_user
from onorbit_rs.exceptions import ControlError, FrameError, OnOrbitError, SimulationError, WorldError
from onorbit_rs.relative import to_world
from onorbit_rs.scenario.build import (
    Built,
    Environment,
    build_actuators,
    build_around,
    build_effects,
    build_environment,
    check_record_every,
    check_robot,
    controlled,
)
from onorbit_rs.scenario.engine import build_world_engine
from onorbit_rs.scenario.environment.surfaces import build_surfaces
from onorbit_rs.scenario.events import split_path
from onorbit_rs.scenario.faults import Faults
from onorbit_rs.scenario.initial import Neighbour
from onorbit_rs.scenario.locations import located
from onorbit_rs.scenario.loops import closed_start
from onorbit_rs.scenario.settings import ControlSettings
from onorbit_rs.scenario.shape import MeshHull
from onorbit_rs.scenario.watches import build_watches
from onorbit_rs.scenario.world import WorldScenario

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from onorbit_rs.scenario.yaml_lines import Location

    Floats = NDArray[np.float64]


@dataclass(frozen=True)
class BuiltWorld:
    """A scenario with several systems and the objects that are built from it."""

    scenario: WorldScenario
    systems: dict[str, Built]
    """Objects of each system, by name; the simulation in each contains that system alone."""
    orbit: _core.Orbit | None
    earth: _core.Earth | None
    simulation: _core.Simulation
    """Simulation of all systems of the world."""
    warnings: tuple[str, ...] = ()
    """Warnings about valid settings that are probably not intended."""


def build_world(scenario: WorldScenario, *, runs_code: bool = True) -> BuiltWorld:
    """Return the world of a scenario; trial steps check each system alone and then the world.

    Raises
    ------
    OnOrbitError
        As for :func:`onorbit_rs.scenario.build.build`; errors of a system are located at its entry in
        ``systems``.
    """
    single = scenario.scenarios
    models, around = _parts(scenario, runs_code=runs_code)
    states = _initial_states(scenario, models, around)
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", ".* does not act on bodies")  # the world issues this warning
        systems, faults = {}, Faults()
        for name, alone in single.items():
            with faults.kept():
                own = around._replace(effects=build_effects(alone, models[name], runs_code=runs_code))
                systems[name] = build_around(alone, models[name], states[name], own, runs_code=runs_code)
        faults.check()

    def simulation() -> _core.Simulation:
        others = {name: Neighbour(built.model, built.q, built.v) for name, built in systems.items()}
        crafts = [
            _system(scenario, name, built, others, runs_code=runs_code) for name, built in systems.items()
        ]
        contacts = list(_contacts(scenario))
        with _located_event(scenario), _located_contact(scenario), _located_control(scenario):
            world = _core.World(
                crafts, orbit=around.orbit, earth=around.earth, gravity_mode=scenario.gravity_mode,
                environment=around.effects, contacts=contacts,
                events=[event.build() for event in scenario.events], rereference_beyond=drift,
            )  # fmt: skip
        with located(scenario, "engine"):
            engine = build_world_engine(scenario, models)
        with located(scenario, "simulation"):
            return _core.Simulation(world, engine=engine, **settings)

    settings = scenario.simulation.arguments()
    drift = settings.pop("rereference_beyond")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        _try_one_step(scenario, simulation())
        world = simulation()
    given = (f"systems: {warning.message}" for warning in caught)
    messages = tuple(dict.fromkeys([*_warnings(systems), *given]))
    for message in messages:
        if not _is_issued(scenario, message):
            warn_user(message)
    return BuiltWorld(scenario, systems, around.orbit, around.earth, world, messages)


def _parts(scenario: WorldScenario, *, runs_code: bool) -> tuple[dict[str, _core.Model], Environment]:
    """Return the robots, orbit, Earth and effects; the errors of all systems are raised together."""
    models: dict[str, _core.Model] = {}
    single, faults = scenario.scenarios, Faults()
    with faults.kept():
        check_record_every(next(iter(single.values())))
    for name, alone in single.items():
        with faults.kept():
            models[name] = alone.robot.build(alone)
            check_robot(alone, models[name])
    with faults.kept():
        around = build_environment(scenario, None, runs_code=runs_code)
    if len(models) == len(single):
        for check in (build_watches, _check_frames):
            with faults.kept():
                check(scenario, models)
    faults.check()
    return models, around


def _initial_states(
    scenario: WorldScenario, models: dict[str, _core.Model], around: Environment
) -> dict[str, tuple[Floats, Floats]]:
    """Return the initial configuration and velocity of every system."""
    states: dict[str, tuple[Floats, Floats]] = {}
    faults = Faults()
    for name in scenario.order:
        other = scenario.systems[name].initial.neighbour
        if other is None or other[0] in states:  # otherwise the error of the other system is raised
            with faults.kept():
                states[name] = _initial_state(scenario, name, models, states, around)
    faults.check()
    return states


def _initial_state(
    scenario: WorldScenario,
    name: str,
    models: dict[str, _core.Model],
    states: dict[str, tuple[Floats, Floats]],
    around: Environment,
) -> tuple[Floats, Floats]:
    """Return the initial configuration and velocity of a system, given the ``states`` of earlier ones."""
    alone = scenario.scenarios[name]
    initial, neighbour = alone.initial, None
    if initial.neighbour is not None:
        other, frame = initial.neighbour
        with located(alone, "initial", "frame"):
            _check_frame(models[other], frame)
        neighbour = Neighbour(models[other], *states[other])
    with located(alone, "initial"):
        q, v = initial.build(models[name], around.orbit, neighbour)
    q, v = closed_start(alone, models[name], q, v)
    if (part := scenario.systems[name].orbit) is not None and around.orbit is not None:
        with located(scenario, "systems", name, "orbit"):
            q[POSITION], velocity = to_world(around.orbit, part.build(alone.folder), earth=around.earth)
        v[LINEAR] = matrix_from_quaternion(q[QUATERNION]).T @ velocity
    return q, v


def _check_frames(scenario: WorldScenario, models: dict[str, _core.Model]) -> None:
    """Raise an error if a frame of a capture does not exist."""
    faults = Faults()
    for index, event in enumerate(scenario.events):
        for side, path in enumerate(event.do.capture or ()):
            system, frame = split_path(path)
            with faults.kept(), located(scenario, "events", index, "do", "capture", side):
                _check_frame(models[system], frame)
    faults.check()


def _check_frame(model: _core.Model, frame: str) -> None:
    known = [*model.frame_names, *model.body_names]
    if frame not in known:
        raise FrameError(
            f"no frame is named {frame!r}{did_you_mean(frame, known)}",
            name=frame, kind="frame", known=known, suggestion=nearest(frame, known),
        )  # fmt: skip


def _system(
    scenario: WorldScenario, name: str, built: Built, neighbours: dict[str, Neighbour], *, runs_code: bool
) -> _core.System:
    """Return the system ``name`` as an object of the engine, with new controllers."""
    alone = built.scenario
    controller, reference = controlled(
        alone, built.model, built.q, built.orbit, runs_code=runs_code, neighbours=neighbours
    )
    settings = alone.simulation.model_dump(include=set(ControlSettings.model_fields), exclude_none=True)
    actuators = build_actuators(alone, built.model)
    with located(alone, "robot"):
        return _core.System(
            name, built.model, built.q, built.v, controller=controller, reference=reference,
            tool=alone.tracked_tool, surfaces=build_surfaces(alone.surfaces),
            knows=scenario.systems[name].knows, actuators=actuators, **settings,
        )  # fmt: skip


def _contacts(scenario: WorldScenario) -> Iterator[_core.Contact]:
    """Yield the contacts as objects of the engine."""
    for index, contact in enumerate(scenario.contacts):
        with located(scenario, "contacts", index, "normal"):
            yield contact.build()


@contextmanager
def _located_event(scenario: WorldScenario) -> Iterator[None]:
    """Locate errors at the event that they name; otherwise at ``events``, or ``systems`` without events."""
    names = [event.name for event in scenario.events]
    at: Location = ("events",) if names else ("systems",)
    try:
        yield
    except WorldError as error:
        if error.name in names:
            at = ("events", names.index(error.name))
        with located(scenario, *at):
            raise
    except OnOrbitError:
        with located(scenario, *at):
            raise


@contextmanager
def _located_contact(scenario: WorldScenario) -> Iterator[None]:
    """Add the location of the links of a contact to errors that name the contact."""
    names = [contact.label for contact in scenario.contacts]
    try:
        yield
    except WorldError as error:
        if error.name not in names:
            raise
        with located(scenario, "contacts", names.index(error.name), "between"):
            raise


@contextmanager
def _located_control(scenario: WorldScenario) -> Iterator[None]:
    """Add the location of a control to errors that name it."""
    places: dict[str | None, Location] = {
        control.name: ("systems", name, "controllers", index)
        for name, system in scenario.systems.items()
        for index, control in enumerate(system.controllers or ())
    }
    try:
        yield
    except ControlError as error:
        if error.name not in places:
            raise
        with located(scenario, *places[error.name]):
            raise


def _try_one_step(scenario: WorldScenario, simulation: _core.Simulation) -> None:
    """Run one step, so that errors which would stop the run at once are raised before anything is written."""
    with located(scenario, "systems"), _located_contact(scenario), _located_control(scenario):
        try:
            simulation.run(scenario.simulation.time_step)
        except SimulationError as stop:
            stop.message = f"in the first step: {stop.message}"
            raise


def _is_issued(scenario: WorldScenario, message: str) -> bool:
    """Return True for a warning about a mesh of ``collision``, which was issued before, with its line."""
    return any(
        f"the collision mesh {alone.folder / extra.shape.file} of the link" in message
        for alone in scenario.scenarios.values()
        for extra in alone.collision
        if isinstance(extra.shape, MeshHull)
    )


def _warnings(systems: dict[str, Built]) -> Iterator[str]:
    """Yield the warnings of all systems; warnings about the common orbit may repeat and name no system."""
    for name, built in systems.items():
        for message in built.warnings:
            yield message if message.startswith("orbit:") else f"systems.{name}: {message}"
