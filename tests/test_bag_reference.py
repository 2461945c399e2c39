"""Recorded motions of joints as references: from MCAP, SQLite and ROS 1; invalid recordings."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from bag_files import EXTRA

import onorbit_rs as oo
from onorbit_rs.exceptions import FrameError, NotFoundError, OnOrbitError, ReadError, Ros2Error
from onorbit_rs.ros2 import extra
from onorbit_rs.ros2.messages import STORE, message, stamp
from onorbit_rs.scenario import load

pytest.importorskip("rosbags", reason=EXTRA)

from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

STATES, TRAJECTORY = "sensor_msgs/msg/JointState", "trajectory_msgs/msg/JointTrajectory"
MODEL = oo.robots.load("humanoid_torso")
NAMES = list(MODEL.joint_names)
TIMES = np.arange(21) * 0.02
POSITIONS = 0.1 * np.sin(np.outer(TIMES, np.arange(1, 8)))
RATES = 0.1 * np.arange(1, 8) * np.cos(np.outer(TIMES, np.arange(1, 8)))


def state(time: float, names: Sequence[str], position: Any, velocity: Any = ()) -> Any:
    header = message("std_msgs/msg/Header", stamp=stamp(time), frame_id="")
    numbers = {"position": position, "velocity": velocity, "effort": ()}
    return message(
        STATES,
        header=header,
        name=list(names),
        **{key: np.array(part, float) for key, part in numbers.items()},
    )


def states(first: float = 1.7e9, *, with_rates: bool = True) -> list[Any]:
    rows = zip(TIMES, POSITIONS, RATES if with_rates else [()] * len(TIMES), strict=True)
    return [state(first + time, NAMES, position, rate) for time, position, rate in rows]


def trajectory() -> Any:
    header = message("std_msgs/msg/Header", stamp=stamp(5.0), frame_id="")
    points = [
        message(
            "trajectory_msgs/msg/JointTrajectoryPoint", positions=position, velocities=rate,
            accelerations=np.zeros(0), effort=np.zeros(0),
            time_from_start=message(
                "builtin_interfaces/msg/Duration", sec=stamp(time).sec, nanosec=stamp(time).nanosec
            ),
        )
        for time, position, rate in zip(TIMES, POSITIONS, RATES, strict=True)
    ]  # fmt: skip
    return message(TRAJECTORY, header=header, joint_names=NAMES, points=points)


def folder(path: Path, topics: dict[str, list[Any]], plugin: StoragePlugin = StoragePlugin.MCAP) -> Path:
    """Writes a folder of rosbag2 with messages at 1 s, 2 s, …; returns the file in it."""
    with Writer(path, version=9, storage_plugin=plugin) as bag:
        for topic, contents in topics.items():
            connection = bag.add_connection(topic, contents[0].__msgtype__, typestore=STORE)
            for number, content in enumerate(contents, 1):
                data = STORE.serialize_cdr(content, content.__msgtype__)
                bag.write(connection, number * 10**9, data)
    (file,) = path.glob(f"{path.name}.*")
    return file


def ros1(path: Path) -> Path:
    store = get_typestore(Stores.ROS1_NOETIC)
    with Writer1(path) as bag:
        connection = bag.add_connection("/joint_states", STATES, typestore=store)
        for number, content in enumerate(states()):
            raw = STORE.cdr_to_ros1(STORE.serialize_cdr(content, STATES), STATES)
            bag.write(connection, number * 10**9, raw)
    return path


def reference(path: Path, folder: Path | None = None, **keys: Any) -> oo.JointReference:
    """Returns the reference of a scenario in a file, with the recording at ``path``."""
    data = {
        "robot": "humanoid_torso",
        "controller": {"kind": "joint_computed_torque", "kp": 10, "kd": 6},
        "reference": {"kind": "bag", "file": str(path)} | keys,
        "simulation": {"duration": "0.1 s", "time_step": "1 ms"},
    }
    file = (folder or path.parent) / "mine.yaml"
    file.write_text(yaml.safe_dump(data, sort_keys=False))
    scenario: Any = load(file)
    from onorbit_rs.scenario.build import build

    built = build(scenario)
    assert isinstance(built.reference, oo.JointReference)
    return built.reference


def test_a_recording_is_the_sampled_motion(tmp_path: Path) -> None:
    sources = {
        "mcap": folder(tmp_path / "a", {"/joint_states": states()}),
        "folder": folder(tmp_path / "b", {"/joint_states": states()}).parent,
        "sqlite": folder(tmp_path / "c", {"/joint_states": states()}, StoragePlugin.SQLITE3),
        "ros1": ros1(tmp_path / "d.bag"),
        "trajectory": folder(tmp_path / "e", {"/arm/joint_trajectory": [trajectory()]}),
    }
    wanted = oo.JointSampled(TIMES, POSITIONS, rates=RATES)
    for kind, path in sources.items():
        found = reference(path, tmp_path)
        for t in (0.0, 0.013, 0.2, 0.4, 1.0):
            for ours, theirs in zip(found.sample(t), wanted.sample(t), strict=True):
                # stamps are in ns, 1.7e9 s after zero: without loss, as integers
                np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-12, err_msg=kind)
    without = reference(folder(tmp_path / "f", {"/js": states(with_rates=False)}), tmp_path)
    splined = oo.JointSampled(TIMES, POSITIONS)
    np.testing.assert_allclose(without.sample(0.013)[1], splined.sample(0.013)[1], rtol=0, atol=1e-12)
    # negative control: the two interpolations differ
    assert np.abs(np.subtract(splined.sample(0.013)[1], wanted.sample(0.013)[1])).max() > 1e-6


def test_joints_are_mapped_and_the_start_is_shifted(tmp_path: Path) -> None:
    other = [
        state(1 + time, ["gripper", "shoulder"], [9, row[0]])
        for time, row in zip(TIMES, POSITIONS, strict=True)
    ]
    mixed = [content for pair in zip(other, states(1.0), strict=True) for content in pair]
    file = folder(tmp_path / "a", {"/joint_states": other})
    found = reference(file, tmp_path, joints={"shoulder": NAMES[2]}, start="50 ms")
    q = np.array(found.sample(0.05 + 0.13)[0])
    assert q[2] == pytest.approx(np.array(oo.JointSampled(TIMES, POSITIONS).sample(0.13)[0])[0], abs=1e-12)
    assert np.count_nonzero(q) == 1  # other joints are held
    # two publishers on one topic
    file = folder(tmp_path / "b", {"/joint_states": mixed})
    found = reference(file, tmp_path, joints=dict(zip(NAMES, NAMES, strict=True)))
    np.testing.assert_allclose(found.sample(0.2)[0], POSITIONS[10], rtol=0, atol=1e-12)


def test_an_exported_run_is_tracked(tmp_path: Path) -> None:
    ramps = {"kind": "joint_ramps", "speed": "20 deg/s", "moves": [{"joint": NAMES[3], "to": 0.02}]}
    law = {"kind": "joint_computed_torque", "kp": 100, "kd": 20}
    data = {
        "robot": "humanoid_torso",
        "controller": law,
        "simulation": {"duration": "0.2 s", "time_step": "1 ms"},
    }
    first = oo.run(data | {"reference": ramps}, quiet=True)
    oo.ros2.export_mcap(first, tmp_path / "run.mcap")
    again = oo.run(data | {"reference": {"kind": "bag", "file": str(tmp_path / "run.mcap")}}, quiet=True)
    (own,) = first.trace.tracking.values()
    error = np.abs(again.trace.q[:, 7:] - first.trace.q[:, 7:]).max()
    # the law is sampled every 1 ms: the second run has the tracking error of the first once more
    assert error < 2 * np.abs(own).max() < 0.02 * np.ptp(first.trace.q[:, 7:], axis=0).max()


def test_messages_at_one_time_count_once(tmp_path: Path) -> None:
    contents = states(3.0)
    twice = [*contents[:10], state(3.0 + TIMES[9], NAMES, POSITIONS[9], RATES[9] + 1), *contents[10:]]
    found = reference(folder(tmp_path / "a", {"/joint_states": twice}), tmp_path)
    np.testing.assert_allclose(found.sample(TIMES[9])[1], RATES[9] + 1, rtol=0, atol=1e-9)  # the last counts


def test_stamps_that_are_not_set_are_those_of_the_recording(tmp_path: Path) -> None:
    contents = [state(0.0, NAMES, row) for row in POSITIONS[:4]]
    found = reference(folder(tmp_path / "a", {"/joint_states": contents}), tmp_path)
    assert found.duration == 3.0
    np.testing.assert_allclose(found.sample(2.0)[0], POSITIONS[2], rtol=0, atol=1e-12)


STRING = message("std_msgs/msg/String", data="x")
ONE = states()[:1]
BACK = [*states()[:5], states()[2]]
SHORT = [*states()[:5], state(1.7e9 + 1, NAMES, [1, 2])]
NAN = state(2e9, NAMES, [np.nan] * 7, [0] * 7)
PART = [*states()[:5], state(1.7e9 + 1, NAMES[:3], [1, 2, 3])]

OTHER = [state(1.7e9 + time, ["lamp"], [0]) for time in TIMES[:3]]
STILL = trajectory()
STILL.points[4].time_from_start = STILL.points[2].time_from_start

TWICE = [state(1.7e9 + time, [NAMES[0], NAMES[0]], [0, 1]) for time in TIMES]

INVALID: dict[str, tuple[dict[str, list[Any]], dict[str, Any], type[OnOrbitError], str]] = {
    "no joints": ({"/chatter": [STRING]}, {}, ReadError, "no topic with JointState .*its topics: /chatter"),
    "several": ({"/a": ONE, "/b": ONE}, {}, ReadError, r"joint motions \(/a, /b\); give one as 'topic'"),
    "other topic": ({"/a": ONE, "/c": [STRING]}, {"topic": "/c"}, ReadError, "topics with joint motions: /a"),
    "misspelt topic": (
        {"/joint_states": states()}, {"topic": "/joint_state"}, ReadError, "did you mean '/joint_states'",
    ),
    "one message": ({"/a": ONE}, {}, ReadError, "have different times; found: 1"),
    "back in time": ({"/a": BACK}, {}, ReadError, r"message 6 is at 0.04 s, after 0.08 s"),
    "back in time, after others": (
        {"/a": OTHER + BACK}, {"joints": {name: name for name in NAMES}}, ReadError, "message 9 is at 0.04 s",
    ),
    "trajectory back in time": ({"/a": [STILL]}, {}, ReadError, r"point 5 is at 0.04 s, after 0.06 s"),
    "doubled": ({"/a": TWICE}, {}, ReadError, f"message 1 names {NAMES[0]} more than once"),
    "too short": ({"/a": SHORT}, {}, ReadError, "in message 6 are 7, 2 and 0; give one position"),
    "only some": ({"/a": PART}, {}, ReadError, "message 6 lacks arm_joint_4, "),
    "unknown in the bag": (
        {"/a": states()}, {"joints": {"arm_joint9": NAMES[0]}}, ReadError, "joint 'arm_joint9'; did you mean",
    ),
    "unknown in the robot": (
        {"/a": states()}, {"joints": {NAMES[0]: "arm_joint1"}}, FrameError, "'arm_joint1'; did you mean",
    ),
    "two trajectories": ({"/a": [trajectory()] * 2}, {}, ReadError, "has 2 trajectories; .* exactly one"),
    "not finite": ({"/a": [*states()[:3], NAN]}, {}, OnOrbitError, "finite"),
}  # fmt: skip


@pytest.mark.parametrize("case", INVALID)
def test_an_invalid_recording_is_refused(case: str, tmp_path: Path) -> None:
    topics, keys, kind, text = INVALID[case]
    with pytest.raises(kind, match=rf"mine\.yaml:6: reference: (?s:.*){text}"):
        reference(folder(tmp_path / "bag", topics), tmp_path, **keys)


def test_files_that_are_not_bags_are_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    whole = folder(tmp_path / "bag", {"/joint_states": states()}).read_bytes()
    cut = whole[: len(whole) // 2]
    bad = {"cut.mcap": cut, "empty.mcap": b"", "text.bag": b"text", "text.db3": b"text" * 99}
    for name, content in bad.items():
        (tmp_path / name).write_bytes(content)
        with pytest.raises(ReadError, match=rf"mine\.yaml:6: reference: .*{name} .*damaged or truncated"):
            reference(tmp_path / name)
    (tmp_path / "table.csv").write_text("time\n0")
    with pytest.raises(ReadError, match=r"end in one of .mcap, .db3, .bag, or it must be a folder"):
        reference(tmp_path / "table.csv")
    with pytest.raises(NotFoundError, match="no such file"):
        reference(tmp_path / "none.mcap")
    with pytest.raises(ReadError, match="is a folder"):
        reference(tmp_path)
    monkeypatch.setattr(extra, "find_spec", lambda name: None)
    with pytest.raises(Ros2Error, match=r"mine\.yaml:6: reference: .*onorbit-rs\[ros2\]"):
        reference(tmp_path / "cut.mcap")
