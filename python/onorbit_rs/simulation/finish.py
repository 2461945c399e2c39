"""Writes the results of a run that reached its end, was stopped, or failed."""

from __future__ import annotations

import os
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from onorbit_rs.common.printable import shell_word
from onorbit_rs.exceptions import RunInterrupted, SimulationError
from onorbit_rs.output import (
    OutputFolder,
    has_checkpoint,
    summarize,
    summarize_world,
    write_pictures,
    write_summary,
    write_trace,
)
from onorbit_rs.output.clearance import add_clearances, clearance_arrays, found_clearances
from onorbit_rs.output.manifest import TRACE
from onorbit_rs.output.npz_reader import read_arrays
from onorbit_rs.output.streamed_trace import StreamedTrace, StreamedWorldTrace
from onorbit_rs.output.write import ALL, Outputs
from onorbit_rs.scenario.build import Built
from onorbit_rs.scenario.build_world import BuiltWorld
from onorbit_rs.scenario.divergence import divergence
from onorbit_rs.simulation.stop_signals import stopped_by

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from onorbit_rs._core import Trace, WorldTrace


def finished(
    trace: Trace | WorldTrace,
    built: Built | BuiltWorld,
    folder: OutputFolder | None,
    tell: Callable[[str], None],
    outputs: Outputs = ALL,
) -> dict[str, Any]:
    """Return the summary of a completed run with its certificate; write the results to ``folder``, if given.

    ``tell`` receives the name of each stage of the work.
    """
    tell("certificate")
    if folder is None:
        summary = _summary(trace, built)
        add_clearances(summary, found_clearances(trace, built))
        return summary
    with _noting(lambda: _not_written(folder)):
        summary = _summary(trace, built)
        found = found_clearances(trace, built)
        add_clearances(summary, found)
        tell("writing the trace")
        with folder.replacing() as files:
            write_trace(files, trace, built, clearance_arrays(found), compress=outputs.compress)
            write_summary(files, summary)
        # the columns remain mapped from the files of the checkpoint, also after these files are removed
        is_mapped = outputs.compress and os.name != "nt"
        if isinstance(trace, StreamedTrace | StreamedWorldTrace) and not is_mapped:
            with (folder.path / TRACE).open("rb") as stream:
                trace.read_from(read_arrays(stream, trusted=True))
    with _noting(lambda: f"trace and summary in {folder.path} are complete; {_not_drawn(folder)}"):
        write_pictures(folder, trace, summary, built, outputs, tell=tell)
    folder.discard_checkpoint()
    return summary


def _summary(
    trace: Trace | WorldTrace, built: Built | BuiltWorld, *, status: str = "complete"
) -> dict[str, Any]:
    if isinstance(built, BuiltWorld):
        return summarize_world(cast("WorldTrace", trace), built, status=status)
    return summarize(cast("Trace", trace), built, status=status)


@contextmanager
def _noting(results: Callable[[], str]) -> Iterator[None]:
    """Add a note to a ``KeyboardInterrupt`` in the block: which results exist, and how to complete them."""
    try:
        yield
    except KeyboardInterrupt as stop:
        stop.add_note(results())
        raise


def _not_written(folder: OutputFolder) -> str:
    word = shell_word(folder.path)
    if has_checkpoint(folder.path):
        return (
            f"the run ended, but the results in {folder.path} are incomplete; complete them with: "
            f"onorbit resume {word}"
        )
    return f"the run ended, but the results in {folder.path} are incomplete; repeat the run with --force"


def _not_drawn(folder: OutputFolder) -> str:
    """Return a note with the command that writes the figures and, if there is a checkpoint, the recording."""
    word = shell_word(folder.path)
    if has_checkpoint(folder.path):
        return f"figures and recording are not; write them with: onorbit resume {word}"
    return f"figures and recording are not; draw the figures with: onorbit report {word}"


def keep_failed(
    error: Exception, built: Built | BuiltWorld, folder: OutputFolder | None, outputs: Outputs = ALL
) -> None:
    """Write the rows of a run that failed with an error other than divergence, and add a note to the error.

    Nothing happens without ``folder`` or without rows.
    """
    trace = getattr(error, "trace", None)
    if folder is None or trace is None or len(trace) == 0:
        return
    try:
        _write_rows(trace, "failed", built, folder, compress=outputs.compress)
        folder.discard_checkpoint()
    except Exception as full:  # the error of the run is the one to report
        error.add_note(f"the rows recorded so far could not be written: {full}")
    else:
        error.add_note(f"the rows recorded so far are in {folder.path}")


def keep_stopped(
    stop: SimulationError | RunInterrupted,
    built: Built | BuiltWorld,
    folder: OutputFolder | None,
    tell: Callable[[str], None],
    outputs: Outputs = ALL,
) -> None:
    """Write the rows of a run that stopped early to ``folder``, if given.

    The message of ``stop`` then states the reason, the folder and, if the run can be resumed, the command.
    """
    if isinstance(stop, SimulationError):
        if isinstance(built, Built):
            stop.message = divergence(stop, built.scenario, built.model)
    else:
        duration = built.scenario.simulation.duration
        stop.message = f"stopped by {stopped_by(stop)[0]} at t = {stop.time:g} s of {duration:g} s"
    if folder is None:
        return
    try:
        _keep_rows(stop, built, folder, tell, outputs)
    except KeyboardInterrupt:  # again
        stop.message += f"; stopped again before all results were written to {folder.path}"
    except Exception as full:  # the end of the run is what the error reports
        stop.message += f"; the results could not be written completely: {full}"


def _keep_rows(
    stop: SimulationError | RunInterrupted,
    built: Built | BuiltWorld,
    folder: OutputFolder,
    tell: Callable[[str], None],
    outputs: Outputs,
) -> None:
    """Write the results of a run that stopped early; if it has no rows, remove its files instead."""
    if stop.trace is None or len(stop.trace) == 0:
        folder.discard()
        return
    diverged = isinstance(stop, SimulationError)
    status = "diverged" if diverged else "interrupted"
    summary = _write_rows(stop.trace, status, built, folder, compress=outputs.compress)
    stop.message += f"; the trace up to this time is in {folder.path}"
    if diverged:  # a diverged run is not drawn and cannot resume
        folder.discard_checkpoint()
        return
    if has_checkpoint(folder.path):
        stop.message += f"; continue with: onorbit resume {shell_word(folder.path)}"
    try:
        write_pictures(folder, stop.trace, summary, built, outputs, tell=tell)
    except KeyboardInterrupt:  # a second Ctrl-C: the run is already stopped
        word = shell_word(folder.path)
        stop.message += f"; some figures were not drawn; draw them with: onorbit report {word}"


def _write_rows(
    trace: Trace | WorldTrace, status: str, built: Built | BuiltWorld, folder: OutputFolder, *, compress: bool
) -> dict[str, Any]:
    """Write trace and summary of a run, and return the summary."""
    with np.errstate(all="ignore"):  # a diverged run contains numbers near the largest float
        summary = _summary(trace, built, status=status)
    with folder.replacing() as files:
        write_trace(files, trace, built, compress=compress)
        write_summary(files, summary)
    return summary
