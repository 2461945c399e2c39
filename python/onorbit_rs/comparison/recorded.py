"""What is compared: the columns of a run, read from its folder or made now."""

from __future__ import annotations

import os
import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.exceptions import DtypeError, ModelError, NotFoundError
from onorbit_rs.files import exists
from onorbit_rs.output import with_absolute_paths
from onorbit_rs.output.manifest import SCENARIO, SUMMARY
from onorbit_rs.output.read import SavedRun
from onorbit_rs.robots.fingerprint import is_another
from onorbit_rs.running import Run, run
from onorbit_rs.scenario import Scenario
from onorbit_rs.scenario.make_robot import make_robot

if TYPE_CHECKING:
    from numpy.typing import NDArray

Source = str | os.PathLike[str] | Mapping[str, Any] | Scenario | Run
"""A folder that a run has written, a scenario as :func:`onorbit_rs.run` takes it, or a run."""


@dataclass(frozen=True)
class Recorded:
    """Columns of a run by their names in ``trace.npz``, and what robot it was."""

    name: str
    columns: dict[str, NDArray[np.float64]]
    scenario: Scenario
    run: Run | None = None
    """The one that is in memory."""
    fingerprint: str | None = None
    """Of its robot, as it was when it ran; runs of earlier versions have none."""

    @property
    def robot(self) -> Any:
        """As the resolved scenario has it."""
        named = with_absolute_paths(self.scenario)["robot"]
        return next(iter(named.values())) if len(named) == 1 else named

    def joint_names(self) -> list[str]:
        """In the order of the columns; those of a folder's run by its scenario's robot, read again.

        Raises
        ------
        OnOrbitError
            It is no longer there, cannot be read, or is another by now.
        """
        if self.run is not None:
            return list(self.run.model.joint_names)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # what the file is like was told when it ran
            model = make_robot(self.scenario)
        if is_another(model, self.fingerprint):
            raise ModelError(f"{self.robot} was changed since {self.name} was recorded", path=str(self.robot))
        return list(model.joint_names)


def recorded(source: Source) -> Recorded:
    """From a folder, a run, or a scenario that is run now.

    Raises
    ------
    DtypeError
        It is none of these, such as a trace without its run.
    NotFoundError, ReadError
        No run in the folder, or one that cannot be read or was changed since.
    """
    if isinstance(source, Run):
        return _of_run(source)
    if isinstance(source, (str, os.PathLike)) and Path(source).is_dir():
        return _of_folder(Path(source))
    if not isinstance(source, (str, os.PathLike, Mapping, Scenario)):
        kind = type(source).__name__
        raise DtypeError(
            f"a {kind} cannot be compared; give a folder of a run, a scenario, or what run returned",
            name="source", got=kind, expected="folder, scenario or Run",
        )  # fmt: skip
    return _of_run(run(source))


def on_the_other_plant(first: Recorded) -> Recorded:
    """The same scenario, moved by the other engine."""
    scenario = first.scenario
    other = {"native": "mujoco", "mujoco": "native"}[scenario.plant]
    return _of_run(run(with_absolute_paths(scenario) | {"plant": other}))


def _of_run(made: Run) -> Recorded:
    trace = made.trace
    columns = {name: np.asarray(getattr(trace, name)) for name in trace.columns()}
    name = f"{made.scenario.name} ({made.scenario.plant})" if made.out is None else str(made.out)
    return Recorded(name, columns, made.scenario, made, made.summary.get("robot_fingerprint"))


def _of_folder(folder: Path) -> Recorded:
    saved = SavedRun(folder)
    trace = saved.trace()
    if not exists(folder / SCENARIO):
        raise NotFoundError(f"no run in this folder (no {SCENARIO}): {folder}", path=str(folder), kind="run")
    columns = {name: np.asarray(getattr(trace, name), dtype=np.float64) for name in trace.columns()}
    known = saved.summary().get("robot_fingerprint") if exists(folder / SUMMARY) else None
    return Recorded(str(folder), columns, saved.scenario(), fingerprint=known)
