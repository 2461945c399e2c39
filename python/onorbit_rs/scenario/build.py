"""Builds the objects of the engine from a scenario, and locates the engine's errors in the scenario."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from onorbit_rs import _core
from onorbit_rs.common.user_warnings import warn_user
from onorbit_rs.exceptions import EffectError
from onorbit_rs.scenario.control import GripForceController
from onorbit_rs.scenario.control.load import check_load, needs_load
from onorbit_rs.scenario.control.selection import joint_group, tool_of
from onorbit_rs.scenario.engine import build_engine
from onorbit_rs.scenario.environment import PythonEffect
from onorbit_rs.scenario.environment.earth import build_earth
from onorbit_rs.scenario.environment.surfaces import build_surfaces
from onorbit_rs.scenario.faults import Faults
from onorbit_rs.scenario.locations import dotted, located, scenario_error
from onorbit_rs.scenario.loops import closed_start
from onorbit_rs.scenario.orbit import NumericalOrbit
from onorbit_rs.scenario.reference.frame import moving_frame
from onorbit_rs.scenario.reference.start import Start
from onorbit_rs.scenario.schema import Scenario
from onorbit_rs.scenario.trial import Flight, about_controllers, about_start, try_effects, try_one_step
from onorbit_rs.scenario.warnings import warnings_of
from onorbit_rs.scenario.watches import build_watches

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs.scenario.initial import Neighbour
    from onorbit_rs.scenario.reference import AnyReference
    from onorbit_rs.scenario.world import WorldScenario

    Floats = NDArray[np.float64]
    State = tuple[Floats, Floats]


@dataclass(frozen=True)
class Built:
    """A scenario and the objects that are built from it: robot, initial state, environment, simulation."""

    scenario: Scenario
    model: _core.Model
    orbit: _core.Orbit | None
    earth: _core.Earth | None
    q: Floats
    v: Floats
    simulation: _core.Simulation
    reference: _core.Reference | _core.JointReference | None
    """Reference of a single controller; None for several controllers or without a reference."""
    warnings: tuple[str, ...] = ()
    """Warnings about valid settings that are probably not intended."""


class Environment(NamedTuple):
    """Orbit, Earth and effects of a run."""

    orbit: _core.Orbit | None
    earth: _core.Earth | None
    effects: list[_core.Effect]


def build(scenario: Scenario, *, runs_code: bool = True) -> Built:
    """Return the robot, orbit, initial state and simulation of a scenario, checked with a trial step.

    Valid settings that are probably not intended cause warnings. If ``runs_code`` is False, the source of
    controllers and effects in Python is inspected but not executed, and the simulation must not be run.

    Raises
    ------
    OnOrbitError
        A subclass for the kind of error; its message starts with file, line and key.
    """
    model, around, state = build_parts(scenario, runs_code=runs_code)
    state = closed_start(scenario, model, *state)
    built = build_around(scenario, model, state, around, runs_code=runs_code)
    for message in built.warnings:
        warn_user(message)
    return built


def build_parts(scenario: Scenario, *, runs_code: bool) -> tuple[_core.Model, Environment, State]:
    """Return the robot, the environment and the initial state; errors of all parts are raised together."""
    faults, model, around, state = Faults(), None, None, None
    with faults.kept():
        check_record_every(scenario)
    with faults.kept():
        model = scenario.robot.build(scenario)
    with faults.kept():
        around = build_environment(scenario, model, runs_code=runs_code)
    if model is not None:
        with faults.kept():
            build_watches(scenario, {"": model})
        with faults.kept(), located(scenario, "initial"):
            state = scenario.initial.build(model, None if around is None else around.orbit)
        with faults.kept():
            check_robot(scenario, model)
            if faults and around is not None:  # otherwise the controllers are checked when they are used
                q = None if state is None else state[0]
                controlled(scenario, model, q, around.orbit, runs_code=runs_code)
    faults.check()
    assert model is not None and around is not None and state is not None  # otherwise there is a fault
    return model, around, state


def build_around(
    scenario: Scenario,
    model: _core.Model,
    state: State,
    around: Environment,
    *,
    runs_code: bool,
) -> Built:
    """Return the objects of a scenario after a trial step, given its initial state and environment."""
    (q, v), (orbit, earth, effects) = state, around
    actuators = build_actuators(scenario, model)
    flight, faults = Flight(model, q, v, orbit, earth), Faults()
    with faults.kept():
        try_effects(scenario, effects, flight)
    with faults.kept(), located(scenario, "engine"):
        engine = build_engine(scenario, model)
    with faults.kept():
        controls = controlled(scenario, model, q, orbit, runs_code=runs_code)
    faults.check()

    def simulation(controller: Any, reference: Any) -> _core.Simulation:
        with located(scenario, "simulation"), about_start(scenario), about_controllers(scenario):
            return _core.Simulation(
                model, q, v, orbit=orbit, earth=earth, gravity_mode=scenario.gravity_mode,
                environment=effects, controller=controller, reference=reference,
                tool=scenario.tracked_tool, actuators=actuators, engine=engine,
                **scenario.simulation.arguments(),
            )  # fmt: skip

    try_one_step(scenario, model, simulation(*controls))
    messages = tuple(warnings_of(scenario, flight, effects))
    # a Python controller may keep state from the trial step, so the run gets a new controller
    controls = controlled(scenario, model, q, orbit, runs_code=runs_code)
    return Built(scenario, model, orbit, earth, q, v, simulation(*controls), controls[1], messages)


def check_robot(scenario: Scenario, model: _core.Model) -> None:
    """Raise an error if the tool, the surfaces or the actuators do not match the robot."""
    faults = Faults()
    with faults.kept(), located(scenario, *scenario.place_of_tool):
        if scenario.tracked_tool is not None:
            model.frame_pose(model.neutral(), scenario.tracked_tool)  # raises an error for an unknown frame
    with faults.kept():
        _check_surfaces(scenario, model)
    with faults.kept():
        build_actuators(scenario, model)
    faults.check()


def build_actuators(scenario: Scenario, model: _core.Model) -> list[_core.Brake]:
    """Return the actuators of the robot; errors are located at the entry of each."""
    found, faults = [], Faults()
    for index, actuator in enumerate(scenario.actuators):
        with faults.kept(), located(scenario, "actuators", index):
            found.append(actuator.build(model))
    faults.check()
    return found


def _check_surfaces(scenario: Scenario, model: _core.Model) -> None:
    """Raise an error if the surfaces do not match the robot's links, even if no effect uses the surfaces."""
    surfaces, bodies = scenario.surfaces, list(model.body_names)
    if surfaces is None:
        return
    with located(scenario, "surfaces"):
        if not isinstance(surfaces, dict) and surfaces.kind != "faces" and len(bodies) > 1:
            raise EffectError(
                f"a surface of kind {surfaces.kind} belongs to one body, but the robot has {len(bodies)} "
                f"bodies; give surfaces by link, such as {{{bodies[0]}: {{kind: {surfaces.kind}, …}}}}",
                name="surfaces",
            )
        at_rest = model.neutral(), np.zeros(model.nv)
        _core.World([_core.System("robot", model, *at_rest, surfaces=build_surfaces(surfaces))])


