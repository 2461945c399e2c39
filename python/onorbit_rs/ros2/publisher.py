"""Publishes the rows, events and answers of a node, and records them."""

from __future__ import annotations

from collections.abc import Callable, Container, Iterable, Mapping
from typing import TYPE_CHECKING

from onorbit_rs.common.event_kinds import OF_CONTACT
from onorbit_rs.common.printable import printable
from onorbit_rs.ros2.events import EVENTS, EVENTS_TYPE, event_message, message_of_event
from onorbit_rs.ros2.topics import Topics

if TYPE_CHECKING:
    from onorbit_rs._core import EventRecord
    from onorbit_rs.ros2.participant import Participant
    from onorbit_rs.ros2.recording import Recording
    from onorbit_rs.ros2.rows import Rows


class Publisher:
    """Publishes the messages of a run, and passes them to its recording if there is one."""

    def __init__(
        self,
        participant: Participant,
        topics: Topics,
        tell: Callable[[str], None],
        recording: Recording | None = None,
    ) -> None:
        """Create the publishers of all topics and publish the latched messages.

        ``tell`` is called with the text of each answer or warning, and of each event except touch-downs and
        lift-offs of contacts.
        """
        self._topics, self._tell, self._recording = topics, tell, recording
        self._writers = {name: participant.writer(name, kind) for name, kind in topics.names}
        for latched in topics.latched:
            participant.writer(latched.name, latched.kind, is_latched=True).write(latched.data)
        self._events = participant.writer(EVENTS, EVENTS_TYPE)

    @property
    def prefixes(self) -> Mapping[str, str]:
        """Prefix of the topics of each system."""
        return self._topics.prefixes

    @property
    def topics(self) -> list[tuple[str, str]]:
        """Names and types of the topics that are published."""
        latched = [(topic.name, topic.kind) for topic in self._topics.latched]
        return [*self._topics.names, *latched, (EVENTS, EVENTS_TYPE)]

    def rows(self, rows: Mapping[str, Rows]) -> None:
        """Record the rows of each system, and publish them, row by row, on topics that have subscribers."""
        if self._recording:
            self._recording.rows(rows)
        self._publish(rows, {name for name, writer in self._writers.items() if writer.subscribers()})

    def greet(self, present: Callable[[], Mapping[str, Rows]]) -> None:
        """Publish the present row on those topics that a subscriber has joined since their last message.

        The row is published again 0.2 s later, because a subscriber that has not found the publisher yet does
        not receive the first message. ``present`` is called only if there is such a subscriber.
        """
        if wanted := {name for name, writer in self._writers.items() if writer.is_greeting_due()}:
            self._publish(present(), wanted)

    def _publish(self, rows: Mapping[str, Rows], wanted: Container[str]) -> None:
        found = [(self._writers[topic.name], data) for topic, data in self._topics.messages(rows, wanted)]
        for k in range(max((len(data) for _, data in found), default=0)):
            for writer, data in found:
                if k < len(data):
                    writer.write(data[k].tobytes())

    def events(self, records: Iterable[EventRecord]) -> None:
        """Publish events; ``tell`` is called with the text of all but touch-downs and lift-offs."""
        for record in records:
            self._event(record.time, message_of_event(record))
            if record.kind not in OF_CONTACT:  # there may be thousands of touches
                self._tell(f"{record.name}: {record.kind} at t = {record.time:.9g} s")

    def answer(self, time: float, level: int, name: str, text: str) -> None:
        """Publish an answer to a message, or a warning, about ``name`` at a simulated time, s.

        Control characters are escaped, since the text may repeat what another program sent.
        """
        text = printable(text)
        self._event(time, event_message(time, name, level, text, {}))
        self._tell(f"{name}: {text}")

    def record(self, topic: str, kind: str, time: float, data: bytes) -> None:
        """Record a message, in CDR, of a simulated time, s; without a recording this has no effect."""
        if self._recording:
            self._recording.message(topic, kind, time, data)

    def _event(self, time: float, data: bytes) -> None:
        self._events.write(data)
        self.record(EVENTS, EVENTS_TYPE, time, data)
