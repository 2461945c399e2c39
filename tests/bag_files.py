"""Reads bags with rosbags and mcap-ros2-support, and computes the numbers that they must contain."""

from __future__ import annotations

from collections import defaultdict
from pathlib import Path
from typing import Any

import numpy as np
import pytest

EXTRA = "the extra ros2 is not installed: pip install 'onorbit-rs[ros2]'"
for package in ("cyclonedds", "rosbags", "mcap"):
    pytest.importorskip(package, reason=EXTRA)
pytest.importorskip("mcap_ros2", reason="mcap-ros2-support, which is in the test extra, is not installed")

from mcap.reader import make_reader  # noqa: E402
from mcap_ros2.decoder import DecoderFactory  # noqa: E402
from rosbags.highlevel import AnyReader  # noqa: E402

from onorbit_rs.ros2.recorded import Recorded  # noqa: E402
from onorbit_rs.ros2.topics import topics  # noqa: E402

Messages = dict[str, list[tuple[int, list[Any]]]]
"""Times, ns, and leaves of the messages of each topic."""


def leaves(content: Any) -> list[Any]:
    """Returns the numbers and texts of a message in order."""
    if isinstance(content, (list, tuple, np.ndarray)):
        return [leaf for item in content for leaf in leaves(item)]
    if isinstance(content, (bool, int, float, str, bytes, np.generic)):
        return [content.item() if isinstance(content, np.generic) else content]
    names = getattr(content, "__dataclass_fields__", None) or content.__slots__
    return [leaf for name in names if name != "__msgtype__" for leaf in leaves(getattr(content, name))]


def read_rosbags(file: Path) -> Messages:
    found: Messages = defaultdict(list)
    with AnyReader([file]) as reader:
        for connection, time, raw in reader.messages():
            content: Any = reader.deserialize(raw, connection.msgtype)
            found[connection.topic].append((time, leaves(content)))
    return found


def read_mcap(file: Path) -> Messages:
    found: Messages = defaultdict(list)
    with file.open("rb") as stream:
        reader = make_reader(stream, validate_crcs=True, decoder_factories=[DecoderFactory()])
        for _, channel, message, content in reader.iter_decoded_messages():
            assert message.log_time == message.publish_time
            found[channel.topic].append((message.log_time, leaves(content)))
    return found


def expected(source: Recorded) -> dict[str, list[tuple[int, list[float]]]]:
    """Returns the time, ns, and the numbers of each message, in order, for topics with a message per row."""
    found: dict[str, list[tuple[int, list[float]]]] = defaultdict(list)
    for series in topics(source.models, source.rows, source.orbit).series:
        rows = source.rows[series.system]
        values = series.values(rows)
        if series.kind == "nav_msgs/msg/Odometry":  # with covariances
            zeros = np.zeros((len(rows), 36))
            values = dict(enumerate([values["p"], values["q"], zeros, values["v"], values["w"], zeros]))  # type: ignore[arg-type]
        table = np.concatenate([np.empty((len(rows), 0)), *values.values()], axis=1).tolist()
        found[series.name] += list(zip(np.rint(rows.time * 1e9).astype(int).tolist(), table, strict=True))
    return found


def numbers(message: list[Any]) -> list[float]:
    """Returns the floating-point numbers of a message."""
    return [leaf for leaf in message if isinstance(leaf, float)]


def differences(found: Messages, wanted: dict[str, list[tuple[int, list[float]]]]) -> list[str]:
    """Returns the names of the topics whose times or numbers differ in any bit."""
    wrong = []
    for topic, rows in wanted.items():
        got = sorted((time, numbers(message)) for time, message in found[topic])
        if got != sorted(rows):
            wrong.append(topic)
    return wrong
