"""What is written of a run: of one that came to its end, was stopped, or failed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.exceptions import RunInterrupted, SimulationError
from onorbit_rs.output import (
    OutputFolder,
    has_checkpoint,
    summarize,
    write_pictures,
    write_summary,
    write_trace,
)
from onorbit_rs.output.divergence import divergence
from onorbit_rs.printable import shell_word

if TYPE_CHECKING:
    from collections.abc import Callable

    from onorbit_rs._core import Trace
    from onorbit_rs.scenario.build import Built


def finished(
    trace: Trace, built: Built, folder: OutputFolder | None, tell: Callable[[str], None]
) -> dict[str, Any]:
    """Certify a run that came to its end, and write its folder; returns its summary."""
    tell("certificate")
    summary = summarize(trace, built)
    if folder is not None:
        tell("writing the trace")
        with folder.replacing() as files:
            write_trace(files, trace)
            write_summary(files, summary)
        write_pictures(folder, trace, summary, built, tell=tell)
        folder.discard_checkpoint()
    return summary


def keep_failed(error: Exception, built: Built, folder: OutputFolder | None) -> None:
    """Write the rows there are of a run that ended by an error other than its own divergence, and note it."""
    trace = getattr(error, "trace", None)
    if folder is None or trace is None or len(trace) == 0:
        return
    try:
        _write_rows(trace, "failed", built, folder)
        folder.discard_checkpoint()
    except Exception as full:  # the run's own error is the one to tell
        error.add_note(f"its rows could not be written: {full}")
    else:
        error.add_note(f"the rows so far are in {folder.path}")


def keep_stopped(
    stop: SimulationError | RunInterrupted,
    built: Built,
    folder: OutputFolder | None,
    tell: Callable[[str], None],
) -> None:
    """Write what there is of a run that stopped early, and say where."""
    if isinstance(stop, SimulationError):
        stop.message = divergence(stop, built)
    else:
        duration = built.scenario.simulation.duration
        stop.message = f"stopped by Ctrl-C at t = {stop.time:g} s of {duration:g} s"
    if folder is None:
        return
    try:
        _keep_rows(stop, built, folder, tell)
    except Exception as full:  # the run's own end is the one to tell
        stop.message += f"; not all of it could be written: {full}"


def _keep_rows(
    stop: SimulationError | RunInterrupted,
    built: Built,
    folder: OutputFolder,
    tell: Callable[[str], None],
) -> None:
    """The folder of a run that stopped early."""
    if stop.trace is None or len(stop.trace) == 0:
        folder.discard()
        return
    diverged = isinstance(stop, SimulationError)
    summary = _write_rows(stop.trace, "diverged" if diverged else "interrupted", built, folder)
    stop.message += f"; the trace so far is in {folder.path}"
    if diverged:  # such numbers make no picture, and there is nothing to go on to
        folder.discard_checkpoint()
    else:
        if has_checkpoint(folder.path):
            stop.message += f"; go on with: onorbit resume {shell_word(folder.path)}"
        write_pictures(folder, stop.trace, summary, built, tell=tell)


def _write_rows(trace: Trace, status: str, built: Built, folder: OutputFolder) -> dict[str, Any]:
    """Trace and summary of a run, whole or not; returns the summary."""
    with np.errstate(all="ignore"):  # of one that diverged: numbers near the end of the range of floats
        summary = summarize(trace, built, status=status)
    with folder.replacing() as files:
        write_trace(files, trace)
        write_summary(files, summary)
    return summary