def build_environment(
    scenario: Scenario | WorldScenario, model: _core.Model | None, *, runs_code: bool = True
) -> Environment:
    """Return the orbit, the Earth and the effects; raise an error if their data end before the run ends.

    If ``runs_code`` is False, effects written in Python are inspected, not executed, and exert no wrenches.
    """
    duration, folder, faults = scenario.simulation.duration, scenario.folder, Faults()
    with faults.kept(), located(scenario, "orbit"):
        orbit = None if scenario.orbit is None else scenario.orbit.build(folder)
    if not faults:  # the epoch may be that of the orbit
        with faults.kept(), located(scenario, "epoch" if scenario.earth is None else "earth"):
            earth = build_earth(scenario.earth, scenario.epoch, orbit, folder)
            if earth is not None:
                earth.rotation(duration)  # raises an error if the table ends before the run
    with faults.kept():
        effects = build_effects(scenario, model, runs_code=runs_code)
    faults.check()
    with located(scenario, "orbit"):
        if isinstance(scenario.orbit, NumericalOrbit) and orbit is not None:
            orbit = scenario.orbit.integrate(orbit, effects, earth)
        if orbit is not None:
            orbit.state(duration)  # raises an error if a path or a decaying orbit ends before the run
    return Environment(orbit, earth, effects)


