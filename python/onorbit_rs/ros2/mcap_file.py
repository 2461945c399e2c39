"""Writes MCAP files of ROS 2 messages, many messages at a time.

The writer of the package ``mcap`` accepts messages one by one. Here numpy composes the records of all
messages of a topic in a chunk; the other records are those of the package.
"""

from __future__ import annotations

import zlib
from collections import Counter, defaultdict
from typing import TYPE_CHECKING, BinaryIO

import numpy as np
import yaml
from mcap.data_stream import RecordBuilder
from mcap.opcode import Opcode
from mcap.records import Channel, Chunk, ChunkIndex, DataEnd, Footer, Header, McapRecord, Schema, Statistics
from mcap.writer import MCAP0_MAGIC
from zstandard import ZstdCompressor

from onorbit_rs._core import build_info
from onorbit_rs.ros2.messages import STORE

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    Block = tuple[NDArray[np.int64], NDArray[np.uint8]]
    """Times (T,), ns, and messages (T, size) of one topic."""

_HEADER = [("opcode", "u1"), ("length", "<u8")]
_PREFIX = 9
"""Size of opcode and length, bytes, which the length of a record does not include."""
_CHECKSUM = 4
"""Size of the checksum at the end of a footer, bytes."""
_INDEX_ENTRY = np.dtype([("time", "<u8"), ("offset", "<u8")])
_FOREVER = {"sec": 9223372036, "nsec": 854775807}


class McapFile:
    """An MCAP file of ROS 2 messages, with an index; it is complete after :meth:`close`.

    Within a chunk, the messages of each topic are adjacent; readers return them in the order of time.
    """

    def __init__(self, stream: BinaryIO, *, chunk_bytes: int = 1 << 22) -> None:
        """Write the start of the file to a stream; a chunk ends when it has ``chunk_bytes`` or more."""
        self._stream, self._chunk_bytes = stream, chunk_bytes
        self._schemas: dict[str, Schema] = {}
        self._channels: list[Channel] = []
        self._pending: defaultdict[int, list[Block]] = defaultdict(list)
        self._pending_bytes = 0
        self._chunks: list[ChunkIndex] = []
        self._counts: Counter[int] = Counter()
        self._compressor = ZstdCompressor(level=1)
        stream.write(MCAP0_MAGIC)
        self._write(Header(profile="ros2", library=f"onorbit_rs {build_info()['version']}"))

    def add_topic(self, name: str, kind: str, *, is_latched: bool = False) -> int:
        """Add a topic, and return its number for :meth:`write`; raise TypesysError for an unknown type."""
        if kind not in self._schemas:
            text = STORE.generate_msgdef(kind, ros_version=2)[0]
            self._schemas[kind] = Schema(
                id=len(self._schemas) + 1, data=text.encode(), encoding="ros2msg", name=kind
            )
            self._write(self._schemas[kind])
        number = len(self._channels) + 1
        metadata = {
            "offered_qos_profiles": _qos(is_latched=is_latched), "topic_type_hash": STORE.hash_rihs01(kind)
        }  # fmt: skip
        channel = Channel(
            id=number, topic=name, message_encoding="cdr", metadata=metadata, schema_id=self._schemas[kind].id
        )
        self._channels.append(channel)
        self._write(channel)
        return number

    def write(self, topic: int, times: NDArray[np.int64], messages: NDArray[np.uint8]) -> None:
        """Add messages (T, size), in CDR, of times (T,), ns.

        They are written by the next :meth:`flush`, which this method calls if the chunk is full; the arrays
        must not change until then.
        """
        if not len(times):
            return
        self._pending[topic].append((times, messages))
        self._pending_bytes += messages.nbytes
        if self._pending_bytes >= self._chunk_bytes:
            self.flush()

    def flush(self) -> None:
        """Write the messages added since the last chunk as a chunk."""
        if not self._pending:
            return
        parts, indices, at = [], {}, 0
        for topic, blocks in self._pending.items():
            entries = []
            for times, messages in _joined(blocks):
                records = _message_records(topic, times, messages)
                entry = np.empty(len(times), _INDEX_ENTRY)
                entry["time"], entry["offset"] = times, at + records.itemsize * np.arange(len(times))
                entries.append(entry)
                parts.append(records.tobytes())
                at += records.nbytes
            indices[topic] = np.concatenate(entries)
            self._counts[topic] += len(indices[topic])
        self._write_chunk(b"".join(parts), indices)
        self._pending.clear()
        self._pending_bytes = 0

    def _write_chunk(self, raw: bytes, indices: dict[int, NDArray[np.void]]) -> None:
        start = int(min(index["time"].min() for index in indices.values()))
        end = int(max(index["time"].max() for index in indices.values()))
        data = self._compressor.compress(raw)
        chunk_at = self._stream.tell()
        self._write(
            Chunk(
                compression="zstd", data=data, message_end_time=end, message_start_time=start,
                uncompressed_crc=zlib.crc32(raw), uncompressed_size=len(raw),
            )
        )  # fmt: skip
        index_at, offsets = self._stream.tell(), {}
        for topic, index in indices.items():
            offsets[topic] = self._stream.tell()
            self._stream.write(_index_record(topic, index))
        self._chunks.append(
            ChunkIndex(
                chunk_length=index_at - chunk_at, chunk_start_offset=chunk_at, compression="zstd",
                compressed_size=len(data), message_end_time=end,
                message_index_length=self._stream.tell() - index_at, message_index_offsets=offsets,
                message_start_time=start, uncompressed_size=len(raw),
            )
        )  # fmt: skip

    def close(self) -> None:
        """Write the last chunk, the summary and the end of the file; the stream stays open."""
        self.flush()
        self._write(DataEnd(0))
        summary_at = self._stream.tell()
        summary = _encoded([*self._schemas.values(), *self._channels, *self._chunks, self._statistics()])
        unchecked = _encoded([Footer(summary_at, 0, 0)])[:-_CHECKSUM]
        self._stream.write(summary)
        self._write(Footer(summary_at, 0, zlib.crc32(unchecked, zlib.crc32(summary))))
        self._stream.write(MCAP0_MAGIC)

    def _statistics(self) -> Statistics:
        return Statistics(
            attachment_count=0, channel_count=len(self._channels), channel_message_counts=dict(self._counts),
            chunk_count=len(self._chunks), message_count=self._counts.total(), metadata_count=0,
            message_start_time=min((chunk.message_start_time for chunk in self._chunks), default=0),
            message_end_time=max((chunk.message_end_time for chunk in self._chunks), default=0),
            schema_count=len(self._schemas),
        )  # fmt: skip

    def _write(self, record: McapRecord) -> None:
        self._stream.write(_encoded([record]))


