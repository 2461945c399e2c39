"""Runs a simulation with bounded memory: rows are written to the output folder during the run."""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from onorbit_rs.exceptions import RunInterrupted
from onorbit_rs.scenario.build_world import BuiltWorld
from onorbit_rs.simulation.replay import Queue
from onorbit_rs.simulation.streamed_rows import StreamedRows
from onorbit_rs.simulation.world_columns import is_continued

if TYPE_CHECKING:
    from onorbit_rs._core import Checkpoint, Stepper
    from onorbit_rs.common.progress import ProgressCallback
    from onorbit_rs.output import CheckpointWriter
    from onorbit_rs.output.streamed_trace import StreamedTrace, StreamedWorldTrace
    from onorbit_rs.scenario.build import Built
    from onorbit_rs.simulation.command_format import Command

BLOCK = 16_384
"""Number of rows after which the rows in memory are written."""

_SAME_INSTANT = 1e-9
"""Largest difference of two times that are considered equal, as a fraction of a block."""

_SLICE_S = 0.05
"""Wall-clock time between two updates of the progress bar, s."""


def streamed(
    built: Built | BuiltWorld,
    progress: ProgressCallback | None,
    checkpoint: CheckpointWriter,
    checkpoint_every: float,
    resume: Checkpoint | None = None,
    *,
    commands: Sequence[Command] = (),
) -> StreamedTrace | StreamedWorldTrace:
    """Run a simulation, and write its rows to the output folder while it runs.

    The steps, the rows and the certificate are those of :meth:`onorbit_rs.Simulation.run`, to the last bit.

    Raises
    ------
    SimulationError, RunInterrupted
        As ``Simulation.run``; the attribute ``trace`` reads its rows from the folder.
    OutputFolderError
        If the last rows cannot be written.
    """
    settings = built.scenario.simulation
    stepper = built.simulation.start(
        duration=settings.duration, resume=resume, streamed=resume is None or is_bounded(built, resume)
    )
    rows = StreamedRows(stepper, checkpoint, built)
    try:
        queue = Queue(commands, stepper.time, step=settings.time_step)
        _advance(stepper, rows, queue, progress, (BLOCK * settings.time_step * settings.record_every,
                 settings.duration, checkpoint_every))  # fmt: skip
        return rows.trace_of(stepper.finish())
    except KeyboardInterrupt as signal:
        stop = signal if isinstance(signal, RunInterrupted) else _interrupted(stepper)
        try:
            rows.save()
        except Exception as error:
            stop.add_note(f"the last checkpoint could not be written: {error}")
        if stop.trace is not None:
            stop.trace = rows.trace_of(stop.trace)
        if stop is signal:
            raise
        raise stop from signal
    except Exception as error:
        ending: Any = getattr(error, "trace", None)
        if ending is not None and len(ending):
            error.trace = rows.trace_of(ending)  # type: ignore[attr-defined]
        raise


def is_bounded(built: Built | BuiltWorld, resume: Checkpoint) -> bool:
    """Return True if a run can be resumed from a checkpoint without all of its rows in memory."""
    return not isinstance(built, BuiltWorld) or is_continued(resume.columns, built.systems)


def _advance(
    stepper: Stepper,
    rows: StreamedRows,
    queue: Queue,
    progress: ProgressCallback | None,
    times: tuple[float, float, float],
) -> None:
    """Advance to the end; write the rows after each block of simulated time, and checkpoints in between.

    ``times`` are the length of a block and the end of the run, s, and the wall-clock time between two
    checkpoints, s.
    """
    block, duration, checkpoint_every = times
    moved, saved = stepper.time, time.monotonic()
    queue.apply_due(stepper)
    while stepper.time < duration:
        target = min(moved + block, duration)
        stepper.advance_to(queue.next_time(target), wall_s=_SLICE_S)
        queue.apply_due(stepper)
        if progress is not None:
            progress(stepper.time, duration)
        if time.monotonic() - saved >= checkpoint_every:
            rows.save()
            saved = time.monotonic()
        if stepper.time >= target - _SAME_INSTANT * block:
            rows.move()
            moved = stepper.time


def _interrupted(stepper: Stepper) -> RunInterrupted:
    message = f"the run was interrupted at t = {stepper.time:g} s"
    return RunInterrupted(message, time=stepper.time, trace=stepper.trace())
