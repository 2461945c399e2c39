"""A DDS participant that ROS 2 nodes see as a node with publishers and subscriptions."""

from __future__ import annotations

import os
import time
from dataclasses import dataclass
from typing import Any
from weakref import WeakValueDictionary

from cyclonedds.builtin import BuiltinDataReader, BuiltinTopicDcpsPublication
from cyclonedds.core import DDSException, Policy, Qos
from cyclonedds.domain import Domain, DomainParticipant
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration

from onorbit_rs.exceptions import InputError, Ros2Error
from onorbit_rs.ros2 import graph, loopback
from onorbit_rs.ros2.dds_types import declared
from onorbit_rs.ros2.endpoints import MOST, Reader, Writer
from onorbit_rs.ros2.messages import STORE

LARGEST_DOMAIN = 232
"""Largest domain whose ports are below 65536, by the port mapping of DDSI-RTPS."""


@dataclass(frozen=True)
class _Joined:
    """A domain that this process has joined; all its participants in the domain share it."""

    domain: Domain
    network: str


_JOINED: WeakValueDictionary[int, _Joined] = WeakValueDictionary()


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
        _check(domain, network)
        try:
            self._joined: _Joined | None = _join(domain, network)
            self._entity: Any = DomainParticipant(domain, qos=Qos(Policy.Userdata(graph.ENCLAVE)))
        except DDSException as error:
            raise Ros2Error(
                f"cannot join DDS domain {domain} with network={network!r} ({error}): check that a network "
                f"interface is up, check the settings in CYCLONEDDS_URI, or use another domain"
            ) from error
        self._writers: list[Any] = []
        self._readers: list[Any] = []
        self._found: Any = BuiltinDataReader(self._entity, BuiltinTopicDcpsPublication)
        topic = Topic(self._entity, graph.TOPIC, declared(graph.KIND))
        self._graph: Any = DataWriter(self._entity, topic, qos=_qos(graph.KIND, is_latched=True))

    def writer(self, topic: str, kind: str, *, is_latched: bool = False) -> Writer:
        """Return a reliable publisher; a latched one repeats its last message to late subscribers."""
        self._writers.append(DataWriter(self._entity, self._topic(topic, kind), qos=_qos(kind, is_latched)))
        return Writer(self._writers[-1], topic)

    def reader(self, topic: str, kind: str) -> Reader:
        """Return a reliable subscription that keeps the messages since the last :meth:`Reader.take`."""
        self._readers.append(DataReader(self._entity, self._topic(topic, kind), qos=_qos(kind)))
        return Reader(self._readers[-1], topic, kind)

    def announce(self, node: str) -> None:
        """Announce to ROS that the publishers and subscriptions created so far belong to a node."""
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
        """Wait until reliable subscribers have received all messages; return False if time, s, is up."""
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


def _qos(kind: str, is_latched: bool = False) -> Qos:
    return Qos(
        Policy.Reliability.Reliable(duration(milliseconds=100)),
        Policy.Durability.TransientLocal if is_latched else Policy.Durability.Volatile,
        Policy.History.KeepLast(1 if is_latched else MOST),
        Policy.DataRepresentation(use_cdrv0_representation=True),
        Policy.Userdata(f"typehash={STORE.hash_rihs01(kind)};".encode()),
    )


def _check(domain: int, network: str) -> None:
    if isinstance(domain, bool) or not isinstance(domain, int) or not 0 <= domain <= LARGEST_DOMAIN:
        raise InputError(
            f"the DDS domain is {domain!r}; it must be an integer from 0 to {LARGEST_DOMAIN}",
            name="domain", got=domain, expected=f"0 to {LARGEST_DOMAIN}",
        )  # fmt: skip
    if network not in ("loopback", "all"):
        raise InputError(
            f"network is {network!r}; give 'loopback' or 'all'",
            name="network", got=network, expected="loopback or all",
        )  # fmt: skip


def _join(domain: int, network: str) -> _Joined:
    """Join a domain, or return it if this process has joined it: CycloneDDS opens its sockets only once."""
    if joined := _JOINED.get(domain):
        if joined.network != network:
            raise Ros2Error(
                f"this process has joined DDS domain {domain} with network={joined.network!r}; close that "
                "node, use the same network or another domain"
            )
        return joined
    if network == "loopback":
        loopback.check(domain)
        before = set(loopback.udp_sockets())
        joined = _Joined(Domain(domain, f"{loopback.ENDING},{loopback.LOOPBACK}"), network)
        loopback.restrict(before)
    else:
        settings = filter(None, [loopback.ENDING, os.environ.get("CYCLONEDDS_URI")])
        joined = _Joined(Domain(domain, ",".join(settings)), network)
    _JOINED[domain] = joined
    return joined
