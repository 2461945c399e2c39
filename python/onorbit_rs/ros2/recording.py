"""Records what a live node publishes and the commands that it obeys."""

from __future__ import annotations

import os
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs.common.files import replacing
from onorbit_rs.ros2.extra import require
from onorbit_rs.ros2.messages import nanoseconds

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import ArrayLike, NDArray

    from onorbit_rs.ros2.topics import Latched

_CHUNK_BYTES = 1 << 17
"""Length of a chunk before compression: 0.3 ms to compress, so that a node in real time is not late."""


class Recording:
    """An MCAP file that has its name after :meth:`close`, and is absent before."""

    def __init__(self, file: str | os.PathLike[str], latched: Iterable[Latched]) -> None:
        """Begin a file with messages at time zero.

        Raises
        ------
        Ros2Error
            If the package mcap is not installed.
        OutputFolderError
            If the file cannot be written.
        """
        require("mcap")
        from onorbit_rs.ros2.mcap_file import McapFile

        with ExitStack() as stack:
            stream = stack.enter_context(stack.enter_context(replacing(Path(file))).open("wb"))
            self._bag = McapFile(stream, chunk_bytes=_CHUNK_BYTES)
            self._numbers: dict[str, int] = {}
            for topic in latched:
                self._numbers[topic.name] = self._bag.add_topic(topic.name, topic.kind, is_latched=True)
                self.write_one(topic.name, topic.kind, 0.0, topic.data)
            self._open = stack.pop_all()
        self._is_closed = False

    def write(self, topic: str, kind: str, times: ArrayLike, messages: NDArray[np.uint8]) -> None:
        """Write messages (T, size), in CDR, of simulated times (T,), s."""
        if topic not in self._numbers:
            self._numbers[topic] = self._bag.add_topic(topic, kind)
        self._bag.write(self._numbers[topic], nanoseconds(times), messages)

    def write_one(self, topic: str, kind: str, time: float, data: bytes) -> None:
        """Write a message, in CDR, of a simulated time, s."""
        self.write(topic, kind, [time], np.frombuffer(data, np.uint8)[None])

    def close(self) -> None:
        """Complete the file; no effect the second time."""
        if not self._is_closed:
            self._is_closed = True
            with self._open:
                self._bag.close()
