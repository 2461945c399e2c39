"""Objects of the engine from a checked scenario; what the engine refuses is told with its place in it."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs import _core, robots
from onorbit_rs.exceptions import (
    ControlError,
    EarthError,
    EffectError,
    FrameError,
    OnOrbitError,
    OrbitError,
    ShapeError,
)
from onorbit_rs.names import did_you_mean, nearest
from onorbit_rs.scenario.air_and_light import Covered, DragEffect, RadiationPressureEffect
from onorbit_rs.scenario.earth import make_earth
from onorbit_rs.scenario.environment import BodyWrenchEffect
from onorbit_rs.scenario.gravity_field import GravityFieldEffect
from onorbit_rs.scenario.make_control import control_of, group, law_of, tool_of, tracked_by
from onorbit_rs.scenario.make_orbit import integrated, make_orbit
from onorbit_rs.scenario.place import dotted, file_and_line
from onorbit_rs.scenario.plant import make_plant
from onorbit_rs.scenario.reference import Start
from onorbit_rs.scenario.schema import Scenario
from onorbit_rs.scenario.start import initial_state
from onorbit_rs.scenario.third_body import ThirdBodyEffect

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Built:
    """Everything a run needs."""

    scenario: Scenario
    model: _core.Model
    orbit: _core.Orbit | None
    earth: _core.Earth | None
    q: Floats
    v: Floats
    simulation: _core.Simulation
    reference: _core.Reference | _core.JointReference | None
    """What a single controller tracks."""


@dataclass(frozen=True)
class _Flight:
    """A robot on its way."""

    model: _core.Model
    q: Floats
    v: Floats
    orbit: _core.Orbit | None
    earth: _core.Earth | None


def build(scenario: Scenario) -> Built:
    """Robot, orbit, start and simulation of a scenario, and one step as a trial; a run starts afresh.

    Raises
    ------
    OnOrbitError
        The fitting subclass, with file, line and place before the engine's own words.
    """
    beside = scenario.file.parent if scenario.file else Path()
    with located(scenario, "robot"):
        model = make_robot(scenario)
    with located(scenario, "orbit"):
        orbit = None if scenario.orbit is None else make_orbit(scenario.orbit, beside)
    with located(scenario, "epoch" if scenario.earth is None else "earth"):
        earth = make_earth(scenario, orbit, beside)
        if earth is not None:
            earth.rotation(scenario.simulation.duration)  # its table may end before the run
    effects = []
    for index, effect in enumerate(scenario.environment):
        with located(scenario, "environment", index):
            effects.append(_effect(effect, model, beside))
    with located(scenario, "orbit"):
        orbit = integrated(scenario.orbit, orbit, effects, earth)
        if orbit is not None:
            orbit.state(scenario.simulation.duration)  # a path or a falling orbit may end before the run
    with located(scenario, "initial"):
        q, v = initial_state(scenario.initial, model, orbit)
    tool = scenario.tracked_tool
    with located(scenario, "tool"):
        tool_pose = None if tool is None else model.frame_pose(q, tool)
    start = Start(model, q, tool_pose, orbit, beside)
    _try_effects(scenario, effects, _Flight(model, q, v, orbit, earth))
    with located(scenario, "plant"):
        plant = make_plant(scenario, model)
    settings = scenario.simulation.model_dump(exclude_none=True, exclude={"duration"})
    if settings["rereference_beyond"] == "never":
        settings["rereference_beyond"] = np.inf

    def simulation() -> tuple[_core.Simulation, Any]:
        controller, reference = _controlled(scenario, start)
        with located(scenario, "simulation"), _about_controllers(scenario):
            made = _core.Simulation(
                model, q, v, orbit=orbit, earth=earth, gravity_mode=scenario.gravity_mode,
                environment=effects, controller=controller, reference=reference, tool=tool,
                plant=plant, **settings,
            )  # fmt: skip
        return made, reference

    _try_one_step(scenario, simulation()[0])  # a controller in Python may remember it: the run gets another
    return Built(scenario, model, orbit, earth, q, v, *simulation())


def _controlled(scenario: Scenario, start: Start) -> tuple[Any, Any]:
    """The controllers, fresh, and what a single one tracks."""
    model, folder, tool = start.model, start.folder, scenario.tool
    if scenario.controller is not None:
        with located(scenario, "controller"):
            law = law_of(scenario.controller, tool, model, folder)
        with located(scenario, "reference"):
            return law, tracked_by(scenario.controller, scenario.reference, tool, start)
    controls = []
    for index, part in enumerate(scenario.controllers or []):
        at = ("controllers", index)
        with located(scenario, *at):
            joints = None if part.joints is None else group(part.joints, list(model.joint_names))
            law = law_of(part, tool_of(part, tool), model, folder)
        with located(scenario, *at, "reference"):
            within = replace(start, joints=None if joints is None else tuple(joints))
            tracked = tracked_by(part, part.reference, tool_of(part, tool), within)
        with located(scenario, *at):
            controls.append(control_of(part, law, tracked, joints))
    return controls or None, None


@contextmanager
def _about_controllers(scenario: Scenario) -> Iterator[None]:
    """What is wrong with controllers that the engine puts together stands with them."""
    try:
        yield
    except (ControlError, ShapeError):
        with located(scenario, "controller" if scenario.controllers is None else "controllers"):
            raise


def _try_one_step(scenario: Scenario, simulation: _core.Simulation) -> None:
    """One step, thrown away: what would stop the run at once is told before anything is written."""
    try:
        with _about_controllers(scenario):
            simulation.run(scenario.simulation.time_step)
    except OnOrbitError as error:
        is_about_orbit = isinstance(error, (OrbitError, EffectError)) and scenario.orbit is not None
        with located(scenario, "orbit" if is_about_orbit else "simulation"):
            raise


def _try_effects(scenario: Scenario, effects: list[Any], flight: _Flight) -> None:
    """One step under air or light alone: what they refuse stands with them; the rest is told in its place."""
    for index, (part, effect) in enumerate(zip(scenario.environment, effects, strict=True)):
        if not isinstance(part, Covered):
            continue
        with located(scenario, "environment", index), warnings.catch_warnings():
            warnings.simplefilter("ignore")  # the run itself warns
            try:
                alone = _core.Simulation(
                    flight.model, flight.q, flight.v, orbit=flight.orbit, earth=flight.earth,
                    environment=[effect], time_step=scenario.simulation.time_step,
                )  # fmt: skip
                alone.run(scenario.simulation.time_step)
            except OnOrbitError as error:
                if isinstance(error, (EarthError, EffectError, FrameError)):
                    raise


@contextmanager
def located(scenario: Scenario, *at: str | int) -> Iterator[None]:
    """Put file, line and place before the message of an error of ours; its class stays."""
    try:
        yield
    except OnOrbitError as error:
        if getattr(error, "located", False):
            raise
        where = file_and_line(scenario.file, scenario.line_of(*at))
        error.message = f"{where}: {dotted(at)}: {error.message}"
        error.located = True  # type: ignore[attr-defined]  # set once, read above
        raise


def make_robot(scenario: Scenario) -> _core.Model:
    """The robot of a scenario."""
    robot = scenario.robot
    if robot.rigid_body is not None:
        return _core.Model.rigid_body(robot.rigid_body.mass, np.array(robot.rigid_body.inertia))
    if robot.bundled is not None:
        return robots.load(robot.bundled)
    assert robot.urdf is not None  # the schema lets exactly one through
    beside = scenario.file.parent if scenario.file else Path()
    packages = [beside / folder for folder in robot.package_paths]
    return _core.Model.from_urdf(
        beside / robot.urdf, package_paths=packages or None, xacro_arguments=robot.xacro_arguments or None
    )


def _effect(effect: Any, model: _core.Model, beside: Path) -> Any:
    if isinstance(effect, (DragEffect, GravityFieldEffect, RadiationPressureEffect, ThirdBodyEffect)):
        return effect.make(beside)
    if isinstance(effect, BodyWrenchEffect):
        bodies = list(model.body_names)
        if effect.body not in bodies:
            raise FrameError(
                f"no body is named {effect.body!r}{did_you_mean(effect.body, bodies)}",
                name=effect.body, kind="body", known=bodies, suggestion=nearest(effect.body, bodies),
            )  # fmt: skip
        times = {"start": effect.start} | ({} if effect.end is None else {"end": effect.end})
        return _core.BodyWrench(
            effect.body, force=np.array(effect.force), torque=np.array(effect.torque), **times
        )
    return _core.GravityGradient()
