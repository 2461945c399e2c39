"""A node that runs a simulation, publishes its topics and executes the messages of command topics."""

from __future__ import annotations

import os
from collections.abc import Callable
from contextlib import ExitStack, suppress
from numbers import Real
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs._core import Simulation
from onorbit_rs.exceptions import DtypeError, InputError, OnOrbitError, Ros2Error
from onorbit_rs.ros2.command_topics import add_run_topics, add_system_topics
from onorbit_rs.ros2.domains import chosen_domain, dds_errors
from onorbit_rs.ros2.entries import Entry
from onorbit_rs.ros2.events import ERROR, OK, WARN
from onorbit_rs.ros2.inbox import Inbox
from onorbit_rs.ros2.live_run import LiveRun
from onorbit_rs.ros2.loop import Loop
from onorbit_rs.ros2.orders import Orders
from onorbit_rs.ros2.pace import PACES, RealTime
from onorbit_rs.ros2.participant import Participant
from onorbit_rs.ros2.publisher import Publisher
from onorbit_rs.ros2.recording import Recording
from onorbit_rs.ros2.rivals import Rivals
from onorbit_rs.ros2.scheduling import prioritized
from onorbit_rs.ros2.session import Session
from onorbit_rs.ros2.stopping import noted_stop
from onorbit_rs.ros2.topics import Topics, topics
from onorbit_rs.scenario import WorldScenario, load
from onorbit_rs.scenario.build import build
from onorbit_rs.scenario.build_world import build_world
from onorbit_rs.simulation.commands import CommandLog

if TYPE_CHECKING:
    from onorbit_rs._core import Trace, WorldTrace

    _File = str | os.PathLike[str]

NAME = "onorbit"
"""Name of the node."""

_DELIVERY_S = 1.0
"""Longest time that a node waits for subscribers that have not received all messages at its end, s."""


