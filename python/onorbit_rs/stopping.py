"""Which signal ended a run: Ctrl-C, or one that the command line turns into a ``KeyboardInterrupt``."""

from __future__ import annotations

import signal

from onorbit_rs.exceptions import RunInterrupted

_NAMED = ("SIGTERM", "SIGHUP")


def stopped_by(stop: BaseException) -> tuple[str, int]:
    """The name of the signal as messages say it, and the exit code of a command that it ended."""
    cause = stop.__cause__ if isinstance(stop, RunInterrupted) else stop
    name = str(cause) if isinstance(cause, KeyboardInterrupt) else ""
    if name in _NAMED:
        return name, 128 + signal.Signals[name]
    return "Ctrl-C", 128 + signal.SIGINT
