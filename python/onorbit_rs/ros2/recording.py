"""Records the messages that a live node publishes, and the commands that it executes."""

from __future__ import annotations

import os
from collections import defaultdict
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs.common.files import output_errors, replacing
from onorbit_rs.ros2.extra import require
from onorbit_rs.ros2.messages import nanoseconds
from onorbit_rs.ros2.rows import Rows

if TYPE_CHECKING:
    from collections.abc import Mapping

    from onorbit_rs.ros2.topics import Topics

_CHUNK_BYTES = 1 << 17
"""Length of a chunk, bytes, whose compression takes 0.3 ms, so that a node in real time is not late."""
_ROWS = 64
"""Number of rows whose messages are computed together, which is 30 times as fast as one by one."""


class _DiscardedError(Exception):
    """Raised to abandon a file that must not be completed."""


class Recording:
    """An MCAP file that is written while the node runs; it has a temporary name until :meth:`close`."""

    def __init__(self, file: str | os.PathLike[str], topics: Topics) -> None:
        """Create the file and write the latched messages, at time zero.

        Raises
        ------
        Ros2Error
            If the package mcap is not installed.
        OutputFolderError
            If the file cannot be written.
        """
        require("mcap")
        from onorbit_rs.ros2.mcap_file import McapFile

        self._topics, self._file = topics, Path(file)
        self._pending: defaultdict[str, list[Rows]] = defaultdict(list)
        self._is_closed = False
        with ExitStack() as stack:
            stream = stack.enter_context(stack.enter_context(replacing(self._file)).open("wb"))
            self._bag = McapFile(stream, chunk_bytes=_CHUNK_BYTES)
            self._numbers = {name: self._bag.add_topic(name, kind) for name, kind in topics.names}
            for topic in topics.latched:
                self._numbers[topic.name] = self._bag.add_topic(topic.name, topic.kind, is_latched=True)
                self.message(topic.name, topic.kind, 0.0, topic.data)
            self._open = stack.pop_all()

    def rows(self, rows: Mapping[str, Rows]) -> None:
        """Record the messages of the rows of each system; raise OutputFolderError on a full disk."""
        for system, part in rows.items():
            self._pending[system].append(part)
        if max(sum(map(len, parts)) for parts in self._pending.values()) >= _ROWS:
            with output_errors(self._file):
                self._write_rows()

    def _write_rows(self) -> None:
        rows = {system: Rows.joined(parts) for system, parts in self._pending.items()}
        for topic, data in self._topics.messages(rows) if rows else ():
            self._bag.write(self._numbers[topic.name], nanoseconds(rows[topic.system].time), data)
        self._pending.clear()

    def message(self, topic: str, kind: str, time: float, data: bytes) -> None:
        """Record a message, in CDR, of a simulated time, s; raise OutputFolderError on a full disk."""
        with output_errors(self._file):
            if topic not in self._numbers:
                self._numbers[topic] = self._bag.add_topic(topic, kind)
            self._bag.write(self._numbers[topic], nanoseconds([time]), np.frombuffer(data, np.uint8)[None])

    def discard(self) -> None:
        """Remove what was written; an existing file remains. After :meth:`close` this has no effect."""
        if not self._is_closed:
            self._is_closed = True
            with suppress(_DiscardedError), self._open:
                raise _DiscardedError

    def close(self) -> None:
        """Complete the file and give it its name, replacing an existing file; a second call has no effect."""
        if not self._is_closed:
            self._is_closed = True
            with self._open:
                self._write_rows()
                self._bag.close()
