"""A node that runs a simulation, publishes its topics and obeys its command topics."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from onorbit_rs.exceptions import InputError, OnOrbitError
from onorbit_rs.ros2.inbox import Arrived, Entry, Inbox, add_run_topics, add_system_topics
from onorbit_rs.ros2.pace import PACES, RealTime
from onorbit_rs.ros2.participant import Participant, Writer
from onorbit_rs.ros2.rows import Rows, rows_of_columns, rows_of_trace
from onorbit_rs.ros2.topics import ERROR, EVENTS, EVENTS_TYPE, OK, WARN, Topics, event_message, topics
from onorbit_rs.scenario import WorldScenario, load
from onorbit_rs.scenario.build import build
from onorbit_rs.scenario.build_world import build_world

if TYPE_CHECKING:
    from onorbit_rs._core import Model, Simulation, Stepper, Trace, WorldTrace

_IDLE_S = 1e-3
"""Wall-clock time between two looks at the topics while the simulation waits, s."""
_BLOCK_S = 0.02
"""Simulated time that a node in pace ``fast`` advances between two looks at the topics, s."""
_DELIVERY_S = 1.0
"""Longest time that a node waits for subscribers that have not received all messages at its end, s."""
_SHORTEST_TICK = 1e-3
"""Shortest simulated time between two looks at the topics, unless the time step is longer, s."""


class Node:
    """A simulation as a ROS 2 participant, without an installation of ROS 2.

    The node publishes each recorded row. Commands take effect at the next update of the controllers after the
    simulated time at which they are read, which ``commands`` records.

    Attributes
    ----------
    commands : list of dict
        Commands obeyed so far with their simulated times, s; entries as in a command file.
    jitter : dict
        How late the node was in pace ``real_time``.
    """

    def __init__(
        self,
        simulation: Simulation,
        *,
        pace: str = "real_time",
        domain: int = 0,
        network: str = "loopback",
        is_paused: bool = False,
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
        on_message : callable
            Called with each text that also goes to ``/events``.

        Raises
        ------
        InputError
            If an argument is invalid.
        Ros2Error
            If the domain cannot be joined.
        """
        if pace not in PACES:
            raise InputError(
                f"pace is {pace!r}; give one of {', '.join(PACES)}", name="pace", got=pace, expected=PACES
            )
        self._simulation, self._pace, self._tell = simulation, pace, on_message
        self._models: Mapping[str, Model] = simulation.models
        self._tick = _tick(simulation)
        self._participant = Participant(domain, network=network)
        self._is_paused = is_paused
        self.duration: float | None = None
        self.commands: list[Entry] = []
        self._clock = RealTime(self._tick)
        self.topics: Topics = topics(self._models, self._first_rows())
        self._stepper, self._rows = self._started()
        kinds = {topic.name: topic.kind for topic in self.topics.series}  # several series may share a topic
        self._writers = {name: self._participant.writer(name, kind) for name, kind in kinds.items()}
        for latched in self.topics.latched:
            writer = self._participant.writer(latched.name, latched.kind, is_latched=True)
            writer.write(latched.data)
        self._events: Writer = self._participant.writer(EVENTS, EVENTS_TYPE)
        self._inbox = self._subscribed()
        self._participant.announce("onorbit")

    @property
    def jitter(self) -> dict[str, float]:
        """How late the node was in pace ``real_time``, s; empty otherwise."""
        return self._clock.report()

    @classmethod
    def of_scenario(cls, scenario: Any, **options: Any) -> Node:
        """Return the node of a scenario, with the options of :class:`Node`.

        Parameters
        ----------
        scenario : str, path, mapping or Scenario
            As for :func:`onorbit_rs.run`; its duration is the attribute ``duration``.
        """
        checked = load(scenario)
        built = build_world(checked) if isinstance(checked, WorldScenario) else build(checked)
        node = cls(built.simulation, **options)
        node.duration = checked.simulation.duration
        return node

    @property
    def published(self) -> list[tuple[str, str]]:
        """Names and types of the topics that the node publishes."""
        latched = [(topic.name, topic.kind) for topic in self.topics.latched]
        return [*self.topics.names, *latched, (EVENTS, EVENTS_TYPE)]

    @property
    def subscribed(self) -> list[tuple[str, str]]:
        """Names and types of the topics that the node listens to."""
        return list(self._inbox.topics())

    def _started(self) -> tuple[Stepper, dict[str, int]]:
        return self._simulation.start(), dict.fromkeys(self._models, 0)

    def _first_rows(self) -> dict[str, Rows]:
        """Return the row at the start, from a second run."""
        probe = self._simulation.start()
        probe.advance_to(self._simulation.time_step)
        return rows_of_columns(probe.columns(), self._models)

    def _subscribed(self) -> Inbox:
        inbox = Inbox(self._participant)
        add_run_topics(inbox)
        for system, model in self._models.items():
            external = getattr(self._of(system), "external", {})
            add_system_topics(inbox, system, self.topics.prefixes[system], model, external)
        return inbox

    def _of(self, system: str) -> Any:
        return self._stepper[system] if len(self._models) > 1 else self._stepper

    def spin(self, duration: float | None = None) -> Trace | WorldTrace:
        """Run until a simulated time, s, or without an end, and return the trace; Ctrl-C ends the run too.

        Raises
        ------
        OnOrbitError
            Errors of the run.
        """
        end = float("inf") if duration is None else duration
        try:
            while self._stepper.time < end:
                self._obey()
                if self._is_paused or self._pace == "stepped":
                    self._clock.restart(self._stepper.time)
                    time.sleep(_IDLE_S)
                    continue
                if self._pace == "real_time":
                    self._clock.wait(self._stepper.time)
                self._advance(min(self._next(), end))
        except KeyboardInterrupt:
            self._say(OK, "run", "stopped")
        self._publish()
        trace = self._stepper.finish()
        self._publish_rows(rows_of_trace(trace, self._models, self._rows))  # the row at the end
        return trace

    def _next(self) -> float:
        """Return the next time at which the node looks at its topics, on the grid of ticks."""
        block = self._tick if self._pace == "real_time" else max(self._tick, _BLOCK_S)
        return self._tick * (round(self._stepper.time / self._tick) + round(block / self._tick))

    def _advance(self, t: float) -> None:
        self._stepper.advance_to(t)
        self._publish()

    def _publish(self) -> None:
        """Publish the rows since the last call."""
        since = self._rows if len(self._models) > 1 else next(iter(self._rows.values()))
        columns = self._stepper.columns(since)
        for system in self._models:
            own = columns["time"] if "time" in columns else columns[f"{system}/time"]
            self._rows[system] += len(own)
        self._publish_rows(rows_of_columns(columns, self._models))

    def _publish_rows(self, rows: Mapping[str, Rows]) -> None:
        found = list(self.topics.messages(rows))
        for k in range(max((len(data) for _, data in found), default=0)):
            for topic, data in found:
                if k < len(data):
                    self._writers[topic.name].write(data[k].tobytes())

    def _obey(self) -> None:
        """Obey the messages that have arrived."""
        for arrived in self._inbox.take():
            if arrived.is_second_sender:
                self._say(WARN, arrived.topic, "has several senders; the last message holds")
            if arrived.refusal is not None:
                self._say(ERROR, arrived.topic, f"refused: {arrived.refusal}")
            for entry in arrived.entries:
                self._obey_entry(arrived, entry)

    def _obey_entry(self, arrived: Arrived, entry: Entry) -> None:
        if "pause" in entry:
            self._is_paused = entry["pause"]
            self._say(OK, arrived.topic, "paused" if self._is_paused else "running")
        elif "reset" in entry:
            self._stepper, self._rows = self._started()
            self.commands.clear()
            self._clock.restart(0.0)
            self._say(OK, arrived.topic, "reset to t = 0 s")
        elif "step" in entry:
            self._step(arrived.topic, entry["step"])
        else:
            self._command(arrived.topic, entry)

    def _step(self, topic: str, length: float) -> None:
        """Advance by a length of simulated time, s."""
        if not 0.0 < length < float("inf"):
            self._say(ERROR, topic, f"refused: the step is {length!r} s; it must be positive and finite")
            return
        self._advance(self._stepper.time + length)
        self._say(OK, topic, f"advanced to t = {self._stepper.time:.9g} s")

    def _command(self, topic: str, entry: Entry) -> None:
        from onorbit_rs.simulation.commands import apply

        timed = {"time": self._stepper.time, **entry}
        try:
            apply(self._stepper, timed)
        except OnOrbitError as error:
            self._say(ERROR, topic, f"refused: {error}")
            return
        self.commands.append(timed)
        if "trigger" in entry:
            self._say(OK, topic, f"{entry['trigger']} is due at t = {self._stepper.time:.9g} s")

    def _say(self, level: int, name: str, text: str) -> None:
        """Publish an event or an answer."""
        self._events.write(event_message(self._stepper.time, name, level, text, {}))
        self._tell(f"{name}: {text}")

    def close(self) -> None:
        """Leave the domain, after subscribers have received all messages; no effect the second time."""
        self._participant.wait_for_delivery(_DELIVERY_S)
        self._participant.close()


def _tick(simulation: Simulation) -> float:
    """Return the simulated time between two looks at the topics, s: a row, or a few steps of a long one."""
    steps = max(1, min(simulation.record_every, round(_SHORTEST_TICK / simulation.time_step)))
    return simulation.time_step * steps
