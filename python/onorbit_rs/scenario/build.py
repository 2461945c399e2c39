"""Objects of the engine from a checked scenario; what the engine refuses is told with its place in it."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs import _core
from onorbit_rs.scenario.doubts import doubts
from onorbit_rs.scenario.earth import make_earth
from onorbit_rs.scenario.make_control import control_of, group, law_of, tool_of, tracked_by
from onorbit_rs.scenario.make_orbit import integrated, make_orbit
from onorbit_rs.scenario.make_robot import make_robot
from onorbit_rs.scenario.place import dotted, located, scenario_error
from onorbit_rs.scenario.plant import make_plant
from onorbit_rs.scenario.reference import Start
from onorbit_rs.scenario.schema import Scenario
from onorbit_rs.scenario.start import initial_state
from onorbit_rs.scenario.trial import Flight, about_controllers, about_start, try_effects, try_one_step

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
    doubts: tuple[str, ...] = ()
    """What runs, but hardly as it was meant."""


def build(scenario: Scenario, *, runs_code: bool = True) -> Built:
    """Robot, orbit, start and simulation of a scenario, and one step as a trial; a run starts afresh.

    Warns of what runs, but hardly as it was meant. Without ``runs_code`` the source of controllers in Python
    is read and not run; stand-ins take their places, and what is built must not be run.

    Raises
    ------
    OnOrbitError
        The fitting subclass, with file, line and place before the engine's own words.
    """
    _check_rows(scenario)
    beside = scenario.file.parent if scenario.file else Path()
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
            effects.append(effect.make(model, beside))
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
    flight = Flight(model, q, v, orbit, earth)
    try_effects(scenario, effects, flight)
    with located(scenario, "plant"):
        plant = make_plant(scenario, model)
    settings = scenario.simulation.model_dump(exclude_none=True, exclude={"duration"})
    if settings["rereference_beyond"] == "never":
        settings["rereference_beyond"] = np.inf

    def simulation() -> tuple[_core.Simulation, Any]:
        controller, reference = _controlled(scenario, start, runs_code=runs_code)
        with located(scenario, "simulation"), about_start(scenario), about_controllers(scenario):
            made = _core.Simulation(
                model, q, v, orbit=orbit, earth=earth, gravity_mode=scenario.gravity_mode,
                environment=effects, controller=controller, reference=reference, tool=tool,
                plant=plant, **settings,
            )  # fmt: skip
        return made, reference

    # a controller in Python may remember its trial: the run gets another
    try_one_step(scenario, model, simulation()[0])
    doubtful = tuple(doubts(scenario, flight, effects))
    for doubt in doubtful:
        warnings.warn(doubt, stacklevel=2)
    return Built(scenario, model, orbit, earth, q, v, *simulation(), doubtful)


def _check_rows(scenario: Scenario) -> None:
    """Refuse a run of which its two ends alone would be recorded; folders of such runs are still read."""
    every, steps = scenario.simulation.record_every, scenario.simulation.steps
    if every > steps:
        at = ("simulation", "record_every")
        message = f"{every} is more than the {steps} steps of the run: take at most {steps}, for its two ends"
        raise scenario_error(message, scenario.file, scenario.line_of(*at), dotted(at))


def _controlled(scenario: Scenario, start: Start, *, runs_code: bool) -> tuple[Any, Any]:
    """The controllers, fresh, and what a single one tracks."""
    model, folder, tool = start.model, start.folder, scenario.tool
    if scenario.controller is not None:
        with located(scenario, "controller"):
            law = law_of(scenario.controller, tool, model, folder, runs_code=runs_code)
        with located(scenario, "reference"):
            return law, tracked_by(scenario.controller, scenario.reference, tool, start)
    controls = []
    for index, part in enumerate(scenario.controllers or []):
        at = ("controllers", index)
        with located(scenario, *at):
            joints = None if part.joints is None else group(part.joints, list(model.joint_names))
            law = law_of(part, tool_of(part, tool), model, folder, runs_code=runs_code)
        with located(scenario, *at, "reference"):
            within = replace(start, joints=None if joints is None else tuple(joints))
            tracked = tracked_by(part, part.reference, tool_of(part, tool), within)
        with located(scenario, *at):
            controls.append(control_of(part, law, tracked, joints))
    return controls or None, None
