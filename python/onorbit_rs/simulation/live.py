"""Simulates a run while a viewer shows it, or while it is given commands."""

from __future__ import annotations

import time
import warnings
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from onorbit_rs.exceptions import ControlError, RunInterrupted
from onorbit_rs.scenario.build_world import BuiltWorld
from onorbit_rs.simulation.replay import Queue

if TYPE_CHECKING:
    from onorbit_rs._core import Checkpoint, Stepper, Trace, WorldTrace
    from onorbit_rs.common.progress import ProgressCallback
    from onorbit_rs.output import CheckpointWriter
    from onorbit_rs.scenario.build import Built
    from onorbit_rs.simulation.command_format import Command
    from onorbit_rs.viewer.live import View

CHECKPOINT_EVERY = 30.0
"""Wall-clock time between two checkpoints, s."""

UPDATE_EVERY_S = 0.5
"""Wall-clock time between two updates of the viewer, s."""

_SLICE_S = 0.05
"""Wall-clock time between two updates of the progress bar, s."""


def watched(
    built: Built | BuiltWorld,
    progress: ProgressCallback | None,
    checkpoint: CheckpointWriter | None = None,
    checkpoint_every: float = CHECKPOINT_EVERY,
    resume: Checkpoint | None = None,
    *,
    view: bool = True,
    commands: Sequence[Command] = (),
) -> Trace | WorldTrace:
    """Run a simulation and return its trace; apply ``commands`` and, with ``view``, show the run in a viewer.

    If no viewer is available, a warning is issued. The other arguments are those of ``Simulation.run``.
    """
    settings = built.scenario.simulation
    duration = settings.duration
    live = _opened(built, duration) if view else None
    if live is None and not commands:
        return built.simulation.run(
            duration, progress=progress, checkpoint=checkpoint, checkpoint_every=checkpoint_every,
            resume=resume,
        )  # fmt: skip
    rows = 0 if resume is None else _row_counts(resume.columns)
    saver = _Saver(checkpoint, checkpoint_every, rows)
    trace = None
    try:
        stepper = built.simulation.start(duration=duration, resume=resume)
        queue = Queue(commands, stepper.time, step=settings.time_step)
        _advance(stepper, duration, progress, live, saver, queue)
        trace = stepper.finish()
    finally:
        if live is not None:
            live.finish(trace)
    return trace


def _opened(built: Built | BuiltWorld, duration: float) -> View | None:
    """Open and return the viewer for a scenario; None, with a warning, if the viewer is not available."""
    from onorbit_rs.viewer import live, world_live
    from onorbit_rs.viewer.setting import Setting
    from onorbit_rs.viewer.world_setting import WorldSetting

    if isinstance(built, BuiltWorld):
        return world_live.open_world_live(WorldSetting.of(built), duration)
    return live.open_live(Setting.of(built), duration)


def _advance(
    stepper: Stepper,
    duration: float,
    progress: ProgressCallback | None,
    live: View | None,
    saver: _Saver,
    queue: Queue,
) -> None:
    """Advance to the end in slices of wall-clock time; in between, give commands, and show and save rows."""
    last = time.monotonic()
    try:
        queue.apply_due(stepper)
        while stepper.time < duration:
            stepper.advance_to(queue.next_time(duration), wall_s=_SLICE_S)
            queue.apply_due(stepper)
            if progress is not None:
                progress(stepper.time, duration)
            if live is not None and time.monotonic() - last >= UPDATE_EVERY_S:
                last = time.monotonic()
                live.take(stepper.columns(live.shown), stepper.events)
            saver.save_if_due(stepper)
    except KeyboardInterrupt as signal:
        stop = _interrupted(stepper, signal)
        try:
            saver.save(stepper)
        except Exception as error:
            stop.add_note(f"the last checkpoint could not be written: {error}")
        if stop is signal:
            raise
        raise stop from signal


def _interrupted(stepper: Stepper, signal: KeyboardInterrupt) -> RunInterrupted:
    """Return a RunInterrupted with the recorded rows; a signal raised during a step already is one."""
    if isinstance(signal, RunInterrupted):
        return signal
    message = f"the run was interrupted at t = {stepper.time:g} s"
    return RunInterrupted(message, time=stepper.time, trace=stepper.trace())


class _Saver:
    """Passes the checkpoints of a run to the writer, each with the rows since the previous checkpoint."""

    def __init__(self, writer: CheckpointWriter | None, every_s: float, rows: int | dict[str, int]) -> None:
        """Store writer and period; the first ``rows`` rows (in a world, by system) are already written."""
        self._writer, self._every_s, self._rows = writer, every_s, rows
        self._last = time.monotonic()

    def save_if_due(self, stepper: Stepper) -> None:
        if time.monotonic() - self._last >= self._every_s:
            self.save(stepper)

    def save(self, stepper: Stepper) -> None:
        """Write a checkpoint.

        If the controller cannot be saved, warn once and disable checkpoints for this run.
        """
        if self._writer is None:
            return
        try:
            checkpoint = stepper.checkpoint(self._rows)
        except ControlError as error:
            self._writer = None
            warnings.warn(f"checkpoints are disabled for this run: {error}", UserWarning, stacklevel=2)
            return
        self._last = time.monotonic()
        if self._writer(checkpoint):
            self._rows = _sum(self._rows, _row_counts(checkpoint.columns))


def _row_counts(columns: Mapping[str, Any]) -> int | dict[str, int]:
    """Return the number of recorded rows; in a world, a mapping from system names to numbers of rows."""
    split = ((*path.partition("/"), len(rows)) for path, rows in columns.items())
    counts = {system: rows for system, _, column, rows in split if column == "time"}
    return counts or len(columns.get("time", ()))


def _sum(a: int | dict[str, int], b: int | dict[str, int]) -> int | dict[str, int]:
    if isinstance(a, int) and isinstance(b, int):
        return a + b
    first, second = (
        {} if isinstance(rows, int) else rows for rows in (a, b)
    )  # 0 before the first checkpoint
    return {name: first.get(name, 0) + second.get(name, 0) for name in {**first, **second}}
