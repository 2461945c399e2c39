"""Executes or rejects the messages that arrive, and answers them."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs.exceptions import OnOrbitError, OutputFolderError
from onorbit_rs.ros2.events import ERROR, OK, WARN
from onorbit_rs.ros2.messages import nanoseconds

if TYPE_CHECKING:
    from onorbit_rs.ros2.inbox import Arrived, Inbox
    from onorbit_rs.ros2.session import Session

_LATEST_S = 2**31 - 1
"""Largest time, s, in ``builtin_interfaces/Time``."""
_FAR_S = 3600.0
"""Time from now to the start of a trajectory, s, above which another clock probably stamped the message."""


class Orders:
    """Executes or rejects the messages of an inbox."""

    def __init__(
        self, session: Session, inbox: Inbox, on_reset: Callable[[], None], fixed: str | None
    ) -> None:
        """Store a session and its inbox.

        ``on_reset`` is called after each reset. ``fixed`` is the reason to reject resets; None allows them.
        """
        self._session, self._inbox = session, inbox
        self._on_reset, self._fixed = on_reset, fixed

    def execute(self) -> None:
        """Execute and record the messages that have arrived; answer invalid messages with the reason."""
        for arrived in self._inbox.take():
            if arrived.contested:
                text = (
                    f"several processes send to {', '.join(arrived.contested)}; the last message takes effect"
                )
                self._session.say(WARN, arrived.topic, text)
            if arrived.refusal is not None:
                self._refuse(arrived.topic, arrived.refusal)
            now = self._session.run.time
            if arrived.entries and self._execute(arrived):
                self._session.publisher.record(arrived.topic, arrived.kind, now, arrived.data)

    def _execute(self, arrived: Arrived) -> bool:
        """Execute the entries of a message, or reject all of them with an answer; return True if executed."""
        entry = arrived.entries[0]
        if "pause" in entry:
            return self._pause(arrived.topic, entry["pause"])
        if "reset" in entry:
            return self._reset(arrived.topic)
        if "step" in entry:
            return self._step(arrived.topic, entry["step"])
        return self._command(arrived)

    def _pause(self, topic: str, is_paused: bool) -> bool:
        session = self._session
        if session.pace == "stepped":
            session.say(WARN, topic, "/pause has no effect with pace stepped; the run advances only on /step")
            return False
        session.is_paused = is_paused
        session.publish_present()
        session.say(OK, topic, "paused" if is_paused else "running")
        return True

    def _reset(self, topic: str) -> bool:
        if self._fixed is not None:
            return self._refuse(topic, self._fixed)
        if not self._session.run.can_restart:
            return self._refuse(
                topic,
                "the state of a Python controller cannot be restored; give it get_state() and set_state()",
            )
        self._session.run.reset()
        self._on_reset()
        self._session.publish_present()
        self._session.say(OK, topic, "reset to t = 0 s")
        return True

    def _step(self, topic: str, length: float) -> bool:
        """Advance by a length of simulated time, s; return False if this is not possible."""
        session = self._session
        now = session.run.time
        if not session.is_waiting:
            return self._refuse(topic, "the run is not paused; use pace stepped, or /pause first")
        if not 0.0 < length < np.inf:
            return self._refuse(topic, f"the step is {length!r} s; it must be positive and finite")
        if min(now + length, session.run.end) > _LATEST_S:
            return self._refuse(
                topic, f"the step is {length!r} s; times of ROS end at {_LATEST_S} s, so give a shorter step"
            )
        if length < 1.0 and nanoseconds(now + length) == nanoseconds(now):
            return self._refuse(
                topic, f"the step is {length!r} s; the clock resolves 1e-09 s, so give a longer step"
            )
        session.advance_by(length)
        session.publish_present()
        session.say(OK, topic, f"advanced to t = {session.run.time:.9g} s")
        return True

    def _command(self, arrived: Arrived) -> bool:
        topic, entry, now = arrived.topic, arrived.entries[0], self._session.run.time
        try:
            self._session.run.command(arrived.entries)
        except OutputFolderError:  # it was executed, but the log is incomplete
            raise
        except OnOrbitError as error:
            return self._refuse(topic, str(error))
        if (start := entry.get("trajectory", {}).get("start", now)) > now + _FAR_S:
            text = f"the trajectory starts in {start - now:.9g} s; set use_sim_time in the node that sends it"
            self._session.say(WARN, topic, text)
        if "trigger" in entry:
            self._session.say(OK, topic, f"{entry['trigger']} is due at t = {now:.9g} s")
        return True

    def _refuse(self, topic: str, reason: str) -> bool:
        """Publish the answer that a message is rejected, with the reason; return False."""
        self._session.say(ERROR, topic, f"refused: {reason}")
        return False