def _encoded(records: Iterable[McapRecord]) -> bytes:
    builder = RecordBuilder()
    for record in records:
        record.write(builder)
    data: bytes = builder.end()  # type: ignore[no-untyped-call]
    return data


def _joined(blocks: list[Block]) -> list[Block]:
    """Return the blocks, with neighbours joined if their messages have the same length."""
    runs: list[list[Block]] = []
    for block in blocks:
        if runs and runs[-1][-1][1].shape[1] == block[1].shape[1]:
            runs[-1].append(block)
        else:
            runs.append([block])
    return [(np.concatenate([t for t, _ in run]), np.concatenate([rows for _, rows in run])) for run in runs]


def _message_records(topic: int, times: NDArray[np.int64], messages: NDArray[np.uint8]) -> NDArray[np.void]:
    """Return the MCAP records of messages (T, size), in CDR, of a topic at times (T,), ns."""
    size = messages.shape[1]
    kind = np.dtype(
        [*_HEADER, ("channel", "<u2"), ("sequence", "<u4"), ("log_time", "<u8"), ("publish_time", "<u8"),
         ("data", "u1", (size,))]
    )  # fmt: skip
    records = np.empty(len(times), kind)
    records["opcode"], records["length"] = Opcode.MESSAGE, kind.itemsize - _PREFIX
    records["channel"], records["sequence"] = topic, 0
    records["log_time"] = records["publish_time"] = times
    records["data"] = messages
    return records


def _index_record(topic: int, index: NDArray[np.void]) -> bytes:
    """Return the record that lists times and offsets of the messages of a topic in a chunk."""
    kind = np.dtype(
        [*_HEADER, ("channel", "<u2"), ("bytes", "<u4"), ("entries", _INDEX_ENTRY, (len(index),))]
    )
    record = np.empty((), kind)
    record["opcode"], record["length"] = Opcode.MESSAGE_INDEX, kind.itemsize - _PREFIX
    record["channel"], record["bytes"], record["entries"] = topic, index.nbytes, index
    return record.tobytes()


def _qos(*, is_latched: bool) -> str:
    """Return the quality of service with which ``ros2 bag play`` offers a topic, as rosbag2 writes it."""
    profile = {
        "history": "keep_last", "depth": 1 if is_latched else 10, "reliability": "reliable",
        "durability": "transient_local" if is_latched else "volatile",
        "deadline": _FOREVER, "lifespan": _FOREVER,
        "liveliness": "automatic", "liveliness_lease_duration": _FOREVER,
        "avoid_ros_namespace_conventions": False,
    }  # fmt: skip
    return yaml.safe_dump([profile], sort_keys=False)
