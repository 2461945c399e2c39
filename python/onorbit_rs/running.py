"""One call from a scenario to results: :func:`run`."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.exceptions import RunInterrupted, SimulationError
from onorbit_rs.output import (
    OutputFolder,
    summarize,
    write_pictures,
    write_scenario,
    write_summary,
    write_trace,
)
from onorbit_rs.progress import progress_bar
from onorbit_rs.scenario import Scenario, load
from onorbit_rs.scenario.build import Built, build

if TYPE_CHECKING:
    from onorbit_rs._core import Model, Trace


@dataclass(frozen=True)
class Run:
    """What a run gave.

    ``trace`` has the columns, ``summary`` is the dict of ``summary.json``, ``out`` the folder or None.
    """

    trace: Trace
    summary: dict[str, Any]
    model: Model
    scenario: Scenario
    out: Path | None


def run(
    scenario: str | os.PathLike[str] | Mapping[str, Any] | Scenario,
    out: str | os.PathLike[str] | None = None,
    *,
    force: bool = False,
    quiet: bool = False,
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

    Raises
    ------
    OnOrbitError
        Before anything runs: a wrong scenario (``ScenarioError``), a missing file (``NotFoundError``), a
        folder that is not empty or not writable (``OutputFolderError``).
    SimulationError
        The run diverged; its trace so far is in the error and in ``out``.
    RunInterrupted
        Ctrl-C; its trace so far is in the exception and in ``out``.
    """
    checked = load(scenario)
    built = build(checked)
    folder = None if out is None else OutputFolder.claim(out, force=force)
    if folder is not None:
        write_scenario(folder, checked)
    try:
        trace = _simulate(built, quiet=quiet)
    except (SimulationError, RunInterrupted) as stop:
        _keep(stop, built, folder)
        raise
    summary = summarize(trace, checked, built.orbit, warnings=built.model.warnings)
    if folder is not None:
        write_trace(folder, trace)
        write_summary(folder, summary)
        write_pictures(folder, trace, summary, built)
    return Run(trace, summary, built.model, checked, folder.path if folder else None)


def _simulate(built: Built, *, quiet: bool) -> Trace:
    duration = built.scenario.simulation.duration
    with progress_bar(built.scenario.name, duration, quiet=quiet) as progress:
        return built.simulation.run(duration, progress=progress)


def _keep(stop: SimulationError | RunInterrupted, built: Built, folder: OutputFolder | None) -> None:
    """Write what there is of a run that stopped early, and say where."""
    diverged = isinstance(stop, SimulationError)
    if not diverged:
        duration = built.scenario.simulation.duration
        stop.message = f"stopped by Ctrl-C at t = {stop.time:g} s of {duration:g} s"
    if folder is None:
        return
    if stop.trace is None or len(stop.trace.time) == 0:
        folder.discard()
        return
    with np.errstate(all="ignore"):  # numbers near the end of the range of floats
        status = "diverged" if diverged else "interrupted"
        summary = summarize(
            stop.trace, built.scenario, built.orbit, status=status, warnings=built.model.warnings
        )
    write_trace(folder, stop.trace)
    write_summary(folder, summary)
    stop.message += f"; the trace so far is in {folder.path}"
    if not diverged:  # such numbers make no picture
        write_pictures(folder, stop.trace, summary, built)
