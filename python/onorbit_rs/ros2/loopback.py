"""Settings and checks of CycloneDDS for participants that only this machine can reach."""

from __future__ import annotations

import os
import socket
import sys
import warnings
from collections.abc import Iterable, Iterator
from contextlib import closing, suppress
from pathlib import Path

from onorbit_rs.exceptions import Ros2Error

PARTICIPANTS = 60
"""Largest number of participants on this machine that find each other; domain 232 has ports for 63."""

ENDING = """<CycloneDDS><Domain id="any"><Internal><WriterLingerDuration>0 s</WriterLingerDuration></Internal>
</Domain></CycloneDDS>"""
"""Setting with which deleted publishers do not wait for subscribers that have stopped.

The node waits once for all of its publishers.
"""

LOOPBACK = f"""<CycloneDDS><Domain id="any">
<General><Interfaces><NetworkInterface address="127.0.0.1" multicast="false"/></Interfaces>
<AllowMulticast>false</AllowMulticast></General>
<Discovery><ParticipantIndex>auto</ParticipantIndex>
<MaxAutoParticipantIndex>{PARTICIPANTS}</MaxAutoParticipantIndex>
<SPDPInterval>500 ms</SPDPInterval><Peers><Peer address="127.0.0.1"/></Peers></Discovery>
</Domain></CycloneDDS>"""
"""Settings with which only 127.0.0.1 is used.

The announcements are frequent; otherwise, a node that only listens to multicast would not be found.
"""


def check(domain: int) -> None:
    """Raise an error if the loopback interface is down, or the ports of all participants are taken.

    For these causes, CycloneDDS prints a text and raises an error that does not name the cause.

    Raises
    ------
    Ros2Error
        If no participant can join; the message names the cause and what to do.
    """
    with closing(socket.socket(socket.AF_INET, socket.SOCK_DGRAM)) as probe:
        try:
            probe.connect(("127.0.0.1", 9))  # finds a route; sends nothing
        except OSError as error:
            raise Ros2Error(
                f"the loopback interface cannot be used ({error.strerror}); enable it: ip link set lo up"
            ) from error
    if not any(_is_free(port) for port in _ports(domain)):
        first, last = _ports(domain)[0], _ports(domain)[-1]
        raise Ros2Error(
            f"DDS domain {domain} is full: the UDP ports of its participants ({first}, {first + 2}, ... "
            f"{last}) are all in use; end other nodes or use another domain"
        )


def _ports(domain: int) -> range:
    """Return the ports of the participants of a domain, by the port mapping of DDSI-RTPS."""
    first = 7400 + 250 * domain + 10
    return range(first, first + 2 * PARTICIPANTS, 2)


def _is_free(port: int) -> bool:
    with closing(socket.socket(socket.AF_INET, socket.SOCK_DGRAM)) as probe:
        try:
            probe.bind(("", port))
        except OSError:
            return False
    return True


def udp_sockets() -> Iterator[int]:
    """Yield the file descriptors of the UDP sockets of this process; none on systems other than Linux."""
    folder = Path("/proc/self/fd")
    for entry in folder.iterdir() if folder.is_dir() else ():
        with suppress(OSError):
            if str(entry.readlink()).startswith("socket:") and _is_udp(int(entry.name)):
                yield int(entry.name)


def _is_udp(descriptor: int) -> bool:
    with socket.socket(fileno=os.dup(descriptor)) as copy:
        return copy.family in (socket.AF_INET, socket.AF_INET6) and copy.type == socket.SOCK_DGRAM


def restrict(before: Iterable[int]) -> None:
    """Bind the UDP sockets that are not in ``before`` to the loopback device.

    CycloneDDS opens its sockets on all addresses. Where the system does not allow the binding, a warning is
    issued.
    """
    reason = None if sys.platform == "linux" else f"{sys.platform} has no such option"
    for descriptor in set(udp_sockets()) - set(before):
        with socket.socket(fileno=os.dup(descriptor)) as copy:
            try:
                copy.setsockopt(socket.SOL_SOCKET, socket.SO_BINDTODEVICE, b"lo")
            except OSError as error:
                reason = str(error.strerror)
    if reason is not None:
        warnings.warn(
            f"the UDP ports of DDS could not be bound to the loopback device ({reason}); block them with a "
            "firewall if other machines must not reach them",
            UserWarning,
            stacklevel=4,
        )
