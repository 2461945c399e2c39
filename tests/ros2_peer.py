"""A process that speaks DDS through CycloneDDS' own typed messages, driven by JSON lines on standard input.

It needs neither ROS nor rosbags nor this package, so it checks independently what is transmitted.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Sequence
from dataclasses import asdict, fields, is_dataclass
from typing import Any

from cyclonedds.core import DDSException, Policy, Qos
from cyclonedds.domain import Domain, DomainParticipant
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration
from ros2_types import TYPES

LOOPBACK = """<CycloneDDS><Domain id="any">
<General><Interfaces><NetworkInterface address="127.0.0.1" multicast="false"/></Interfaces>
<AllowMulticast>false</AllowMulticast></General>
<Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>32</MaxAutoParticipantIndex>
<SPDPInterval>100 ms</SPDPInterval><Peers><Peer address="127.0.0.1"/></Peers></Discovery>
</Domain></CycloneDDS>"""


def _qos(is_latched: bool) -> Qos:
    return Qos(
        Policy.Reliability.Reliable(duration(seconds=1)),
        Policy.Durability.TransientLocal if is_latched else Policy.Durability.Volatile,
        Policy.History.KeepLast(5000),
        Policy.DataRepresentation(use_cdrv0_representation=True),
    )


def _message(kind: Any, values: Any) -> Any:
    """Returns a message of nested dicts; fields that are not given are empty or zero."""
    built = {}
    hints = kind.__annotations__
    for field in fields(kind):
        hint = hints[field.name]
        value = values.get(field.name)
        if is_dataclass(hint):
            built[field.name] = _message(hint, value or {})
        elif (item := _item(hint)) is not None:
            given = value or []
            built[field.name] = [_message(item, one) if is_dataclass(item) else one for one in given]
        else:
            built[field.name] = value if value is not None else ("" if hint is str else 0)
    return kind(**built)


def _item(hint: Any) -> Any:
    """Returns the type of the items of a sequence; None for other types."""
    for part in getattr(hint, "__metadata__", ()):
        if hasattr(part, "subtype"):
            return part.subtype
    return None


class Peer:
    def __init__(self, domain: int) -> None:
        self.domain = Domain(domain, LOOPBACK)
        self.participant = DomainParticipant(domain)
        self.readers: dict[str, DataReader] = {}
        self.writers: dict[str, DataWriter] = {}
        self.met: set[tuple[str, bytes]] = set()

    def hear(self, topic: str, kind: str, is_latched: bool = False) -> None:
        """Subscribes to a topic, again if it was subscribed before; a leading slash marks a ROS topic."""
        name = f"rt{topic}" if topic.startswith("/") else topic
        named = Topic(self.participant, name, TYPES[kind])
        self.readers[topic] = DataReader(self.participant, named, qos=_qos(is_latched))
        self.met = {(name, key) for name, key in self.met if name != topic}

    def take(self, topic: str, count: int, seconds: float = 20.0) -> list[Any]:
        """Returns at least `count` messages, or those that arrive within `seconds`."""
        found: list[Any] = []
        end = time.monotonic() + seconds
        while True:
            taken = self.readers[topic].take(5000)
            found += [asdict(message) for message in taken if is_dataclass(message)]
            if len(found) >= count or time.monotonic() > end:
                return found
            time.sleep(0.002)

    def say(
        self, topic: str, kind: str, values: Any, seconds: float = 20.0, nodes: Sequence[list[int]] = (),
        times: int = 1,
    ) -> bool:  # fmt: skip
        """Sends a message as soon as there is a subscriber; returns false if none appears within `seconds`.

        If `nodes` are given, the subscriber must be one of them. Of several equal messages, all have arrived
        when the call returns true.
        """
        if topic not in self.writers:
            named = Topic(self.participant, f"rt{topic}", TYPES[kind])
            self.writers[topic] = DataWriter(self.participant, named, qos=_qos(False))
        writer = self.writers[topic]
        end = time.monotonic() + seconds
        while not (
            found := _known(writer.get_matched_subscriptions(), writer.get_matched_subscription_data, nodes)
        ):
            if time.monotonic() > end:
                return False
            time.sleep(0.002)
        self._meet(topic, found)
        for _ in range(times):
            writer.write(_message(TYPES[kind], values))
        return times == 1 or writer.wait_for_acks(duration(seconds=seconds))

    def publisher(
        self, topic: str, seconds: float = 20.0, nodes: Sequence[list[int]] = ()
    ) -> list[int] | None:
        """Returns the identity of a publisher of a subscribed topic; None if none appears within `seconds`.

        If `nodes` are given, the publisher must be one of them.
        """
        reader, end = self.readers[topic], time.monotonic() + seconds
        while True:
            found = _known(reader.get_matched_publications(), reader.get_matched_publication_data, nodes)
            if found or time.monotonic() > end:
                self._meet(topic, found)
                return list(found[0].key.bytes) if found else None
            time.sleep(0.002)

    def _meet(self, topic: str, found: list[Any]) -> None:
        """Waits 0.1 s if there are new endpoints, in which they also find that of this process.

        A reader finds a writer at another time than the writer finds the reader; a message that is sent in
        between is lost.
        """
        new = {(topic, one.key.bytes) for one in found} - self.met
        if new:
            time.sleep(0.1)
            self.met |= new


def _known(handles: list[int], data_of: Any, nodes: Sequence[list[int]]) -> list[Any]:
    """Returns the data of matched endpoints that belong to `nodes`, or of all if `nodes` is empty.

    A node of an earlier test may be leaving.
    """
    found = []
    for handle in handles:
        try:
            data = data_of(handle)
        except DDSException:  # it has left since it was listed
            continue
        if data is not None and (not nodes or list(data.participant_key.bytes) in nodes):
            found.append(data)
    return found


def main() -> None:
    peer = Peer(int(sys.argv[1]))
    for line in sys.stdin:
        name, options = json.loads(line)
        print(json.dumps(getattr(peer, name)(**options), default=list), flush=True)


if __name__ == "__main__":
    main()
