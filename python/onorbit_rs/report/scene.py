"""Reads the scene of a run at one time from its folder."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from onorbit_rs.exceptions import ModelError
from onorbit_rs.output.robot import CHANGED, was_changed
from onorbit_rs.pictures import Scene
from onorbit_rs.pictures.scene import Member
from onorbit_rs.scenario import WorldScenario
from onorbit_rs.scenario.environment.earth import build_earth
from onorbit_rs.scenario.targets import path_frame, targets
from onorbit_rs.visuals.earth_shape import is_earth

if TYPE_CHECKING:
    from onorbit_rs._core import Trace
    from onorbit_rs.output.read import SavedRun
    from onorbit_rs.scenario import Scenario


def scene_of_run(saved: SavedRun, summary: dict[str, Any], at_s: float) -> Scene:
    """Return the scene of a run at the time ``at_s``, s.

    Raises
    ------
    OnOrbitError
        If the trace, the scenario, a robot, the orbit or the Earth cannot be read.
    ModelError
        If a robot has changed since the run.
    """
    scenario = saved.scenario()
    if isinstance(scenario, WorldScenario):
        single, trace, summaries = scenario.scenarios, saved.world_trace(), summary["systems"]
        members = [_member(one, trace[name], summaries[name]) for name, one in single.items()]
        first = next(iter(single.values()))
    else:
        members, first = [_member(scenario, saved.trace(), summary)], scenario
    orbit = None if first.orbit is None else first.orbit.build(saved.folder)
    earth = build_earth(first.earth, first.epoch, orbit, saved.folder)
    return Scene(members, at_s, earth, orbit is not None and is_earth(orbit.mu))


def _member(scenario: Scenario, trace: Trace, summary: dict[str, Any]) -> Member:
    """Return a robot of the run with its trace, its targets and the frame of its tool's path."""
    model = scenario.robot.build(scenario)
    if was_changed(model, summary):
        raise ModelError(f"the scene cannot be drawn: {CHANGED}")
    return Member(model, trace, targets(scenario), path_frame(scenario))
