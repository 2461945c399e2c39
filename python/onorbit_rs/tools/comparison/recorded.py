"""Columns of a run to be compared, read from a folder, a run in memory, or a new simulation."""

from __future__ import annotations

import os
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.common.files import exists
from onorbit_rs.exceptions import DtypeError, ModelError, NotFoundError
from onorbit_rs.output import with_absolute_paths
from onorbit_rs.output.checks import LOOPS
from onorbit_rs.output.manifest import SCENARIO, SUMMARY
from onorbit_rs.output.read import SavedRun
from onorbit_rs.robots.fingerprint import has_changed
from onorbit_rs.scenario import Scenario, WorldScenario
from onorbit_rs.simulation.run import Run, run

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import EventRecord

Source = str | os.PathLike[str] | Mapping[str, Any] | Scenario | WorldScenario | Run
"""Output folder of a run, scenario as accepted by :func:`onorbit_rs.run`, or :class:`onorbit_rs.Run`."""


(OPENING,) = LOOPS


@dataclass(frozen=True)
class Recorded:
    """Recorded columns of one robot, by their names in ``trace.npz``, and the scenario of the run."""

    name: str
    columns: dict[str, NDArray[np.float64]]
    scenario: Scenario
    run: Run | None = None
    """The run if it is in memory; None for a folder."""
    fingerprint: str | None = None
    """Fingerprint of the robot at the time of the run; None for runs by earlier versions."""
    system: str | None = None
    """Name of the system in a run with several systems."""
    opening: float | None = None
    """Largest opening of loops and mimic joints during the run, m or rad; None without any."""

    @property
    def robot(self) -> Any:
        """The robot as given in the resolved scenario."""
        named = with_absolute_paths(self.scenario)["robot"]
        return next(iter(named.values())) if len(named) == 1 else named

    def joint_names(self) -> list[str]:
        """Return the joint names in column order; for a folder, the scenario's robot is loaded again.

        Raises
        ------
        OnOrbitError
            If the robot's file is missing, cannot be read or has changed.
        """
        if self.run is not None:
            model = self.run.model if self.system is None else self.run.models[self.system]
            return list(model.joint_names)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # these warnings were issued during the run
            model = self.scenario.robot.build(self.scenario)
        if has_changed(model, self.fingerprint):
            raise ModelError(
                f"the robot {self.robot} has changed since {self.name} was recorded; restore the robot, or "
                "run the scenario again",
                path=str(self.robot),
            )
        return list(model.joint_names)


@dataclass(frozen=True)
class RecordedWorld:
    """Columns of the systems of a run with several systems, and its events."""

    name: str
    systems: Mapping[str, Recorded]
    events: Sequence[EventRecord]
    scenario: WorldScenario


def recorded(source: Source) -> Recorded | RecordedWorld:
    """Return the recorded columns of a run, given the run, its folder, or a scenario to simulate.

    Raises
    ------
    DtypeError
        If the source has an unsupported type, such as a trace.
    NotFoundError, ReadError
        If the folder contains no run, or its files cannot be read or were changed.
    OnOrbitError
        As raised by :func:`onorbit_rs.run` for a scenario.
    """
    if isinstance(source, Run):
        return _of_run(source)
    if isinstance(source, (str, os.PathLike)) and Path(source).is_dir():
        return _of_folder(Path(source))
    if not isinstance(source, (str, os.PathLike, Mapping, Scenario, WorldScenario)):
        kind = type(source).__name__
        raise DtypeError(
            f"a value of type {kind} cannot be compared; give the folder of a run, a scenario, or a Run",
            name="source", got=kind, expected="folder, scenario or Run",
        )  # fmt: skip
    return _of_run(run(source))


def on_the_other_engine(first: Recorded | RecordedWorld) -> Recorded | RecordedWorld:
    """Simulate the same scenario on the other engine, and return its recorded columns."""
    scenario = first.scenario
    other = {"native": "mujoco", "mujoco": "native"}[scenario.engine]
    return _of_run(run(with_absolute_paths(scenario) | {"engine": other}))


def _of_run(made: Run) -> Recorded | RecordedWorld:
    trace, scenario = made.trace, made.scenario
    name = f"{scenario.name} ({scenario.engine})" if made.out is None else str(made.out)
    if isinstance(scenario, WorldScenario):
        return _of_world(name, trace, made.summary, scenario, made)
    return Recorded(
        name, _columns(trace), scenario, made, made.summary.get("robot_fingerprint"),
        opening=made.summary.get(OPENING),
    )  # fmt: skip


def _of_folder(folder: Path) -> Recorded | RecordedWorld:
    saved = SavedRun(folder)
    summary = saved.summary() if exists(folder / SUMMARY) else {}
    trace: Any = saved.world_trace() if "systems" in summary else saved.trace()
    if not exists(folder / SCENARIO):
        raise NotFoundError(
            f"no run in this folder ({SCENARIO} is missing): {folder}; give the output folder of a run",
            path=str(folder),
            kind="run",
        )
    scenario = saved.scenario()
    if isinstance(scenario, WorldScenario):
        return _of_world(str(folder), trace, summary, scenario)
    return Recorded(
        str(folder), _columns(trace), scenario, fingerprint=summary.get("robot_fingerprint"),
        opening=summary.get(OPENING),
    )  # fmt: skip


def _of_world(
    run_name: str, trace: Any, summary: dict[str, Any], scenario: WorldScenario, made: Run | None = None
) -> RecordedWorld:
    systems = {}
    for name, alone in scenario.scenarios.items():
        own = summary["systems"][name]
        systems[name] = Recorded(
            f"{run_name} ({name})", _columns(trace[name]), alone, made, own.get("robot_fingerprint"), name,
            own.get(OPENING),
        )  # fmt: skip
    return RecordedWorld(run_name, systems, trace.events, scenario)


def _columns(trace: Any) -> dict[str, NDArray[np.float64]]:
    return {name: np.asarray(getattr(trace, name), dtype=np.float64) for name in trace.columns()}
