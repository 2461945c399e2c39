"""Writes bags of ROS 1."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from rosbags.rosbag1 import Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from onorbit_rs.ros2.messages import STORE

if TYPE_CHECKING:
    from types import TracebackType

    import numpy as np
    from numpy.typing import NDArray
    from rosbags.interfaces import Connection

_TF = "tf2_msgs/msg/TFMessage"
"""Type that the ROS 1 store of rosbags lacks, and whose definition is the same in ROS 1 and ROS 2."""


class Ros1Bag:
    """A bag of ROS 1, to which messages of ROS 2 are written; a context manager that completes the file."""

    def __init__(self, file: Path) -> None:
        """Remove an existing file; the new one is created when the context is entered."""
        file.unlink(missing_ok=True)  # rosbags writes new files only
        self._store = get_typestore(Stores.ROS1_NOETIC)
        self._store.register({_TF: get_types_from_msg(STORE.generate_msgdef(_TF)[0], _TF)[_TF]})
        self._writer = Writer(file)
        self._writer.set_compression(Writer.CompressionFormat.LZ4)
        self._topics: list[Connection] = []

    def __enter__(self) -> Ros1Bag:
        """Create the file."""
        self._writer.open()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Write the index and close the file."""
        self._writer.__exit__(kind, error, trace)

    def add_topic(self, name: str, kind: str, *, is_latched: bool = False) -> int:
        """Add a topic, and return its number for :meth:`write`."""
        latching = int(is_latched)
        self._topics.append(self._writer.add_connection(name, kind, typestore=self._store, latching=latching))
        return len(self._topics) - 1

    def write(self, topic: int, times: NDArray[np.int64], messages: NDArray[np.uint8]) -> None:
        """Write CDR-encoded messages, (T, size), with the timestamps ``times``, (T,), ns, to a topic."""
        connection = self._topics[topic]
        for time, data in zip(times.tolist(), messages, strict=True):
            self._writer.write(connection, time, STORE.cdr_to_ros1(data.tobytes(), connection.msgtype))
