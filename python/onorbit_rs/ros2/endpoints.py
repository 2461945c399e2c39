"""Publishers and subscriptions of single topics; their messages are bytes in CDR."""

from __future__ import annotations

import time
from typing import Any

from cyclonedds._clayer import ddspy_take, ddspy_write
from cyclonedds.core import DDSException, InstanceState, SampleState, ViewState

from onorbit_rs.exceptions import Ros2Error

MOST = 1000
"""Largest number of messages of a topic that are executed at once, and history depth of publishers."""
MOST_COUNTED = 100_000
"""Largest number of messages of a topic kept between two readings; those beyond ``MOST`` are only counted."""

_ANY = SampleState.Any | ViewState.Any | InstanceState.Any
_AGAIN_S = 0.2
"""Time, s, within which a new subscription finds a publisher that has already found the subscription."""


class Writer:
    """Publisher of one topic."""

    def __init__(self, entity: Any, topic: str) -> None:
        """Store a ``DataWriter`` of CycloneDDS and the name of its ROS topic."""
        self._entity, self.topic = entity, topic
        self._found = self._served = 0
        self._greetings: list[float] = []

    def write(self, data: bytes) -> None:
        """Publish a message, given in CDR.

        Raises
        ------
        Ros2Error
            If CycloneDDS does not accept the message.
        """
        if code := ddspy_write(self._entity._ref, data):
            raise _error(f"CycloneDDS did not accept a message for the topic {self.topic}", code)
        self._served = self._found

    def subscribers(self) -> int:
        """Return the number of subscriptions that receive the topic at present."""
        status = self._entity.get_publication_matched_status()
        self._found = status.total_count
        return int(status.current_count)

    def is_greeting_due(self) -> bool:
        """Return True when a subscription has joined since the last message, and once more 0.2 s later."""
        now = time.monotonic()
        if self.subscribers() and self._found > self._served:
            self._served = self._found
            self._greetings = [now, now + _AGAIN_S]
        due = [at for at in self._greetings if at <= now]
        self._greetings = self._greetings[len(due) :]
        return bool(due)


class Reader:
    """Subscription to one topic."""

    def __init__(self, entity: Any, topic: str, kind: str) -> None:
        """Store a ``DataReader`` of CycloneDDS, and the name and type of its ROS topic."""
        self._entity = entity
        self.topic, self.kind = topic, kind

    def sender(self, publication: int) -> object:
        """Return the identity of the process to which a publisher belongs; None if the publisher has left."""
        try:
            data = self._entity.get_matched_publication_data(publication)
        except DDSException:
            return None
        return None if data is None else data.participant_key

    def senders(self) -> set[object]:
        """Return the identities of the processes that publish the topic at present."""
        return {self.sender(publication) for publication in self._entity.get_matched_publications()}

    def take(self) -> list[tuple[int, int, bytes]]:
        """Return the messages since the last call: time of sending, ns, handle of the publisher, and CDR.

        At most the last 100 000 messages are kept.

        Raises
        ------
        Ros2Error
            If CycloneDDS reports an error.
        """
        found: list[tuple[int, int, bytes]] = []
        for _ in range(MOST_COUNTED // MOST):  # at once, it would allocate memory for the largest number
            taken = ddspy_take(self._entity._ref, _ANY, MOST)
            if isinstance(taken, int):
                raise _error(f"CycloneDDS could not read the messages of the topic {self.topic}", taken)
            # a sender that leaves adds a sample without data
            found += [
                (info.source_timestamp, info.publication_handle, data)
                for data, info in taken
                if info.valid_data
            ]
            if len(taken) < MOST:
                break
        return found


def _error(task: str, code: int) -> Ros2Error:
    """Return the error for a code that CycloneDDS returned."""
    reason = str(DDSException(code)).strip()
    return Ros2Error(f"{task}: {reason}; end the node and start it again", reason=reason)
