"""ROS 2 messages: their types, their encoding as CDR, and templates in which only numbers change."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from rosbags.typesys import Stores, get_typestore

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]

STORE = get_typestore(Stores.ROS2_JAZZY)

_NS = 1_000_000_000
_ALIGNMENT = 4
"""DDS pads a payload to a multiple of this number of bytes."""
_HEADER = 4
"""Size of the header of a payload, bytes; the header names the encoding."""


def message(kind: str, **fields: Any) -> Any:
    """Return a message of a type such as ``std_msgs/msg/Header``, with the given fields."""
    return STORE.types[kind](**fields)


def encode(content: Any) -> bytes:
    """Return a message as CDR, with its header and padding."""
    data = bytes(STORE.serialize_cdr(content, content.__msgtype__))
    return data + bytes(-len(data) % _ALIGNMENT)


def decode(data: bytes, kind: str) -> Any:
    """Return the message in a payload of CDR; a malformed payload raises some exception of the decoder."""
    return STORE.deserialize_cdr(data, kind)


def nanoseconds(time: ArrayLike) -> NDArray[np.int64]:
    """Return times, given in s, as integers in ns."""
    return np.rint(np.asarray(time, dtype=np.float64) * 1e9).astype(np.int64)


def stamp(time: float) -> Any:
    """Return the ROS time of a simulated time, s."""
    sec, nanosec = divmod(int(nanoseconds(time)), _NS)
    return message("builtin_interfaces/msg/Time", sec=sec, nanosec=nanosec)


class Marks:
    """Placeholders for the numbers of a message: random values, each of which occurs once in its bytes."""

    def __init__(self) -> None:
        """Create the placeholder of the time; the others are created on request."""
        self.numbers: dict[str, Floats] = {}
        self._random = np.random.default_rng(20250101)
        self.time = message("builtin_interfaces/msg/Time", sec=0x5A17_C0DE, nanosec=0x3B9A_0B1D)

    def array(self, name: str, count: int) -> Floats:
        """Create and return ``count`` placeholders for the field ``name``."""
        self.numbers[name] = self._random.uniform(1.0, 2.0, count)
        return self.numbers[name]

    def header(self, frame: str) -> Any:
        """Return a header whose time is a placeholder."""
        return message("std_msgs/msg/Header", stamp=self.time, frame_id=frame)


def vector(numbers: Floats) -> Any:
    """Return a ``Vector3`` message with three numbers, xyz."""
    x, y, z = numbers.tolist()
    return message("geometry_msgs/msg/Vector3", x=x, y=y, z=z)


def point(numbers: Floats) -> Any:
    """Return a ``Point`` message with three numbers, xyz."""
    x, y, z = numbers.tolist()
    return message("geometry_msgs/msg/Point", x=x, y=y, z=z)


def quaternion(numbers: Floats) -> Any:
    """Return a ``Quaternion`` message with four numbers, xyzw."""
    x, y, z, w = numbers.tolist()
    return message("geometry_msgs/msg/Quaternion", x=x, y=y, z=z, w=w)


class Template:
    """A message in CDR whose times and numbers change from row to row; names and lengths are constant.

    After its header of four bytes, CDR aligns a number of eight bytes to a multiple of eight: a message is a
    row of such words.
    """

    def __init__(self, build: Callable[[Marks], Any]) -> None:
        """Create the template of the message that ``build`` returns when it is given placeholders."""
        marks = Marks()
        content = build(marks)
        self.kind: str = content.__msgtype__
        data = encode(content)
        self._header, body = data[:_HEADER], data[_HEADER:]
        self._size = len(body)
        self._words = np.frombuffer(body + bytes(-len(body) % 8), np.float64)
        times = np.array([marks.time.sec, marks.time.nanosec], np.uint32).tobytes()
        self._times = [at // 4 for at in _all_offsets(body, times)]
        self._fields = {
            name: np.array([body.index(number.tobytes()) // 8 for number in numbers], np.intp)
            for name, numbers in marks.numbers.items()
        }

    def fill(self, time: Floats, values: Mapping[str, Floats]) -> NDArray[np.uint8]:
        """Return the messages (T, size) for times (T,), s, and the numbers (T, k) of each field."""
        words = np.empty((len(time), len(self._words)))
        words[:] = self._words
        halves = words.view(np.uint32)
        sec, nanosec = np.divmod(nanoseconds(time), _NS)
        for at in self._times:
            halves[:, at], halves[:, at + 1] = sec, nanosec
        for name, places in self._fields.items():
            words[:, places] = values[name]
        rows = np.empty((len(time), _HEADER + self._size), np.uint8)
        rows[:, :_HEADER] = np.frombuffer(self._header, np.uint8)
        rows[:, _HEADER:] = words.view(np.uint8)[:, : self._size]
        return rows


def _all_offsets(raw: bytes, part: bytes) -> list[int]:
    """Return the offsets of all occurrences of ``part``."""
    found = []
    at = raw.find(part)
    while at >= 0:
        found.append(at)
        at = raw.find(part, at + len(part))
    return found
