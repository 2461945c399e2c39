"""Robots, rows and events of a run that has ended, read from its folder, its results or its trace."""

from __future__ import annotations

import os
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs._core import Model
from onorbit_rs.common.coordinates import JOINTS_Q
from onorbit_rs.common.counting import count
from onorbit_rs.exceptions import DtypeError, InputError, OnOrbitError
from onorbit_rs.output.read import SavedRun
from onorbit_rs.ros2.rows import Rows, rows_of_trace
from onorbit_rs.scenario import WorldScenario
from onorbit_rs.scenario.build import build_environment
from onorbit_rs.scenario.orbit import NumericalOrbit
from onorbit_rs.simulation.run import Run

if TYPE_CHECKING:
    from onorbit_rs._core import EventRecord, Orbit, Trace, WorldTrace

    Source = str | os.PathLike[str] | Run | Trace | WorldTrace
    Models = Model | Mapping[str, Model]


@dataclass(frozen=True)
class Recorded:
    """Data of a run from which its topics are computed."""

    models: Mapping[str, Model]
    rows: Mapping[str, Rows]
    events: Sequence[EventRecord]
    orbit: Orbit | None = None
    """Reference orbit; None if the run has none, for a trace alone, and if its data can no longer be read."""


def recorded(source: Source, models: Models | None = None) -> Recorded:
    """Return the robots, rows and events of a run, and its orbit.

    Parameters
    ----------
    source : str, path, Run, Trace or WorldTrace
        Folder of a run, or its results or trace.
    models : Model or mapping of str to Model, optional
        Robot of a trace, or robots by the name of the system; only with a trace.

    Raises
    ------
    InputError
        If the models of a trace are missing or are not those of its systems, or models are given for a run.
    DtypeError
        If ``source`` has another type.
    OnOrbitError
        If the folder or its robot cannot be read, or the robot has changed since the run.
    """
    if isinstance(source, (str, os.PathLike)):
        source = _read(Path(source))
    orbit = None
    if isinstance(source, Run):
        if models is not None:
            raise InputError("a run contains its robots; omit models", name="models", got=models)
        models = source.models if isinstance(source.scenario, WorldScenario) else source.model
        orbit = _orbit(source)
        source = source.trace
    if not hasattr(source, "time"):
        raise DtypeError(
            f"cannot export {type(source).__name__}; give the folder of a run, a Run or a trace",
            name="run", got=source, expected="a folder, Run, Trace or WorldTrace",
        )  # fmt: skip
    by_name = _by_name(source, models)
    _check_joints(source, by_name)
    return Recorded(by_name, rows_of_trace(source, by_name), getattr(source, "events", ()), orbit)


def _orbit(run: Run) -> Orbit | None:
    """Return the reference orbit of a run; None, with a warning, if its data cannot be read."""
    scenario = run.scenario
    if scenario.orbit is None:
        return None
    try:
        if not isinstance(scenario.orbit, NumericalOrbit):
            return scenario.orbit.build(scenario.folder)
        # its perturbations are those of the environment
        model = None if isinstance(scenario, WorldScenario) else run.model
        return build_environment(scenario, model, runs_code=False).orbit
    except OnOrbitError as error:
        warnings.warn(
            f"the reference orbit cannot be computed again ({error}); /orbit/twist therefore contains the "
            "angular rate r × v / r², which neglects the rotation of the orbital plane by perturbations",
            UserWarning, stacklevel=4,
        )  # fmt: skip
        return None


def _check_joints(trace: Any, models: Mapping[str, Model]) -> None:
    """Raise an InputError if the number of joints of a model differs from that in the trace."""
    for name, model in models.items():
        own = trace[name] if hasattr(trace, "names") else trace
        joints = np.asarray(own.q)[:, JOINTS_Q].shape[1]
        if joints != len(model.joint_names):
            whose = f"the model of system {name!r}" if hasattr(trace, "names") else "the model"
            raise InputError(
                f"{whose} has {count(len(model.joint_names), 'joint', 'joints')}, but the trace has "
                f"{joints}; give the model of the run",
                name="models", got=model, expected=f"a model with {count(joints, 'joint', 'joints')}",
            )  # fmt: skip


def _read(folder: Path) -> Run:
    saved = SavedRun(folder)
    summary, scenario = saved.summary(), saved.scenario()
    trace: Any = saved.world_trace() if isinstance(scenario, WorldScenario) else saved.trace()
    return Run(trace, summary, scenario, folder)


def _by_name(trace: Trace | WorldTrace, models: Models | None) -> Mapping[str, Model]:
    """Return the models by system; raise an InputError unless there is one for each system of the trace."""
    systems = list(getattr(trace, "names", ["robot"]))
    if isinstance(models, Model) and len(systems) == 1:
        return {systems[0]: models}
    if isinstance(models, Mapping) and sorted(models) == sorted(systems):
        return {name: models[name] for name in systems}
    expected = "a Model" if len(systems) == 1 else f"a mapping with the systems {', '.join(systems)}"
    given = "is not given" if models is None else f"is of type {type(models).__name__}"
    if isinstance(models, Mapping):
        given = f"has the keys {', '.join(map(repr, models))}" if models else "is empty"
    raise InputError(
        f"models {given}; a trace does not contain its robots, so give {expected}",
        name="models",
        got=models,
        expected=expected,
    )
