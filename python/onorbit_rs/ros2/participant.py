"""A DDS participant that ROS 2 nodes see as publishers and subscribers of topics."""

from __future__ import annotations

import os
import socket
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cyclonedds._clayer import ddspy_take, ddspy_write
from cyclonedds.core import DDSException, InstanceState, Policy, Qos, SampleState, ViewState
from cyclonedds.domain import Domain, DomainParticipant
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration

from onorbit_rs.exceptions import InputError, Ros2Error
from onorbit_rs.ros2.dds_types import declared
from onorbit_rs.ros2.messages import STORE

if TYPE_CHECKING:
    from collections.abc import Iterable

LARGEST_DOMAIN = 232
"""Largest domain whose ports are below 65536, by the port mapping of DDSI-RTPS."""

_PEERS = 64
"""Largest number of participants on this machine that find each other without multicast."""

_ANY = SampleState.Any | ViewState.Any | InstanceState.Any
_MOST = 1000
"""Largest number of messages taken at once."""

_LOOPBACK = f"""<CycloneDDS><Domain id="any">
<General><Interfaces><NetworkInterface address="127.0.0.1" multicast="false"/></Interfaces>
<AllowMulticast>false</AllowMulticast></General>
<Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>{_PEERS}</MaxAutoParticipantIndex>
<SPDPInterval>500 ms</SPDPInterval><Peers><Peer address="127.0.0.1"/></Peers></Discovery>
</Domain></CycloneDDS>"""


class Participant:
    """Publishes and subscribes ROS topics whose payloads are CDR."""

    def __init__(self, domain: int, *, network: str = "loopback") -> None:
        """Join a domain.

        Parameters
        ----------
        domain : int
            From 0 to 232, as ``ROS_DOMAIN_ID``.
        network : {"loopback", "all"}
            Other participants on this machine only, or on all its networks, with CycloneDDS' own settings
            (``CYCLONEDDS_URI``).

        Raises
        ------
        InputError
            If the domain or the network is invalid.
        Ros2Error
            If there is no such network interface or the domain's ports are taken.
        """
        _check(domain, network)
        before = set(_datagram_sockets())
        try:
            self._domain = Domain(domain, _LOOPBACK) if network == "loopback" else None
            self._entity = DomainParticipant(domain)
        except DDSException as error:
            raise Ros2Error(
                f"cannot join DDS domain {domain} on the {network} network ({error}): check that the "
                f"interface is up and that there are fewer than {_PEERS} participants, or use another domain"
            ) from error
        if network == "loopback":
            _restrict_to_loopback(before)
        self._kept: list[Any] = []

    def writer(self, topic: str, kind: str, *, is_latched: bool = False) -> Writer:
        """Return a reliable publisher; a latched one repeats its last message to late subscribers."""
        depth = 1 if is_latched else _MOST
        durability = Policy.Durability.TransientLocal if is_latched else Policy.Durability.Volatile
        writer = DataWriter(self._entity, self._topic(topic, kind), qos=_qos(kind, durability, depth))
        self._kept.append(writer)
        return Writer(writer)

    def reader(self, topic: str, kind: str) -> Reader:
        """Return a reliable subscription that keeps the messages since the last :meth:`Reader.take`."""
        qos = _qos(kind, Policy.Durability.Volatile, _MOST)
        reader = DataReader(self._entity, self._topic(topic, kind), qos=qos)
        self._kept.append(reader)
        return Reader(reader, topic, kind)

    def _topic(self, name: str, kind: str) -> Any:
        return Topic(self._entity, f"rt{name}", declared(kind))

    def close(self) -> None:
        """Leave the domain."""
        self._kept.clear()
        del self._entity, self._domain


class Writer:
    """Publisher of one topic."""

    def __init__(self, entity: Any) -> None:
        """Wrap a writer of CycloneDDS."""
        self._entity = entity

    def write(self, data: bytes) -> None:
        """Publish a message in CDR."""
        ddspy_write(self._entity._ref, data)

    def subscribers(self) -> int:
        """Return the number of subscriptions found."""
        return len(self._entity.get_matched_subscriptions())

    def wait_for_delivery(self, seconds: float) -> bool:
        """Wait until reliable subscribers have received all messages; return False if time is up."""
        with suppress(DDSException):
            return bool(self._entity.wait_for_acks(duration(seconds=seconds)))
        return False


class Reader:
    """Subscription to one topic."""

    def __init__(self, entity: Any, topic: str, kind: str) -> None:
        """Wrap a reader of CycloneDDS."""
        self._entity = entity
        self.topic, self.kind = topic, kind

    def take(self) -> list[tuple[bytes, int]]:
        """Return the payloads received since the last call, in CDR, each with a number of its sender."""
        taken = ddspy_take(self._entity._ref, _ANY, _MOST)
        if isinstance(taken, int):
            return []
        return [(data, info.publication_handle) for data, info in taken if info.valid_data]


def _qos(kind: str, durability: Any, depth: int) -> Qos:
    return Qos(
        Policy.Reliability.Reliable(duration(milliseconds=100)),
        durability,
        Policy.History.KeepLast(depth),
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


def _datagram_sockets() -> Iterator[int]:
    """Return the file descriptors of this process that are UDP sockets."""
    folder = Path("/proc/self/fd")
    for entry in folder.iterdir() if folder.is_dir() else ():
        with suppress(OSError):
            if str(entry.readlink()).startswith("socket:") and _is_datagram(int(entry.name)):
                yield int(entry.name)


def _is_datagram(descriptor: int) -> bool:
    with socket.socket(fileno=os.dup(descriptor)) as copy:
        return copy.family in (socket.AF_INET, socket.AF_INET6) and copy.type == socket.SOCK_DGRAM


def _restrict_to_loopback(before: Iterable[int]) -> None:
    """Bind the new sockets to the loopback device: CycloneDDS opens them on all addresses."""
    device = getattr(socket, "SO_BINDTODEVICE", None)
    if device is None:
        return
    for descriptor in set(_datagram_sockets()) - set(before):
        with socket.socket(fileno=os.dup(descriptor)) as copy:
            copy.setsockopt(socket.SOL_SOCKET, device, b"lo")
