"""Reads the data for the figures of a report from the folder of a run."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, NamedTuple, cast

from onorbit_rs.exceptions import OnOrbitError
from onorbit_rs.output.robot import CHANGED, was_changed
from onorbit_rs.scenario.connections import connections, touching
from onorbit_rs.scenario.environment.earth import build_earth

if TYPE_CHECKING:
    from onorbit_rs._core import Earth, Model, Orbit, WorldTrace
    from onorbit_rs.figures import Drawing, Subject
    from onorbit_rs.output.read import SavedRun
    from onorbit_rs.scenario import Scenario, WorldScenario


class OwnDrawing(NamedTuple):
    """A figure with its file name and the name of its system, which is empty for figures of all systems."""

    system: str
    name: str
    drawing: Drawing


def subject_of_run(
    saved: SavedRun, scenario: Scenario, summary: dict[str, Any], remarks: list[str]
) -> Subject:
    """Return the subject of the figures; add a remark if the robot or the orbit cannot be used."""
    from onorbit_rs import figures

    model = _robot(scenario, summary, remarks)
    return figures.subject_of(saved.trace(), scenario, model, *_around(saved, scenario, remarks))


def figures_of(subject: Subject, system: str) -> list[OwnDrawing]:
    """Return the figures of one robot; none if its trace has fewer than two rows.

    Their names begin with ``system``, if it is not empty.
    """
    from onorbit_rs import figures

    if len(subject.trace.time) < 2:
        return []
    prefix = f"{system}_" if system else ""
    return [OwnDrawing(system, prefix + drawing.name, drawing) for drawing in figures.drawings(subject)]


def world_figures(
    saved: SavedRun, scenario: WorldScenario, summary: dict[str, Any], remarks: list[str]
) -> list[OwnDrawing]:
    """Return the figures of all systems together, then those of each system.

    The list is empty if the systems share fewer than two rows.
    """
    from onorbit_rs import figures

    trace = cast("WorldTrace", saved.world_trace())
    if len(trace.time) < 2:
        return []
    single = scenario.scenarios
    around = _around(saved, next(iter(single.values())), remarks)
    models: dict[str, Model] = {}
    own: list[OwnDrawing] = []
    for name, alone in single.items():
        model = _robot(alone, summary["systems"].get(name, {}), remarks, f"{name}: ")
        if model is not None:
            models[name] = model
        subject = figures.subject_of(trace[name], alone, model, *around)
        own += figures_of(figures.with_fingers(subject, name, scenario, trace), name)
    whole = figures.WorldSubject(
        trace, models, figures.marks_of(summary), connections(scenario), touching(scenario, models)
    )
    shared = [OwnDrawing("", drawing.name, drawing) for drawing in figures.world_drawings(whole)]
    return [*shared, *own]


def _robot(scenario: Scenario, summary: dict[str, Any], remarks: list[str], system: str = "") -> Model | None:
    """Return the robot of a run; None, with a remark, if its file was changed or cannot be read."""
    with _remarked(remarks, f"{system}figures of the robot are omitted, because the robot could not be read"):
        model = scenario.robot.build(scenario)
        if not was_changed(model, summary):
            return model
        remarks.append(f"{system}figures of the robot are omitted: {CHANGED}")
    return None


def _around(saved: SavedRun, scenario: Scenario, remarks: list[str]) -> tuple[Orbit | None, Earth | None]:
    """Return the orbit and the Earth of a run; each is None if the scenario has none.

    One that cannot be read is None, too, and a remark is added. Without its orbit, the Earth is None, because
    its axes are those of the orbit.
    """
    orbit = earth = None
    with _remarked(remarks, "figures of the orbit are omitted, because the orbit could not be read"):
        orbit = None if scenario.orbit is None else scenario.orbit.build(saved.folder)
        with _remarked(remarks, "the ground track is omitted, because the Earth could not be read"):
            earth = build_earth(scenario.earth, scenario.epoch, orbit, saved.folder)
    return orbit, earth


@contextmanager
def _remarked(remarks: list[str], what: str) -> Iterator[None]:
    try:
        yield
    except OnOrbitError as error:
        remarks.append(f"{what} ({error})")
