"""The signal that stopped a run: Ctrl-C, or a signal that the command line handles like Ctrl-C."""

from __future__ import annotations

import signal

from onorbit_rs.exceptions import RunInterrupted

_NAMED = ("SIGTERM", "SIGHUP")


def stopped_by(stop: BaseException) -> tuple[str, int]:
    """Return the name of the signal for messages, and the exit code of a command ended by that signal."""
    cause = stop.__cause__ if isinstance(stop, RunInterrupted) else stop
    name = str(cause) if isinstance(cause, KeyboardInterrupt) else ""
    if name in _NAMED:
        return name, 128 + signal.Signals[name]
    return "Ctrl-C", 128 + signal.SIGINT
