"""A node that runs a simulation, publishes its topics and obeys its command topics."""

from __future__ import annotations

import math
import os
import time
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.exceptions import ControlError, InputError, OnOrbitError, Ros2Error
from onorbit_rs.ros2.inbox import Arrived, Entry, Inbox, add_run_topics, add_system_topics
from onorbit_rs.ros2.live_rows import LiveRows
from onorbit_rs.ros2.messages import nanoseconds
from onorbit_rs.ros2.pace import PACES, RealTime
from onorbit_rs.ros2.participant import Participant
from onorbit_rs.ros2.publisher import Publisher
from onorbit_rs.ros2.recording import Recording
from onorbit_rs.ros2.stopping import noted_stop
from onorbit_rs.ros2.topics import ERROR, OK, WARN, Topics, topics
from onorbit_rs.scenario import WorldScenario, load
from onorbit_rs.scenario.build import build
from onorbit_rs.scenario.build_world import build_world
from onorbit_rs.simulation.commands import CommandLog

if TYPE_CHECKING:
    from onorbit_rs._core import Checkpoint, Model, Simulation, Stepper, Trace, WorldTrace

NAME = "onorbit"
"""Name of the node."""

_IDLE_S = 1e-3
"""Wall-clock time between two looks at the topics while the simulation waits, s."""
_BLOCK_S = 0.02
"""Simulated time that a node in pace ``fast`` advances between two looks at the topics, s."""
_DELIVERY_S = 1.0
"""Longest time that a node waits for subscribers that have not received all messages at its end, s."""
_FAR_S = 3600.0
"""A trajectory that starts so long after the current time, s, was probably stamped by another clock."""
_UNSAVED = "a controller in Python cannot be set back; give it get_state() and set_state()"
_RIVALS_S = 1.0
"""Wall-clock time between two looks for other simulators in the domain, s."""
_SHORTEST_TICK = 1e-3
"""Shortest simulated time between two looks at the topics, unless the time step is longer, s."""


