"""A run whose rows, events and answers are published while it is advanced."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs.ros2.events import WARN

if TYPE_CHECKING:
    from onorbit_rs.ros2.live_run import LiveRun
    from onorbit_rs.ros2.publisher import Publisher

_BLOCK_S = 0.02
"""Simulated time between two readings of the topics, s, if the run does not follow the clock."""


@dataclass
class Session:
    """A run, its publisher, and whether it waits for messages."""

    run: LiveRun
    publisher: Publisher
    pace: str
    is_paused: bool
    is_stopped: Callable[[], bool] = lambda: False
    """Whether a signal has asked the node to end."""

    @property
    def is_waiting(self) -> bool:
        """True if the run advances on ``/step`` only: in a pause, and in pace ``stepped``."""
        return self.is_paused or self.pace == "stepped"

    def advance(self) -> None:
        """Advance to the next time at which the node reads its topics."""
        self._advance_to(self.run.next_time(0.0 if self.pace == "real_time" else _BLOCK_S))

    def advance_by(self, length: float) -> None:
        """Advance by a length of simulated time, s, in blocks; a signal stops the node after a block."""
        end = min(self.run.time + length, self.run.end)
        before = -np.inf
        while before < self.run.time < end and not self.is_stopped():
            before = self.run.time
            self._advance_to(min(self.run.next_time(_BLOCK_S), end))

    def _advance_to(self, t: float) -> None:
        ended = self.run.advance_to(t)
        self.publish()
        for entry in ended:
            topic = f"/{self.publisher.prefixes[entry['system']]}wrench_command"
            self.say(WARN, topic, f"no message came within the timeout; the wrench on {entry['body']} ended")

    def publish(self) -> None:
        """Publish the rows and events that are new since the last call."""
        self.publisher.rows(self.run.rows())
        self.publisher.events(self.run.events())

    def publish_present(self) -> None:
        """Publish the row at the current time if the run waits, since commands are computed from this row."""
        if self.is_waiting:
            self.publisher.rows(self.run.take_present())

    def greet(self) -> None:
        """Publish the row at the current time on topics that subscribers have joined while the run waits."""
        self.publisher.greet(self.run.present)

    def say(self, level: int, name: str, text: str) -> None:
        """Publish an answer to a message, or a warning, about ``name``."""
        self.publisher.answer(self.run.time, level, name, text)
