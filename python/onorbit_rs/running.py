"""One call from a scenario to results: :func:`run`; :func:`resume` goes on with one that was stopped."""

from __future__ import annotations

import os
import warnings
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from onorbit_rs.exceptions import InputError, ModelError, NotFoundError, RunInterrupted, SimulationError
from onorbit_rs.files import exists
from onorbit_rs.keeping import finished, keep_failed, keep_stopped
from onorbit_rs.output import (
    CheckpointWriter,
    OutputFolder,
    read_checkpoint,
    scenario_digest,
    with_absolute_paths,
    write_scenario,
)
from onorbit_rs.output.read import check_folder
from onorbit_rs.output.robot import CHANGED, was_changed
from onorbit_rs.plants import versions
from onorbit_rs.progress import doing, progress_bar
from onorbit_rs.reals import real
from onorbit_rs.scenario import Scenario, load
from onorbit_rs.scenario.build import Built, build
from onorbit_rs.scenario.make_robot import make_robot
from onorbit_rs.watching import CHECKPOINT_EVERY, watched

if TYPE_CHECKING:
    from onorbit_rs._core import Model, Trace


@dataclass(frozen=True)
class Run:
    """What a run gave.

    ``trace`` has the columns, ``summary`` is the dict of ``summary.json``, ``out`` the folder or None. A run
    pickles, for :mod:`multiprocessing`: its rows travel, its robot is read again when it is asked for.
    """

    trace: Trace
    summary: dict[str, Any]
    scenario: Scenario
    out: Path | None
    _ran: Model | None = field(default=None, repr=False, compare=False)
    """None after a journey."""

    def __reduce__(self) -> tuple[Any, ...]:
        """Data alone: ``multiprocessing.Pool`` waits for ever for what raises while it is unpickled."""
        return Run, (self.trace, self.summary, self.scenario, self.out)

    @cached_property
    def model(self) -> Model:
        """The robot that ran; of a run from another process as the scenario names it.

        Raises
        ------
        OnOrbitError
            Its file is gone or cannot be read, or was changed since (``ModelError``).
        """
        if self._ran is not None:
            return self._ran
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # what the robot's file is like was told when it ran
            model = make_robot(self.scenario)
        if was_changed(model, self.summary):
            raise ModelError(CHANGED)
        return model


def run(
    scenario: str | os.PathLike[str] | Mapping[str, Any] | Scenario,
    out: str | os.PathLike[str] | None = None,
    *,
    force: bool = False,
    quiet: bool = False,
    view: bool = False,
    checkpoint_every: float = CHECKPOINT_EVERY,
) -> Run:
    """Run a scenario and, if asked, write its folder.

    Parameters
    ----------
    scenario : str, path, mapping or Scenario
        A bundled name, a YAML file, its content, or one already read.
    out : str or path, optional
        Folder for trace, summary, figures and recording; None writes nothing.
    force : bool
        Replace the files of an earlier run in ``out``.
    quiet : bool
        No progress bar, even on a terminal.
    view : bool
        Watch it in the viewer while it runs; where there is no screen a warning says so.
    checkpoint_every : float
        Wall-clock time between two checkpoints in ``out``, s; :func:`resume` goes on from the last one.

    Raises
    ------
    OnOrbitError
        Before anything runs: a wrong scenario (``ScenarioError``), a missing file (``NotFoundError``), a
        folder that is not empty, not writable or in use by another process (``OutputFolderError``).
    SimulationError
        The run diverged; its trace so far is in the error and in ``out``.
    RunInterrupted
        Ctrl-C; its trace so far is in the exception and in ``out``.
    """
    every = _checked_period(checkpoint_every)
    checked = load(scenario)
    built = build(checked)
    if out is None:
        return _go(built, None, quiet=quiet, view=view)
    with OutputFolder.claim(out, force=force) as folder:
        write_scenario(folder, checked)
        writer = CheckpointWriter(folder, _digest(checked))
        return _go(built, folder, quiet=quiet, view=view, checkpoint=writer, checkpoint_every=every)


def resume(
    out: str | os.PathLike[str],
    *,
    quiet: bool = False,
    view: bool = False,
    checkpoint_every: float = CHECKPOINT_EVERY,
) -> Run:
    """Go on with a run that was killed or interrupted, to the same bits as if it had not been.

    Parameters
    ----------
    out : str or path
        The folder of the run: its ``scenario.yaml`` and its last checkpoint.
    quiet : bool
        No progress bar, even on a terminal.
    view : bool
        Watch it in the viewer, from its beginning.
    checkpoint_every : float
        Wall-clock time between two checkpoints, s.

    Raises
    ------
    CheckpointError
        Nothing to go on from: the run ended, or its scenario, robot or our version changed since.
    OnOrbitError
        As :func:`run`.
    """
    every = _checked_period(checkpoint_every)
    path = Path(out)
    check_folder(path)
    if not exists(path / "scenario.yaml"):
        raise NotFoundError(f"no run in this folder (no scenario.yaml): {path}", path=str(path), kind="run")
    with OutputFolder(path) as folder:
        folder.check_figures()
        scenario = load(path / "scenario.yaml")
        digest = _digest(scenario)
        saved = read_checkpoint(path, digest)
        writer = CheckpointWriter(folder, digest, after=saved)
        return _go(
            build(scenario), folder, quiet=quiet, view=view,
            checkpoint=writer, checkpoint_every=every, resume=saved.checkpoint,
        )  # fmt: skip


def _checked_period(checkpoint_every: float) -> float:
    """Before anything is written, and also where nothing is."""
    every = real(checkpoint_every)
    if every is None or every < 0.0:
        raise InputError(
            f"checkpoint_every is {checkpoint_every!r} s of wall clock, it must be finite, zero or positive",
            name="checkpoint_every", got=checkpoint_every, expected=">= 0",
        )  # fmt: skip
    return every


def _digest(scenario: Scenario) -> str:
    """Of the scenario, its files, and the plant: another version of it may round otherwise."""
    return scenario_digest(with_absolute_paths(scenario) | versions(scenario.plant))


def _go(
    built: Built, folder: OutputFolder | None, *, quiet: bool, view: bool = False, **checkpoints: Any
) -> Run:
    """Simulate, and write what came of it."""
    scenario, duration = built.scenario, built.scenario.simulation.duration
    try:
        with progress_bar(scenario.name, duration, quiet=quiet) as progress:
            if view:
                trace = watched(built, progress.move, **checkpoints)
            else:
                trace = built.simulation.run(duration, progress=progress.move, **checkpoints)
            summary = finished(trace, built, folder, progress.tell)
            return Run(trace, summary, scenario, folder.path if folder else None, built.model)
    except (SimulationError, RunInterrupted) as stop:
        with doing("stopped, writing what there is", quiet=quiet) as tell:
            keep_stopped(stop, built, folder, tell)
        raise
    except Exception as error:  # raised by a controller of the user's, or where orbit or environment end
        keep_failed(error, built, folder)
        raise
