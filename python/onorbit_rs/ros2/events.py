"""Messages of the topic ``/events``: events, answers and warnings."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs.ros2.messages import encode, message, stamp
from onorbit_rs.ros2.transforms import WORLD

if TYPE_CHECKING:
    from onorbit_rs._core import EventRecord

EVENTS, EVENTS_TYPE = "/events", "diagnostic_msgs/msg/DiagnosticArray"
OK, WARN, ERROR = 0, 1, 2
"""Levels of ``diagnostic_msgs/DiagnosticStatus``."""


def message_of_event(record: EventRecord) -> bytes:
    """Return the message of an event, for ``/events``, with numbers in full precision."""
    by, of = record.systems
    numbers = {
        "impulse": record.impulse, "point": record.point,
        "energy_lost": np.array(record.energy_lost), "momentum_error": record.momentum_error,
    }  # fmt: skip
    if record.peak_force is not None:
        numbers["peak_force"] = np.array(record.peak_force)
    values = {"kind": record.kind, "systems": f"{by} {of}"}
    values |= {name: " ".join(map(repr, array.ravel().tolist())) for name, array in numbers.items()}
    return event_message(record.time, record.name, OK, f"{record.kind}: {by} and {of}", values)


def event_message(time: float, name: str, level: int, text: str, values: Mapping[str, str]) -> bytes:
    """Return a message for ``/events``: an event, an answer or a warning, at a simulated time, s."""
    pairs = [message("diagnostic_msgs/msg/KeyValue", key=key, value=value) for key, value in values.items()]
    status = message(
        "diagnostic_msgs/msg/DiagnosticStatus",
        level=level, name=name, message=text, hardware_id="onorbit", values=pairs,
    )  # fmt: skip
    header = message("std_msgs/msg/Header", stamp=stamp(time), frame_id=WORLD)
    return encode(message("diagnostic_msgs/msg/DiagnosticArray", header=header, status=[status]))