def build_effects(
    scenario: Scenario | WorldScenario, model: _core.Model | None, *, runs_code: bool = True
) -> list[_core.Effect]:
    """Return the effects; their links must exist on ``model``, unless it is None, as for a world.

    If ``runs_code`` is False, effects written in Python are inspected, not executed, and exert no wrenches.
    """
    effects: list[_core.Effect] = []
    faults = Faults()
    for index, effect in enumerate(scenario.effects):
        with faults.kept(), located(scenario, "environment", index):
            if isinstance(effect, PythonEffect) and not runs_code:
                effects.append(effect.inspect(scenario.folder))
            else:
                effects.append(effect.build(model, scenario.folder))
    faults.check()
    return effects


def check_record_every(scenario: Scenario) -> None:
    """Raise an error if ``record_every`` exceeds the number of steps.

    The schema does not check this, so that output folders of earlier runs with such a value remain readable.
    """
    every, steps = scenario.simulation.record_every, scenario.simulation.steps
    if every > steps:
        at = ("simulation", "record_every")
        message = (
            f"{every} exceeds the number of steps, {steps}; give at most {steps}, so that both the start and "
            "the end of the run are recorded"
        )
        raise scenario_error(message, scenario.file, scenario.line_of(*at), dotted(scenario.location(*at)))


def controlled(
    scenario: Scenario,
    model: _core.Model,
    q: Floats | None,
    orbit: _core.Orbit | None,
    *,
    runs_code: bool,
    neighbours: Mapping[str, Neighbour] | None = None,
) -> tuple[Any, Any]:
    """Return new controllers, or None, and the reference of a single controller, or None.

    ``neighbours`` are the systems of the world, by name. Without them, controls that require other systems
    are omitted. Without the initial configuration ``q``, (nq,), only the laws are built, for their errors.
    """
    is_alone = neighbours is None
    start = None if q is None else Start(model, q, orbit, scenario.folder, neighbours=neighbours or {})
    if scenario.controller is not None:
        if is_alone and (_is_moving(scenario.reference) or _grips(scenario.controller)):
            return None, None
        with located(scenario, "controller"):
            law = scenario.controller.build_law(model, scenario.tool, scenario.folder, runs_code=runs_code)
        with located(scenario, "reference"):
            placed = start and replace(start, tool=scenario.tool)
            return law, _reference(scenario.reference, placed)
    controls, faults = [], Faults()
    waiting = _waiting(scenario) if is_alone else set()
    for index, part in enumerate(scenario.controllers or []):
        if part.name in waiting:
            continue
        with faults.kept():
            controls.append(_control(scenario, model, index, start, runs_code=runs_code))
    faults.check()
    return controls or None, None


def _control(
    scenario: Scenario, model: _core.Model, index: int, start: Start | None, *, runs_code: bool
) -> Any:
    """Return an entry of ``controllers`` as an object of the engine; errors are located at its keys.

    Without ``start``, only the law is built.
    """
    part, at = (scenario.controllers or [])[index], ("controllers", index)
    with located(scenario, *at):
        joints = None if part.joints is None else joint_group(part.joints, list(model.joint_names))
        tool = tool_of(part, scenario.tool)
        law = part.build_law(model, tool, scenario.folder, runs_code=runs_code)
    if start is None:
        return law
    load: str | None = getattr(part, "load", None)
    with located(scenario, *at, "load"):
        check_load(load, start.neighbours)
    with located(scenario, *at, "reference"):
        group = None if joints is None else tuple(joints)
        reference = _reference(part.reference, replace(start, tool=tool, joints=group, load=load))
    with located(scenario, *at):
        return part.build_control(law, reference, joints)


def _is_moving(reference: Any) -> bool:
    """Return True if a reference is given in a frame of another system."""
    return moving_frame(getattr(reference, "frame", None)) is not None


def _grips(law: Any) -> bool:
    """Return True if a control law requires the contact forces of a world."""
    return isinstance(law, GripForceController)


def _waiting(scenario: Scenario) -> set[str]:
    """Return the names of the controls that require other systems.

    These controls start after an event, track or move a frame of another system, command the force of a
    capture, grip by contact forces, or start after such a control.
    """
    controls = scenario.controllers or []
    found = {
        str(part.name)
        for part in controls
        if _is_moving(part.reference) or needs_load(part, scenario.event_names) or _grips(part)
    }
    causes = {*scenario.event_names, *found}
    while new := {str(part.name) for part in controls if part.after in causes} - found:
        found |= new
        causes |= new
    return found


def _reference(
    part: AnyReference | None, start: Start | None
) -> _core.Reference | _core.JointReference | None:
    """Return the engine's reference object; None for a controller without a reference, or without a start."""
    return None if part is None or start is None else part.build(start)
