"""A DDS participant that ROS 2 nodes see as a node with publishers and subscriptions."""

from __future__ import annotations

import time
from typing import Any

from cyclonedds.builtin import BuiltinDataReader, BuiltinTopicDcpsPublication
from cyclonedds.core import DDSException, Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration

from onorbit_rs.ros2 import graph
from onorbit_rs.ros2.dds_types import declared
from onorbit_rs.ros2.domains import Joined, check_network, chosen_domain, dds_errors, join
from onorbit_rs.ros2.endpoints import MOST, MOST_COUNTED, Reader, Writer
from onorbit_rs.ros2.messages import STORE

_UNREACHABLE = (
    "check that a network interface is up, check the settings in CYCLONEDDS_URI, or use another domain"
)
_FULL = "close other nodes of this program, or start it again"


class Participant:
    """DDS participant with publishers of ROS topics and subscriptions to them; messages are bytes in CDR."""

    def __init__(self, domain: int, *, network: str = "loopback") -> None:
        """Join a domain.

        Parameters
        ----------
        domain : int
            DDS domain, from 0 to 232, as in ``ROS_DOMAIN_ID``.
        network : {"loopback", "all"}
            Whether the participant finds others on this machine only, or on all its networks with the
            settings of CycloneDDS (``CYCLONEDDS_URI``).

        Raises
        ------
        InputError
            If the domain or the network is invalid.
        Ros2Error
            If there is no network interface, the domain's ports are taken, or this process has joined the
            domain on the other network.
        """
        chosen_domain(domain)
        check_network(network)
        self._writers: list[Any] = []
        self._readers: list[Any] = []
        self._joined: Joined | None = None
        self._entity: Any = None
        self._found: Any = None
        self._graph: Any = None
        try:
            with dds_errors(f"join DDS domain {domain} with network={network!r}", _UNREACHABLE):
                self._open(domain, network)
        except BaseException:
            self.close()
            raise

    def _open(self, domain: int, network: str) -> None:
        self._joined = join(domain, network)
        self._entity = DomainParticipant(domain, qos=Qos(Policy.Userdata(graph.ENCLAVE)))
        self._found = BuiltinDataReader(self._entity, BuiltinTopicDcpsPublication)
        topic = Topic(self._entity, graph.TOPIC, declared(graph.KIND))
        self._graph = DataWriter(self._entity, topic, qos=_qos(graph.KIND, is_latched=True))

    def writer(self, topic: str, kind: str, *, is_latched: bool = False) -> Writer:
        """Return a reliable publisher; a latched one repeats its last message to late subscribers.

        Raises
        ------
        Ros2Error
            If CycloneDDS does not create the publisher.
        """
        with dds_errors(f"publish {topic}", _FULL):
            entity = DataWriter(self._entity, self._topic(topic, kind), qos=_qos(kind, is_latched))
        self._writers.append(entity)
        return Writer(self._writers[-1], topic)

    def reader(self, topic: str, kind: str) -> Reader:
        """Return a reliable subscription that keeps the messages since the last :meth:`Reader.take`.

        Raises
        ------
        Ros2Error
            If CycloneDDS does not create the subscription.
        """
        with dds_errors(f"subscribe to {topic}", _FULL):
            qos = _qos(kind, depth=MOST_COUNTED)
            entity = DataReader(self._entity, self._topic(topic, kind), qos=qos)
        self._readers.append(entity)
        return Reader(self._readers[-1], topic, kind)

    def announce(self, node: str) -> None:
        """Announce to ROS that the publishers and subscriptions created so far belong to a node.

        Raises
        ------
        Ros2Error
            If CycloneDDS does not accept the announcement.
        """
        with dds_errors(f"announce the node {node}", _FULL):
            data = graph.entities_message(node, self._entity, self._writers, self._readers)
        Writer(self._graph, graph.TOPIC).write(data)

    def _topic(self, name: str, kind: str) -> Any:
        return Topic(self._entity, f"rt{name}", declared(kind))

    def has_new_rival(self, topic: str) -> bool:
        """Return True if another participant has begun to publish a topic since the last call."""
        own = self._entity.get_guid()
        try:
            found = [each for each in self._found.take(MOST) if each.topic_name == f"rt{topic}"]
        except DDSException:  # what others announce must not end a run
            return False
        return any(each.participant_key != own for each in found)

    def wait_for_delivery(self, seconds: float) -> bool:
        """Wait until reliable subscribers have received all messages; return False after ``seconds``, s."""
        end = time.monotonic() + seconds
        for writer in self._writers:
            left = max(0, round(1e9 * (end - time.monotonic())))
            # DataWriter.wait_for_acks of 11.0.1 raises AttributeError when time is up
            if writer._wait_for_acks(writer._ref, left):
                return False
        return True

    def close(self) -> None:
        """Leave the domain; a second call has no effect."""
        self._writers.clear()
        self._readers.clear()
        self._found = self._graph = self._entity = self._joined = None


def _qos(kind: str, is_latched: bool = False, depth: int = MOST) -> Qos:
    return Qos(
        Policy.Reliability.Reliable(duration(milliseconds=100)),
        Policy.Durability.TransientLocal if is_latched else Policy.Durability.Volatile,
        Policy.History.KeepLast(1 if is_latched else depth),
        Policy.DataRepresentation(use_cdrv0_representation=True),
        Policy.Userdata(f"typehash={STORE.hash_rihs01(kind)};".encode()),
    )
