"""Messages that arrive on the command topics, in the order of sending, with their senders."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from onorbit_rs.ros2.endpoints import MOST, MOST_COUNTED
from onorbit_rs.ros2.entries import Entry, RefusedError
from onorbit_rs.ros2.messages import decode

if TYPE_CHECKING:
    from onorbit_rs.ros2.endpoints import Reader
    from onorbit_rs.ros2.participant import Participant


@dataclass
class Route:
    """A subscription, and the function that converts its messages to entries."""

    reader: Reader
    convert: Callable[[Any], list[Entry]]


@dataclass(frozen=True)
class Arrived:
    """A message that has arrived, with its entries or with the reason for its refusal."""

    topic: str
    kind: str
    data: bytes
    entries: list[Entry]
    refusal: str | None = None
    contested: tuple[str, ...] = ()
    """Targets of the message (controls, links or topics) to which another process has sent messages, too."""


class Inbox:
    """Subscriptions to the commands of all systems and of the run."""

    def __init__(self, participant: Participant) -> None:
        """Create an inbox without subscriptions."""
        self._participant = participant
        self._routes: list[Route] = []
        self._senders: dict[str, set[object]] = {}

    def subscribe(self, topic: str, kind: str, convert: Callable[[Any], list[Entry]]) -> None:
        """Subscribe to a topic, whose messages ``convert`` converts to entries."""
        self._routes.append(Route(self._participant.reader(topic, kind), convert))

    def topics(self) -> Iterator[tuple[str, str]]:
        """Yield the name and the type of each topic."""
        for route in self._routes:
            yield route.reader.topic, route.reader.kind

    def take(self) -> list[Arrived]:
        """Return the messages that have arrived since the last call, in the order in which they were sent.

        If more than 1000 have arrived on a topic, the newest 1000 are returned, after a refusal that states
        how many others there were.
        """
        taken, found = [], []
        for route in self._routes:
            samples = route.reader.take()
            if len(samples) > MOST:
                found.append(_overflow(route, len(samples)))
            taken += [(sent, route, publication, data) for sent, publication, data in samples[-MOST:]]
        for _, route, publication, data in sorted(taken, key=lambda message: message[0]):
            arrived = _arrived(route, data)
            found.append(
                replace(arrived, contested=self._contested(arrived, route.reader.sender(publication)))
            )
        return found

    def _contested(self, arrived: Arrived, sender: object) -> tuple[str, ...]:
        """Return the targets of a message to which another process has sent messages too.

        Only processes that still publish one of the topics count. Each process is reported once per target.
        """
        if sender is None:
            return ()
        targets = []
        for target in dict.fromkeys(_target(entry, arrived.topic) for entry in arrived.entries):
            senders = self._senders.setdefault(target, set())
            if sender in senders:
                continue
            if senders:
                senders &= set[object]().union(*(route.reader.senders() for route in self._routes))
            if senders:
                targets.append(target)
            senders.add(sender)
        return tuple(targets)


def _target(entry: Entry, topic: str) -> str:
    """Return the target of an entry: a control or a link by name, with its system, or else the topic."""
    name = entry.get("control", entry.get("body"))
    return topic if name is None else f"{name} of {entry['system']}"


def _overflow(route: Route, count: int) -> Arrived:
    """Return the refusal of the oldest of ``count`` messages that arrived since the topic was last read."""
    least = "at least " if count >= MOST_COUNTED else ""
    refusal = (
        f"{least}{count} messages arrived since the topic was last read, but the node processes at most "
        f"{MOST} at once, so it ignored {least}the oldest {count - MOST}; send fewer"
    )
    return Arrived(route.reader.topic, route.reader.kind, b"", [], refusal)


def _arrived(route: Route, data: bytes) -> Arrived:
    message = route.reader.topic, route.reader.kind, data
    try:
        content = decode(data, route.reader.kind)
    except Exception as error:  # the decoder raises errors of many types for malformed bytes
        return Arrived(
            *message, [], f"the message is malformed ({type(error).__name__}); send a {route.reader.kind}"
        )
    try:
        return Arrived(*message, route.convert(content))
    except RefusedError as refusal:
        return Arrived(*message, [], str(refusal))
