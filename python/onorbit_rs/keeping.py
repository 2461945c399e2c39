"""What is written of a run: of one that came to its end, was stopped, or failed."""

from __future__ import annotations

from contextlib import contextmanager
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
from onorbit_rs.printable import shell_word
from onorbit_rs.scenario.divergence import divergence
from onorbit_rs.stopping import stopped_by

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from onorbit_rs._core import Trace
    from onorbit_rs.scenario.build import Built


def finished(
    trace: Trace, built: Built, folder: OutputFolder | None, tell: Callable[[str], None]
) -> dict[str, Any]:
    """Certify a run that came to its end, and write its folder; returns its summary."""
    tell("certificate")
    if folder is None:
        return summarize(trace, built)
    with _noting(lambda: _not_written(folder)):
        summary = summarize(trace, built)
        tell("writing the trace")
        with folder.replacing() as files:
            write_trace(files, trace)
            write_summary(files, summary)
    with _noting(lambda: f"trace and summary are whole in {folder.path}; {_not_drawn(folder)}"):
        write_pictures(folder, trace, summary, built, tell=tell)
    folder.discard_checkpoint()
    return summary


@contextmanager
def _noting(what_is_there: Callable[[], str]) -> Iterator[None]:
    """A note on Ctrl-C within: what is there, and how to go on."""
    try:
        yield
    except KeyboardInterrupt as stop:
        stop.add_note(what_is_there())
        raise


def _not_written(folder: OutputFolder) -> str:
    word = shell_word(folder.path)
    if has_checkpoint(folder.path):
        return f"the run ended but not all of its results are in {folder.path}: onorbit resume {word}"
    return f"the run ended but not all of its results are in {folder.path}: run it again with --force"


def _not_drawn(folder: OutputFolder) -> str:
    """Which command completes a folder whose figures or recording were not written."""
    word = shell_word(folder.path)
    if has_checkpoint(folder.path):
        return f"figures and recording are not: write them with: onorbit resume {word}"
    return f"figures and recording are not: draw the figures with: onorbit report {word}"


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
        stop.message = divergence(stop, built.scenario, built.model)
    else:
        duration = built.scenario.simulation.duration
        stop.message = f"stopped by {stopped_by(stop)[0]} at t = {stop.time:g} s of {duration:g} s"
    if folder is None:
        return
    try:
        _keep_rows(stop, built, folder, tell)
    except KeyboardInterrupt:  # again
        stop.message += f"; stopped again before all of it was written to {folder.path}"
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
        return
    if has_checkpoint(folder.path):
        stop.message += f"; go on with: onorbit resume {shell_word(folder.path)}"
    try:
        write_pictures(folder, stop.trace, summary, built, tell=tell)
    except KeyboardInterrupt:  # again: the run is stopped already
        word = shell_word(folder.path)
        stop.message += f"; its figures were not all drawn: onorbit report {word} draws them"


def _write_rows(trace: Trace, status: str, built: Built, folder: OutputFolder) -> dict[str, Any]:
    """Trace and summary of a run, whole or not; returns the summary."""
    with np.errstate(all="ignore"):  # of one that diverged: numbers near the end of the range of floats
        summary = summarize(trace, built, status=status)
    with folder.replacing() as files:
        write_trace(files, trace)
        write_summary(files, summary)
    return summary
