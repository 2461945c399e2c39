"""A run that the viewer shows while it goes on."""

from __future__ import annotations

from typing import TYPE_CHECKING

from onorbit_rs.output.relay import Relay

if TYPE_CHECKING:
    from onorbit_rs._core import Checkpoint, Trace
    from onorbit_rs.output import CheckpointWriter
    from onorbit_rs.progress import ProgressCallback
    from onorbit_rs.scenario.build import Built

CHECKPOINT_EVERY = 30.0
"""Wall-clock time between two checkpoints, s."""


def watched(
    built: Built,
    progress: ProgressCallback | None,
    checkpoint: CheckpointWriter | None = None,
    checkpoint_every: float = CHECKPOINT_EVERY,
    resume: Checkpoint | None = None,
) -> Trace:
    """Simulate while the viewer shows it."""
    from onorbit_rs.viewer.live import LOOK_EVERY_S, open_live
    from onorbit_rs.viewer.setting import Setting

    duration = built.scenario.simulation.duration
    live = open_live(Setting.of(built), duration)
    if live is None:
        return built.simulation.run(
            duration, progress=progress, checkpoint=checkpoint, checkpoint_every=checkpoint_every,
            resume=resume,
        )  # fmt: skip
    if resume is not None:
        live.take(resume.columns)
    relay = Relay(live, checkpoint, checkpoint_every)
    trace = None
    try:
        try:
            trace = built.simulation.run(
                duration, progress=progress, checkpoint=relay, checkpoint_every=LOOK_EVERY_S, resume=resume
            )
        except BaseException as own:
            try:
                relay.hand_on()
            except Exception as error:  # the run's own error is the one to tell
                own.add_note(f"its last rows could not be written either: {error}")
            raise
        relay.hand_on()
    finally:
        live.finish(trace)
    return trace
