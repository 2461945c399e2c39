"""Reads joint motions from ROS bags: MCAP and SQLite files of ROS 2, and bags of ROS 1."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from onorbit_rs.common.counting import count
from onorbit_rs.common.input_files import check_regular
from onorbit_rs.common.suggestions import did_you_mean
from onorbit_rs.exceptions import OnOrbitError, ReadError
from onorbit_rs.ros2.extra import require

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

STATES, TRAJECTORY = "sensor_msgs/msg/JointState", "trajectory_msgs/msg/JointTrajectory"
SUFFIXES = (".mcap", ".db3", ".bag")


class Sample(NamedTuple):
    """Positions, rad or m, and rates, rad/s or m/s, of joints at one time."""

    origin: str
    """Message or point in the bag, such as ``message 3`` or ``point 3``."""
    time: int
    """Time since the first message, or since the start of a trajectory, ns."""
    names: tuple[str, ...]
    positions: Floats
    """Positions (n,), rad or m."""
    rates: Floats
    """Rates (n,), rad/s or m/s; (0,) if they are not recorded."""


def read_samples(path: Path, topic: str | None) -> tuple[str, list[Sample]]:
    """Return the name of a topic of a bag, and the joint motion recorded on this topic.

    Parameters
    ----------
    path : path
        MCAP file, SQLite file or folder written by rosbag2, or ROS 1 bag.
    topic : str or None
        Name of the topic; default: the only topic with joint motion.

    Raises
    ------
    NotFoundError, ReadError
        If the file does not exist, is not a bag or is damaged; if the topic is missing, ambiguous or without
        joint motion; or if the topic has trajectories, but not exactly one.
    Ros2Error
        If rosbags is not installed.
    """
    require("rosbags")
    if not (path.is_dir() and (path / "metadata.yaml").is_file()):
        check_regular(path, "bag")
        if path.suffix not in SUFFIXES:
            endings = ", ".join(SUFFIXES)
            raise _error(
                path,
                f"its name must end in one of {endings}, or it must be a folder with the metadata.yaml of a "
                "bag",
            )
    with _opened(path) as reader:
        of_joints = {each.topic: each for each in reader.connections if each.msgtype in (STATES, TRAJECTORY)}
        chosen = of_joints[_choice(path, topic, list(of_joints), sorted(reader.topics))]
        wanted = [each for each in reader.connections if each.topic == chosen.topic]
        contents = [
            (time, reader.deserialize(raw, connection.msgtype))
            for connection, time, raw in reader.messages(wanted)
        ]
    if chosen.msgtype == STATES:
        return chosen.topic, _samples_of_states(contents)
    if len(contents) != 1:
        found = count(len(contents), "trajectory", "trajectories")
        message = (
            f"topic {chosen.topic} has {found}; a reference requires exactly one; give another 'topic' or "
            "record a bag with one trajectory"
        )
        raise _error(path, message)
    return chosen.topic, _samples_of_trajectory(contents[0][1])


@contextmanager
def _opened(path: Path) -> Iterator[Any]:
    """Open a bag; all errors of the reader are converted to :class:`ReadError`."""
    from rosbags.highlevel import AnyReader
    from rosbags.typesys import Stores, get_typestore

    try:
        with AnyReader([path], default_typestore=get_typestore(Stores.ROS2_JAZZY)) as reader:
            yield reader
    except OnOrbitError:
        raise
    except Exception as error:  # errors of struct, zstd, sqlite3 and others, in addition to those of rosbags
        raise _error(
            path, f"it is not a bag, or it is damaged or truncated ({error}); record or copy it again"
        ) from error


def _choice(path: Path, topic: str | None, of_joints: list[str], topics: list[str]) -> str:
    """Return the name of the topic to read; raise ReadError if it is missing or not unique."""
    known = ", ".join(of_joints)
    if not of_joints:
        held = ", ".join(topics) or "none"
        raise _error(
            path,
            f"it has no topic with JointState or JointTrajectory messages (its topics: {held}); give another "
            "bag",
        )
    if topic is None:
        if len(of_joints) > 1:
            raise _error(path, f"it has several topics with joint motions ({known}); give one as 'topic'")
        return of_joints[0]
    if topic not in of_joints:
        if topic in topics:
            raise _error(path, f"topic {topic} contains no joint motions; topics with joint motions: {known}")
        raise _error(path, f"it has no topic {topic!r}{did_you_mean(topic, of_joints)}")
    return topic


def _samples_of_states(contents: list[tuple[int, Any]]) -> list[Sample]:
    """Return the samples of JointState messages, with times since the first message."""
    stamps = [_nanoseconds(content.header.stamp) for _, content in contents]
    if not any(stamps):  # the headers have no times; the times of recording are used
        stamps = [time for time, _ in contents]
    return [
        Sample(
            f"message {number}", stamp - stamps[0], tuple(content.name), content.position, content.velocity
        )
        for number, (stamp, (_, content)) in enumerate(zip(stamps, contents, strict=True), 1)
    ]


def _samples_of_trajectory(content: Any) -> list[Sample]:
    names = tuple(content.joint_names)
    return [
        Sample(
            f"point {number}", _nanoseconds(point.time_from_start), names, point.positions, point.velocities
        )
        for number, point in enumerate(content.points, 1)
    ]


def _nanoseconds(time: Any) -> int:
    return int(time.sec) * 1_000_000_000 + int(time.nanosec)


def _error(path: Path, why: str) -> ReadError:
    return ReadError(f"{path} cannot be used: {why}", path=str(path), kind="bag")
