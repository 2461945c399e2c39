"""Warns of other simulators in the domain of a node."""

from __future__ import annotations

import math
import time
from typing import TYPE_CHECKING

from onorbit_rs.ros2.events import WARN

if TYPE_CHECKING:
    from onorbit_rs.ros2.participant import Participant
    from onorbit_rs.ros2.session import Session

_PERIOD_S = 1.0
"""Wall-clock time between two checks for other simulators, s."""


class Rivals:
    """Warns if another node in the domain publishes ``/clock``, as other simulators do."""

    def __init__(self, participant: Participant, domain: int) -> None:
        """Store the participant of the node and the number of its domain."""
        self._participant, self._domain = participant, domain
        self._looked = -math.inf

    def point_out(self, session: Session) -> None:
        """Publish a warning if another node has begun to publish ``/clock``; at most one check per second."""
        now = time.monotonic()
        if now < self._looked + _PERIOD_S:
            return
        self._looked = now
        if self._participant.has_new_rival("/clock"):
            session.say(
                WARN, "/clock",
                f"another node publishes the time in domain {self._domain}, and both may receive the same "
                "commands; give one of them another domain, by --domain or, in Python, Node(domain=…)",
            )  # fmt: skip