class Node:
    """A simulation as a ROS 2 participant, without an installation of ROS 2.

    The node publishes each recorded row. A command takes effect at the next update of the controllers after
    the simulated time at which the node reads it, which ``commands`` records.

    Attributes
    ----------
    duration : float or None
        Duration of the scenario, s; None for a simulation without one.
    """

    def __init__(
        self,
        simulation: Simulation,
        *,
        pace: str = "real_time",
        domain: int = 0,
        network: str = "loopback",
        is_paused: bool = False,
        log: str | os.PathLike[str] | None = None,
        record: str | os.PathLike[str] | None = None,
        on_message: Callable[[str], None] = lambda text: None,
    ) -> None:
        """Join a domain; nothing moves before :meth:`spin`.

        Parameters
        ----------
        simulation : Simulation
            Simulation to run.
        pace : {"real_time", "fast", "stepped"}
            Simulated time follows the wall clock, runs as fast as possible, or advances on ``/step`` only.
        domain : int
            DDS domain, as ``ROS_DOMAIN_ID``.
        network : {"loopback", "all"}
            Reachable from this machine only, or from all its networks.
        is_paused : bool
            Wait for ``/pause`` false before the first step.
        log : str or path, optional
            File to which each command is written, from which ``onorbit run --commands`` repeats the run.
        record : str or path, optional
            MCAP file of the messages that the node publishes and of the commands that it obeys; :meth:`close`
            completes it and replaces an existing file. A run that is recorded cannot be reset.
        on_message : callable
            Called with each text that also goes to ``/events``.

        Raises
        ------
        InputError
            If an argument is invalid.
        Ros2Error
            If the domain cannot be joined.
        OutputFolderError
            If a file cannot be written.
        """
        if pace not in PACES:
            raise InputError(
                f"pace is {pace!r}; give one of {', '.join(PACES)}", name="pace", got=pace, expected=PACES
            )
        self._simulation, self._pace, self._is_paused, self._file = simulation, pace, is_paused, log
        self._models: Mapping[str, Model] = simulation.models
        self._tick = _tick(simulation)
        self._end = np.inf
        self._is_stopped: Callable[[], bool] = lambda: False
        self.duration: float | None = None
        self._clock = RealTime(self._tick)
        self._has_ended = False
        self._checked_rivals = -math.inf
        self._start(None)
        self.topics: Topics = topics(self._models, self._rows.present(), simulation.orbit)
        self._participant = Participant(domain, network=network)
        self._recording = None if record is None else Recording(record, self.topics)
        self._domain = domain
        self._log = CommandLog(log)  # after everything that may fail, since it replaces the file
        self._publisher = Publisher(self._participant, self.topics, on_message, self._recording)
        self._inbox = Inbox(self._participant)
        add_run_topics(self._inbox)
        for system in self._models:
            prefix = self.topics.prefixes[system]
            controls = self._of(self._stepper, system).external
            add_system_topics(self._inbox, system, prefix, self.topics.frames[system], controls)
        self._participant.announce(NAME)

    @classmethod
    def of_scenario(cls, scenario: Any, **options: Any) -> Node:
        """Return the node of a scenario, with the options of :class:`Node`.

        Parameters
        ----------
        scenario : str, path, mapping or Scenario
            As for :func:`onorbit_rs.run`.
        """
        checked = load(scenario)
        built = build_world(checked) if isinstance(checked, WorldScenario) else build(checked)
        node = cls(built.simulation, **options)
        node.duration = checked.simulation.duration
        return node

    @property
    def commands(self) -> list[Entry]:
        """Commands obeyed so far with their simulated times, s; entries as in a file of commands."""
        return list(self._log.entries)

    @property
    def jitter(self) -> dict[str, float]:
        """How late the node was in pace ``real_time``, s; empty otherwise."""
        return self._clock.report()

    @property
    def published(self) -> list[tuple[str, str]]:
        """Names and types of the topics that the node publishes."""
        return self._publisher.topics

    @property
    def subscribed(self) -> list[tuple[str, str]]:
        """Names and types of the topics that the node listens to."""
        return list(self._inbox.topics())

    def _start(self, end: float | None) -> None:
        """Start the run; an adaptive one, whose steps depend on it, with its planned end, s."""
        self._planned = end
        try:  # the state at the start, with that of controllers in Python
            self._beginning: Checkpoint | None = self._simulation.start(duration=end).checkpoint()
        except ControlError:
            self._beginning = None
        self._restart()

    def _plan(self, end: float) -> None:
        """Start an adaptive run anew with its planned end, s, as ``onorbit run`` does."""
        is_adaptive = self._simulation.integrator == "dormand_prince"
        if is_adaptive and end < np.inf and self._beginning is not None:
            self._restart()  # sets controllers in Python back
            self._start(end)

    def _restart(self) -> None:
        self._stepper: Stepper = self._simulation.start(duration=self._planned, resume=self._beginning)
        self._rows = LiveRows(self._stepper, self._models)
        self._events = 0

    def _of(self, stepper: Stepper, system: str) -> Any:
        return stepper[system] if len(self._models) > 1 else stepper

    def spin(self, duration: float | None = None) -> Trace | WorldTrace:
        """Run until a simulated time, s, or without an end, and return the trace; Ctrl-C ends the run too.

        In a pause and in pace ``stepped``, the row at the start is published before the first step.

        Raises
        ------
        InputError
            If the duration is not positive.
        Ros2Error
            If the run of this node has ended.
        OnOrbitError
            Errors of the run.
        """
        check_duration(duration)
        if self._has_ended:
            raise Ros2Error("the run of this node has ended; create another Node for another run")
        self._has_ended = True
        self._end = np.inf if duration is None else duration
        self._plan(self._end)
        try:
            with noted_stop() as self._is_stopped:
                self._publish_present()
                while self._stepper.time < self._end and not self._is_stopped():
                    self._turn()
                if self._is_stopped():
                    self._say(OK, "run", "stopped")
        except KeyboardInterrupt:
            self._say(OK, "run", "stopped")
        except OnOrbitError as error:
            self._publish()
            self._say(ERROR, "run", f"failed: {error}")
            raise
        self._publish()
        trace = self._stepper.finish()
        self._publisher.rows(self._rows.take_last(trace))
        self._log.close()
        return trace

    def _turn(self) -> None:
        """Obey the messages that have arrived, and advance to the next time unless the run waits."""
        self._obey()
        self._warn_of_rivals()
        if self._is_paused or self._pace == "stepped":
            self._clock.restart(self._stepper.time)
            time.sleep(_IDLE_S)
            return
        if self._pace == "real_time":
            self._clock.wait(self._stepper.time)
        self._advance(self._next())

    def _next(self) -> float:
        """Return the next time at which the node looks at its topics, on the grid of ticks."""
        block = self._tick if self._pace == "real_time" else max(self._tick, _BLOCK_S)
        return self._tick * (round(self._stepper.time / self._tick) + round(block / self._tick))

    def _advance(self, t: float) -> None:
        self._stepper.advance_to(min(t, self._end))
        self._publish()

    def _advance_by(self, length: float) -> None:
        """Advance by a length of simulated time, s, in blocks, between which a signal stops the node."""
        end = min(self._stepper.time + length, self._end)
        before = -np.inf
        while before < self._stepper.time < end and not self._is_stopped():
            before = self._stepper.time
            self._advance(min(self._next(), end))

    def _publish(self) -> None:
        """Publish the rows and events since the last call."""
        self._publisher.rows(self._rows.take())
        events = self._stepper.events
        self._publisher.events(events[self._events :])
        self._events = len(events)

    def _publish_present(self) -> None:
        """Publish the row at the current time, for a sender that waits for it."""
        if self._is_paused or self._pace == "stepped":
            self._publisher.rows(self._rows.take_present())

    def _obey(self) -> None:
        """Obey the messages that have arrived."""
        for arrived in self._inbox.take():
            if arrived.contested:
                text = f"several processes send to {', '.join(arrived.contested)}; the last message holds"
                self._say(WARN, arrived.topic, text)
            if arrived.refusal is not None:
                self._say(ERROR, arrived.topic, f"refused: {arrived.refusal}")
            now = self._stepper.time
            if arrived.entries and self._obey_entries(arrived) and self._recording is not None:
                self._recording.message(arrived.topic, arrived.kind, now, arrived.data)

    def _warn_of_rivals(self) -> None:
        """Warn of another node that publishes the time, as another simulator does."""
        if time.monotonic() < self._checked_rivals + _RIVALS_S:
            return
        self._checked_rivals = time.monotonic()
        if self._participant.has_new_rival("/clock"):
            self._say(
                WARN, "/clock",
                f"another node publishes the time in domain {self._domain}: both nodes obey the same "
                "commands; give one of them another domain, by --domain, Node(domain=…) or ROS_DOMAIN_ID",
            )  # fmt: skip

    def _obey_entries(self, arrived: Arrived) -> bool:
        """Obey the entries of a message, or refuse all of them with an answer; return True if obeyed."""
        entry = arrived.entries[0]
        if "pause" in entry and self._pace == "stepped":
            self._say(WARN, arrived.topic, "in pace stepped the run advances on /step only")
            return False
        if "pause" in entry:
            self._is_paused = entry["pause"]
            self._publish_present()
            self._say(OK, arrived.topic, "paused" if self._is_paused else "running")
        elif "reset" in entry and self._recording is not None:
            self._say(ERROR, arrived.topic, "refused: the run is recorded, and times in a bag do not go back")
            return False
        elif "reset" in entry and self._file is not None:
            self._say(ERROR, arrived.topic, "refused: the commands are logged, and a log has one run")
            return False
        elif "reset" in entry and self._beginning is None:
            self._say(ERROR, arrived.topic, f"refused: {_UNSAVED}")
            return False
        elif "reset" in entry:
            self._restart()
            self._log = CommandLog()
            self._clock.restart(0.0)
            self._publish_present()
            self._say(OK, arrived.topic, "reset to t = 0 s")
        elif "step" in entry:
            return self._step(arrived.topic, entry["step"])
        else:
            return self._command(arrived)
        return True

    def _step(self, topic: str, length: float) -> bool:
        """Advance by a length of simulated time, s; return False if it is refused."""
        if not (self._is_paused or self._pace == "stepped"):
            self._say(ERROR, topic, "refused: the run is not paused; use pace stepped, or /pause first")
        elif not 0.0 < length < np.inf:
            self._say(ERROR, topic, f"refused: the step is {length!r} s; it must be positive and finite")
        elif nanoseconds(self._stepper.time + length) == nanoseconds(self._stepper.time):
            self._say(ERROR, topic, f"refused: the step is {length!r} s; the clock resolves 1e-09 s")
        else:
            self._advance_by(length)
            self._publish_present()
            self._say(OK, topic, f"advanced to t = {self._stepper.time:.9g} s")
            return True
        return False

    def _command(self, arrived: Arrived) -> bool:
        topic, entry = arrived.topic, arrived.entries[0]
        try:
            if len(arrived.entries) > 1:
                self._log.apply_all(self._stepper, arrived.entries)
            else:
                self._log.apply(self._stepper, entry)
        except OnOrbitError as error:
            self._say(ERROR, topic, f"refused: {error}")
            return False
        now = self._stepper.time
        if (start := entry.get("trajectory", {}).get("start", now)) > now + _FAR_S:
            text = f"starts in {start - now:.9g} s: set use_sim_time in the node that sends it"
            self._say(WARN, topic, text)
        if "trigger" in entry:
            self._say(OK, topic, f"{entry['trigger']} is due at t = {now:.9g} s")
        return True

    def _say(self, level: int, name: str, text: str) -> None:
        """Publish an answer."""
        self._publisher.answer(self._stepper.time, level, name, text)

    def close(self) -> None:
        """Complete the files and leave the domain, after subscribers have received all messages.

        No effect the second time.
        """
        self._log.close()
        if self._recording is not None:
            self._recording.close()
        self._participant.wait_for_delivery(_DELIVERY_S)
        self._participant.close()


def check_duration(duration: float | None) -> None:
    """Raise an InputError for a duration, s, that is not positive; None is an open end."""
    if duration is not None and not duration > 0.0:
        raise InputError(
            f"the duration is {duration!r} s; it must be positive",
            name="duration", got=duration, expected="a positive number of seconds",
        )  # fmt: skip


def _tick(simulation: Simulation) -> float:
    """Return the simulated time between two looks at the topics, s: a row, or a few steps of a long one."""
    steps = max(1, min(simulation.record_every, round(_SHORTEST_TICK / simulation.time_step)))
    return simulation.time_step * steps
