"""Chooses the DDS domain of a node, and joins it."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from weakref import WeakValueDictionary

from cyclonedds.core import DDSException
from cyclonedds.domain import Domain

from onorbit_rs.exceptions import InputError, Ros2Error
from onorbit_rs.ros2 import loopback

LARGEST_DOMAIN = 232
"""Largest domain whose ports are below 65536, by the port mapping of DDSI-RTPS."""

VARIABLE = "ROS_DOMAIN_ID"


def chosen_domain(domain: int | None) -> int:
    """Return the DDS domain to join: the given one, or else that of ``ROS_DOMAIN_ID``, or else 0, as in ROS.

    Raises
    ------
    InputError
        If the domain, given or in the environment, is not an integer from 0 to 232.
    """
    wanted = f"must be an integer from 0 to {LARGEST_DOMAIN}"
    if domain is None:
        text = os.environ.get(VARIABLE, "").strip()
        if not text:
            return 0
        # ROS reads 010 as octal
        if not re.fullmatch("0|[1-9][0-9]{0,2}", text) or int(text) > LARGEST_DOMAIN:
            raise InputError(
                f"{VARIABLE} in the environment is {text!r}; it {wanted}, without leading zeros, or unset",
                name=VARIABLE, got=text, expected=f"0 to {LARGEST_DOMAIN}",
            )  # fmt: skip
        return int(text)
    if isinstance(domain, bool) or not isinstance(domain, int) or not 0 <= domain <= LARGEST_DOMAIN:
        raise InputError(
            f"the DDS domain is {domain!r}; it {wanted}",
            name="domain", got=domain, expected=f"0 to {LARGEST_DOMAIN}",
        )  # fmt: skip
    return domain


def check_network(network: str) -> None:
    """Raise an InputError if ``network`` is neither ``loopback`` nor ``all``."""
    if network not in ("loopback", "all"):
        raise InputError(
            f"network is {network!r}; give 'loopback' or 'all'",
            name="network", got=network, expected="loopback or all",
        )  # fmt: skip


@contextmanager
def dds_errors(task: str, advice: str) -> Iterator[None]:
    """Convert errors of CycloneDDS in the block to a :class:`Ros2Error` with task, reason and advice."""
    try:
        yield
    except DDSException as error:
        reason = str(error).strip()
        raise Ros2Error(f"cannot {task} ({reason}): {advice}", reason=reason) from error


@dataclass(frozen=True)
class Joined:
    """A domain that this process has joined, shared by all participants of the process in the domain."""

    domain: Domain
    network: str


_JOINED: WeakValueDictionary[int, Joined] = WeakValueDictionary()


def join(domain: int, network: str) -> Joined:
    """Join a domain, or return it if this process has joined it: CycloneDDS opens the sockets only once.

    Raises
    ------
    Ros2Error
        If no participant can join, or this process has joined the domain on the other network.
    """
    if joined := _JOINED.get(domain):
        if joined.network != network:
            raise Ros2Error(
                f"this process has joined DDS domain {domain} with network={joined.network!r}; close the "
                "node that did so, or use the same network or another domain",
                reason="another network",
            )
        return joined
    if network == "loopback":
        loopback.check(domain)
        before = set(loopback.udp_sockets())
        joined = Joined(Domain(domain, f"{loopback.ENDING},{loopback.LOOPBACK}"), network)
        loopback.restrict(before)
    else:
        settings = filter(None, [loopback.ENDING, os.environ.get("CYCLONEDDS_URI")])
        joined = Joined(Domain(domain, ",".join(settings)), network)
    _JOINED[domain] = joined
    return joined
