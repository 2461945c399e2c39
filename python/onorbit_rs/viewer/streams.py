"""Releases rerun's streams, each of which otherwise keeps two threads and its buffers.

rerun disconnects a stream that Python deletes, but releases its resources only at the next ``rr.init``. The
stream of a blueprint is never released, because the stream and its memory sink own each other (rerun-io/rerun
issue 2116).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import ParamSpec, TypeVar

import rerun as rr
import rerun.blueprint as rrb
import rerun_bindings

P = ParamSpec("P")
R = TypeVar("R")

APPLICATION = "onorbit"
"""Name under which the viewer stores layouts."""


def send_blueprint(recording: rr.RecordingStream, views: rrb.Blueprint) -> None:
    """Send the layout as ``recording.send_blueprint`` does, and disconnect the stream used for it."""
    carrier = rr.RecordingStream._from_native(
        rerun_bindings.new_blueprint(
            application_id=APPLICATION,
            make_default=False, make_thread_default=False, default_enabled=True,
        )
    )  # fmt: skip
    carrier.set_time("blueprint", sequence=0)
    views._log_to_stream(carrier)
    storage = rr.memory_recording(carrier).storage
    rerun_bindings.send_blueprint(storage, True, True, recording=recording.to_native())
    carrier.disconnect()  # disconnecting replaces the memory sink


def release_streams() -> None:
    """End the threads and free the memory of streams without references; streams in use are kept."""
    rerun_bindings.flush_and_cleanup_orphaned_recordings()


def releases_streams(write: Callable[P, R]) -> Callable[P, R]:
    """Decorate a function so that its streams are released after it returns and its variables are gone."""

    @wraps(write)
    def release_after(*args: P.args, **kwargs: P.kwargs) -> R:
        try:
            return write(*args, **kwargs)
        finally:
            release_streams()

    return release_after
