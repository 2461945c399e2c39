"""What is compared: the columns of a run, read from its folder or made now."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.exceptions import CompareError, NotFoundError, ReadError
from onorbit_rs.output import with_absolute_paths
from onorbit_rs.running import Run, run
from onorbit_rs.scenario import Scenario, load

if TYPE_CHECKING:
    from numpy.typing import NDArray

Source = str | os.PathLike[str] | Mapping[str, Any] | Scenario | Run
"""A folder that a run has written, a scenario as :func:`onorbit_rs.run` takes it, or a run."""

NEEDED = ("time", "q", "v", "tau", "momentum", "kinetic_energy")


@dataclass(frozen=True)
class Recorded:
    """Columns of a run by their names in ``trace.npz``, and what robot it was."""

    name: str
    columns: dict[str, NDArray[np.float64]]
    scenario: Scenario

    @property
    def robot(self) -> Any:
        """As the resolved scenario has it."""
        named = with_absolute_paths(self.scenario)["robot"]
        return next(iter(named.values())) if len(named) == 1 else named


def recorded(source: Source) -> Recorded:
    """From a folder, a run, or a scenario that is run now.

    Raises
    ------
    NotFoundError, ReadError
        No run in the folder, or one that cannot be read.
    """
    if isinstance(source, Run):
        return _of_run(source)
    if isinstance(source, (str, os.PathLike)) and Path(source).is_dir():
        return _of_folder(Path(source))
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
    return Recorded(name, columns, made.scenario)


def _of_folder(folder: Path) -> Recorded:
    file = folder / "trace.npz"
    for part in (file, folder / "scenario.yaml"):
        if not part.is_file():
            raise NotFoundError(
                f"no run in this folder (no {part.name}): {folder}", path=str(folder), kind="run"
            )
    try:
        with np.load(file, allow_pickle=False) as stored:
            columns = {name: np.asarray(stored[name], dtype=np.float64) for name in stored.files}
    except (OSError, ValueError, EOFError) as error:  # a zip that is none is a ValueError here
        raise ReadError(f"cannot read {file}: {error}", path=str(file), kind="trace") from error
    lacking = [name for name in NEEDED if name not in columns]
    if lacking:
        raise CompareError(f"{file} is no trace of a run: it lacks {', '.join(lacking)}", name=lacking[0])
    return Recorded(str(folder), columns, load(folder / "scenario.yaml"))
