"""The publishers of a node: rows, events and answers, with their recording."""

from __future__ import annotations

from collections.abc import Callable, Container, Iterable, Mapping
from typing import TYPE_CHECKING

from onorbit_rs.ros2.topics import EVENTS, EVENTS_TYPE, Topics, event_message, message_of_event

if TYPE_CHECKING:
    from onorbit_rs._core import EventRecord
    from onorbit_rs.ros2.participant import Participant
    from onorbit_rs.ros2.recording import Recording
    from onorbit_rs.ros2.rows import Rows


class Publisher:
    """Publishes the messages of a run on its topics."""

    def __init__(
        self,
        participant: Participant,
        topics: Topics,
        tell: Callable[[str], None],
        recording: Recording | None = None,
    ) -> None:
        """Create the publishers of all topics and publish what is latched; texts also go to ``tell``."""
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
        """Names and types of the topics."""
        latched = [(topic.name, topic.kind) for topic in self._topics.latched]
        return [*self._topics.names, *latched, (EVENTS, EVENTS_TYPE)]

    def rows(self, rows: Mapping[str, Rows]) -> None:
        """Publish the messages of the rows of each system, row by row, on topics that have subscribers."""
        if self._recording:
            self._recording.rows(rows)
        self._publish(rows, {name for name, writer in self._writers.items() if writer.subscribers()})

    def greet(self, present: Callable[[], Mapping[str, Rows]]) -> None:
        """Publish the messages of the present rows on topics that subscribers have joined since their rows.

        They are published a second time after a moment, because a subscriber that has not found the publisher
        yet does not receive the first.
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
        """Publish events such as captures."""
        for record in records:
            self._event(record.time, message_of_event(record))
            self._tell(f"{record.name}: {record.kind} at t = {record.time:.9g} s")

    def answer(self, time: float, level: int, name: str, text: str) -> None:
        """Publish an answer to a message at a simulated time, s."""
        self._event(time, event_message(time, name, level, text, {}))
        self._tell(f"{name}: {text}")

    def record(self, topic: str, kind: str, time: float, data: bytes) -> None:
        """Record a message that was obeyed, in CDR, at a simulated time, s; no effect without a recording."""
        if self._recording:
            self._recording.message(topic, kind, time, data)

    def _event(self, time: float, data: bytes) -> None:
        self._events.write(data)
        self.record(EVENTS, EVENTS_TYPE, time, data)
