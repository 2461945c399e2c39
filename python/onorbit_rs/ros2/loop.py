"""The loop of a live node: reads messages, waits for the next tick, advances the run."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from onorbit_rs.ros2.scheduling import collected_in_slack, prioritized

if TYPE_CHECKING:
    from onorbit_rs.ros2.orders import Orders
    from onorbit_rs.ros2.pace import RealTime
    from onorbit_rs.ros2.rivals import Rivals
    from onorbit_rs.ros2.session import Session

_IDLE_S = 1e-3
"""Wall-clock time between two readings of the topics while the simulation waits, s."""


@dataclass
class Loop:
    """Advances a session until its end; with a clock, in real time."""

    session: Session
    orders: Orders
    rivals: Rivals
    clock: RealTime | None
    has_priority: bool

    def spin(self) -> None:
        """Execute messages and advance the run, until its end or until a signal stops the node."""
        self.session.publish_present()
        if self.clock is None:
            self._repeat(lambda slack: None)
            return
        self.clock.calibrate()
        with prioritized(self.has_priority), collected_in_slack() as tidy:
            self._repeat(tidy)

    def _repeat(self, tidy: Callable[[float], None]) -> None:
        run = self.session.run
        while run.time < run.end and not self.session.is_stopped():
            self._turn(tidy)

    def _turn(self, tidy: Callable[[float], None]) -> None:
        """Read the messages shortly before a tick, wait for the tick, and advance unless the run waits.

        If the tick is not near, only the messages are read, after a sleep of 50 ms.
        """
        session, clock = self.session, self.clock
        is_near = True
        if session.is_waiting:
            tidy(math.inf)
        elif clock is not None:
            tidy(clock.ahead(session.run.time))
            is_near = clock.approach(session.run.time)
        self.orders.execute()
        self.rivals.point_out(session)
        if session.is_waiting:
            self._idle()
        elif is_near and not session.is_stopped():
            if clock is not None:
                clock.wait(session.run.time)
            session.advance()

    def _idle(self) -> None:
        """Sleep for a short time while the run waits for messages."""
        self.session.greet()
        if self.clock is None:
            time.sleep(_IDLE_S)
        else:
            self.clock.idle(self.session.run.time, _IDLE_S)
