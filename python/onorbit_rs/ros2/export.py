"""Exports runs as bags: MCAP files of ROS 2 messages, or bags of ROS 1."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

import numpy as np

from onorbit_rs.common.files import replacing
from onorbit_rs.ros2.events import EVENTS, EVENTS_TYPE, message_of_event
from onorbit_rs.ros2.mcap_file import McapFile
from onorbit_rs.ros2.messages import nanoseconds
from onorbit_rs.ros2.recorded import Recorded, recorded
from onorbit_rs.ros2.ros1_bag import Ros1Bag
from onorbit_rs.ros2.topics import topics

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs.ros2.recorded import Models, Source
    from onorbit_rs.ros2.rows import Rows

    Floats = NDArray[np.float64]

_ROWS = 1000
"""Rows of a system that are exported at a time."""


class Bag(Protocol):
    """File to which the messages of topics are written."""

    def add_topic(self, name: str, kind: str, *, is_latched: bool = False) -> int:
        """Add a topic with a message type, and return its number for :meth:`write`."""

    def write(self, topic: int, times: NDArray[np.int64], messages: NDArray[np.uint8]) -> None:
        """Write messages (T, size), in CDR, with their times (T,), ns."""


def export_mcap(
    run: Source,
    file: str | os.PathLike[str],
    *,
    models: Models | None = None,
    tell: Callable[[float], None] = lambda done: None,
) -> None:
    """Write a run as an MCAP file of ROS 2 messages: the topics of the live node, with simulated times.

    An existing file is replaced when the new one is complete.

    Parameters
    ----------
    run : str, path, Run, Trace or WorldTrace
        Folder of a run, or its results or trace.
    file : str or path
        File to write.
    models : Model or mapping of str to Model, optional
        Robot of a trace, or robots by the name of the system; only with a trace.
    tell : callable
        Called with the fraction written so far, from 0 to 1.

    Raises
    ------
    InputError
        If the models of a trace are missing or are not those of its systems, or models are given for a run.
    DtypeError
        If ``run`` has another type.
    OutputFolderError
        If the file cannot be written.
    OnOrbitError
        If the folder or its robot cannot be read, or the robot has changed since the run.
    """
    source = recorded(run, models)
    with replacing(Path(file)) as temporary, temporary.open("wb") as stream:
        bag = McapFile(stream)
        _write(source, bag, tell)
        bag.close()


def export_bag(
    run: Source,
    file: str | os.PathLike[str],
    *,
    models: Models | None = None,
    tell: Callable[[float], None] = lambda done: None,
) -> None:
    """Write a run as a bag of ROS 1; arguments and errors as for :func:`export_mcap`.

    The message types of all topics also exist in ROS 1.
    """
    source = recorded(run, models)
    with replacing(Path(file)) as temporary, Ros1Bag(temporary) as bag:
        _write(source, bag, tell)


def _write(source: Recorded, bag: Bag, tell: Callable[[float], None]) -> None:
    """Write all topics of a run."""
    found = topics(source.models, source.rows, source.orbit)
    start = min(rows.time[0] for rows in source.rows.values())
    for latched in found.latched:
        number = bag.add_topic(latched.name, latched.kind, is_latched=True)
        bag.write(number, *_one(start, latched.data))
    numbers = {name: bag.add_topic(name, kind) for name, kind in found.names}
    number = bag.add_topic(EVENTS, EVENTS_TYPE)
    for record in source.events:
        bag.write(number, *_one(record.time, message_of_event(record)))
    for done, part in _windows(source):
        for topic, data in found.messages(part):
            bag.write(numbers[topic.name], nanoseconds(part[topic.system].time), data)
        tell(done)


def _one(time: float, data: bytes) -> tuple[NDArray[np.int64], NDArray[np.uint8]]:
    return nanoseconds([time]), np.frombuffer(data, np.uint8)[None]


def _windows(source: Recorded) -> Iterator[tuple[float, dict[str, Rows]]]:
    """Yield the rows of all systems in consecutive intervals, each with the progress after it (0 to 1)."""
    longest = max(source.rows.values(), key=len).time
    bounds = np.array([-np.inf, *longest[_ROWS::_ROWS], np.inf])
    for count, (start, end) in enumerate(pairwise(bounds), 1):
        part = {system: rows.between(start, end) for system, rows in source.rows.items()}
        yield count / (len(bounds) - 1), part