class Node:
    """A simulation as a ROS 2 participant, without an installation of ROS 2.

    The node publishes each recorded row. A command takes effect at the next update of the controllers after
    the simulated time at which the node reads it, which ``commands`` records.

    Attributes
    ----------
    duration : float or None
        Duration of the scenario of :meth:`of_scenario`, s; None for a node of a simulation.
    domain : int
        DDS domain that the node has joined.
    """

    def __init__(
        self,
        simulation: Simulation,
        *,
        pace: str = "real_time",
        domain: int | None = None,
        network: str = "loopback",
        is_paused: bool = False,
        log: _File | None = None,
        record: _File | None = None,
        wrench_timeout: float | None = None,
        keep_rows: int | None = None,
        has_priority: bool = False,
        on_message: Callable[[str], None] = lambda text: None,
    ) -> None:
        """Join a domain; the run starts with :meth:`spin`.

        If this fails, nothing remains open and existing files are unchanged.

        Parameters
        ----------
        simulation : Simulation
            Simulation to run.
        pace : {"real_time", "fast", "stepped"}
            Simulated time follows the wall clock, runs as fast as possible, or advances on ``/step`` only.
        domain : int, optional
            DDS domain, from 0 to 232. Default: that of the environment variable ``ROS_DOMAIN_ID``, or else 0.
        network : {"loopback", "all"}
            Whether the node is reachable from this machine only, or from all its networks.
        is_paused : bool
            Whether the node waits for a message on ``/pause`` with false before the first step.
        log : str or path, optional
            File to which each command is written, which replaces an existing file; ``onorbit run --commands``
            repeats the run from it. A run with a log cannot be reset.
        record : str or path, optional
            MCAP file of the messages that the node publishes and of the commands that it executes;
            :meth:`close` completes it and replaces an existing file. A run that is recorded cannot be reset.
        wrench_timeout : float, optional
            Simulated time, s, after which a wrench on a link ends unless another message for the link
            arrives. Default: no timeout.
        keep_rows : int, optional
            Smallest number of latest rows that the run keeps in memory besides the first row; older rows are
            dropped once there are more than twice as many. The trace that :meth:`spin` returns then has only
            the rows kept. Default: all rows.
        has_priority : bool
            Whether the node has real-time priority over other programs (``SCHED_FIFO`` of Linux) in pace
            ``real_time``. A warning is issued where this is not permitted.
        on_message : callable
            Called with the text of each answer and warning on ``/events``, and of each event except
            touch-downs and lift-offs of contacts.

        Raises
        ------
        DtypeError
            If ``simulation`` is not a :class:`Simulation`.
        InputError
            If another argument or ``ROS_DOMAIN_ID`` is invalid.
        Ros2Error
            If the domain cannot be joined, or CycloneDDS does not create the topics.
        OutputFolderError
            If a file cannot be written.
        """
        _check(simulation, pace, log, record)
        self.domain = chosen_domain(domain)
        self._run = LiveRun(simulation, wrench_timeout, keep_rows)
        self._clock = RealTime(self._run.tick)
        self._has_ended = False
        self.duration: float | None = None
        self.topics: Topics = topics(self._run.models, self._run.present(), simulation.orbit)
        with ExitStack() as stack:
            # the threads of DDS inherit the priority
            with prioritized(has_priority and pace == "real_time") as is_prioritized:
                self._participant = Participant(self.domain, network=network)
            stack.callback(self._participant.close)
            self._recording = None if record is None else Recording(record, self.topics)
            if self._recording is not None:
                stack.callback(self._recording.discard)
            self._publisher = Publisher(self._participant, self.topics, on_message, self._recording)
            self._session = Session(self._run, self._publisher, pace, is_paused)
            self._inbox = self._subscribed()
            fixed = "the commands are logged, and a log contains one run" if log is not None else None
            if record is not None:
                fixed = "the run is recorded, and times in a bag do not go back"
            orders = Orders(self._session, self._inbox, lambda: self._clock.restart(0.0), fixed)
            rivals = Rivals(self._participant, self.domain)
            clock = self._clock if pace == "real_time" else None
            self._loop = Loop(self._session, orders, rivals, clock, is_prioritized)
            self._participant.announce(NAME)
            self._run.log = CommandLog(log)  # after everything that may fail, since it replaces the file
            stack.pop_all()

    @classmethod
    def of_scenario(cls, scenario: Any, **options: Any) -> Node:
        """Return the node of a scenario, with the options and errors of :class:`Node`.

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

    def _subscribed(self) -> Inbox:
        """Return the subscriptions to the topics of the run and of each system."""
        inbox = Inbox(self._participant)
        add_run_topics(inbox)
        frames = self.topics.frames
        for system, prefix in self.topics.prefixes.items():
            controls = self._run.controls_of(system)
            add_system_topics(inbox, system, prefix, frames[system], controls)
        return inbox

    @property
    def commands(self) -> list[Entry]:
        """Commands executed so far with their simulated times, s; entries as in a file of commands."""
        return list(self._run.log.entries)

    @property
    def jitter(self) -> dict[str, float]:
        """Delays of the ticks in pace ``real_time``.

        ``late_median_s``, ``late_99_s`` (99 % quantile) and ``late_max_s`` are delays in wall-clock time,
        s; ``missed`` is the fraction of the ticks that are late by more than a tick, ``slipped_s`` the sum of
        the delays that are not caught up, s, and ``ticks`` the number of ticks. The mapping is empty in
        another pace.
        """
        return self._clock.report()

    @property
    def published(self) -> list[tuple[str, str]]:
        """Names and types of the topics that the node publishes."""
        return self._publisher.topics

    @property
    def subscribed(self) -> list[tuple[str, str]]:
        """Names and types of the topics to which the node subscribes."""
        return list(self._inbox.topics())

    def spin(self, duration: float | None = None) -> Trace | WorldTrace:
        """Run until a simulated time, s, or until a signal such as Ctrl-C, and return the trace.

        If ``duration`` is None, only a signal ends the run. If the run begins in a pause or in pace
        ``stepped``, the row at the start is published at once.

        Raises
        ------
        InputError
            If the duration is not positive.
        Ros2Error
            If this node has already run or was closed.
        OnOrbitError
            Errors of the run.
        """
        check_duration(duration)
        if self._has_ended:
            raise Ros2Error("this node has already run or was closed; create another Node for another run")
        self._has_ended = True
        if not self._run.plan(np.inf if duration is None else duration):
            self._session.say(
                WARN, "run",
                "the adaptive steps differ from those of onorbit run, since the state of a Python controller "
                "cannot be restored; give it get_state() and set_state()",
            )  # fmt: skip
        try:
            with (
                dds_errors("continue the run", "create another Node"),
                noted_stop() as self._session.is_stopped,
            ):
                self._loop.spin()
                if self._session.is_stopped():
                    self._session.say(OK, "run", "stopped")
        except KeyboardInterrupt:
            self._session.say(OK, "run", "stopped")
        except OnOrbitError as error:
            with suppress(OnOrbitError):  # a recording on a full disk
                self._session.publish()
            with suppress(OnOrbitError):
                self._session.say(ERROR, "run", f"failed: {error}")
            raise
        self._session.publish()
        trace, rows = self._run.finish()
        self._publisher.rows(rows)
        return trace

    def close(self) -> None:
        """Complete the files, wait up to 1 s for subscribers to receive all messages, and leave the domain.

        A second call has no effect.
        """
        self._has_ended = True
        with ExitStack() as stack:  # each step even if an earlier one fails, as on a full disk
            stack.callback(self._participant.close)
            stack.callback(self._participant.wait_for_delivery, _DELIVERY_S)
            if self._recording is not None:
                stack.callback(self._recording.close)
            self._run.log.close()


def _check(simulation: object, pace: str, log: _File | None, record: _File | None) -> None:
    """Raise an error for an invalid simulation or pace, or if both files of a node are the same."""
    if not isinstance(simulation, Simulation):
        raise DtypeError(
            f"the simulation is {simulation!r:.80}; give a Simulation, or use Node.of_scenario",
            name="simulation", got=simulation, expected="a Simulation",
        )  # fmt: skip
    if pace not in PACES:
        raise InputError(
            f"pace is {pace!r}; give one of {', '.join(PACES)}", name="pace", got=pace, expected=PACES
        )
    if log is not None and record is not None and Path(log).resolve() == Path(record).resolve():
        raise InputError(
            f"log and record are the same file, {record}; give two different files",
            name="log", got=log, expected="a different file from record",
        )  # fmt: skip


def check_duration(duration: float | None) -> None:
    """Raise an InputError if a duration, s, is not positive; None, for an open end, is valid."""
    if duration is not None and not (isinstance(duration, Real) and duration > 0.0):
        raise InputError(
            f"the duration is {duration!r}; it must be a positive number of seconds",
            name="duration", got=duration, expected="a positive number of seconds",
        )  # fmt: skip
