"""The inbox of a node: more messages than it processes at once, and malformed ones."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import numpy as np
from bag_files import read_mcap
from ros2_runs import Peer, node_of, spinning

import onorbit_rs as oo
from onorbit_rs.ros2.command_topics import add_run_topics, add_system_topics
from onorbit_rs.ros2.endpoints import MOST_COUNTED
from onorbit_rs.ros2.inbox import Inbox
from onorbit_rs.ros2.messages import encode, message
from onorbit_rs.ros2.transforms import frames_of

ROBOT = oo.robots.load("humanoid_torso")
ARM, WRIST = ROBOT.joint_names[:4], ROBOT.joint_names[4:]
FLOATS = "std_msgs/msg/Float64MultiArray"
TOO_MANY = (
    "refused: 1500 messages arrived since the topic was last read, but the node processes at most 1000 at "
    "once, so it ignored the oldest 500; send fewer"
)


def simulation() -> oo.Simulation:
    """Returns a simulation of a robot whose arm and wrist follow efforts."""
    controls = [oo.Control(oo.External(), joints=joints, name=name) for name, joints in CONTROLS.items()]
    return oo.Simulation(ROBOT, ROBOT.neutral(), np.zeros(ROBOT.nv), controller=controls)


CONTROLS = {"arm": ARM, "wrist": WRIST}


def test_messages_that_are_too_many_are_refused_with_their_number(tmp_path: Path) -> None:
    wrist, file = "/wrist/commands", tmp_path / "run.mcap"
    with Peer() as peer, node_of(simulation(), pace="stepped", record=file) as node:
        peer.hear("/events", "diagnostic_msgs/msg/DiagnosticArray")
        assert peer.publisher("/events")
        for effort, count in ((0.01, 500), (0.02, 1000)):
            assert peer.say(wrist, FLOATS, {"data": [effort, 0.0, 0.0]}, times=count)
        assert peer.say("/arm/commands", FLOATS, {"data": [0.0] * 4}, times=1000), "negative control"
        with spinning(node, 0.01):
            for count in (2000, 3000):
                end = time.monotonic() + 20.0
                while len(node.commands) < count:
                    assert time.monotonic() < end
                    time.sleep(0.01)
                assert peer.say(wrist, FLOATS, {"data": [0.03, 0.0, 0.0]}, times=1000 if count == 2000 else 1)
            peer.say("/step", "std_msgs/msg/Float64", {"data": 0.01})
            answers = [one["status"][0] for one in peer.take("/events", 2)]
    assert [(one["level"], one["name"], one["message"]) for one in answers] == [
        (2, wrist, TOO_MANY), (0, "/step", "advanced to t = 0.01 s"),
    ]  # fmt: skip
    efforts = [entry["values"][0] for entry in node.commands if entry["control"] == "wrist"]
    assert efforts[:2000] == [0.02] * 1000 + [0.03] * 1000, "the newest are obeyed"
    bag = read_mcap(file)
    assert bag["/events"][0][1][4:6] == [wrist, TOO_MANY]
    assert len(bag[wrist]) == len(efforts)


def test_the_number_of_refused_messages_is_a_least_number_if_they_were_not_all_kept() -> None:
    payload = encode(message("std_msgs/msg/Bool", data=True))
    inbox: Any = Inbox(FakeParticipant([payload] * MOST_COUNTED))  # type: ignore[arg-type]
    inbox.subscribe("/pause", "std_msgs/msg/Bool", lambda content: [{"pause": content.data}])
    first, *rest = inbox.take()
    assert first.refusal.startswith("at least 100000 messages arrived since")
    assert "so it ignored at least the oldest 99000;" in first.refusal
    assert not first.entries and len(rest) == 1000 and all(one.entries for one in rest)


def test_a_step_beyond_the_times_of_ros_is_refused() -> None:
    said: list[str] = []
    with node_of(simulation(), pace="stepped", on_message=said.append) as node:
        orders = node._loop.orders
        for length in (1e308, 2.0**31):
            assert not orders._step("/step", length)
        assert orders._step("/step", 0.01)
    assert said[1:] == [
        "/step: refused: the step is 2147483648.0 s; times of ROS end at 2147483647 s, so give a shorter "
        "step",
        "/step: advanced to t = 0.01 s",
    ]


def test_control_characters_of_others_do_not_reach_the_terminal() -> None:
    said: list[str] = []
    with Peer() as peer, node_of(simulation(), pace="stepped", on_message=said.append) as node:
        peer.hear("/events", "diagnostic_msgs/msg/DiagnosticArray")
        assert peer.publisher("/events")
        with spinning(node, 0.01):
            peer.say("/trigger", "std_msgs/msg/String", {"data": "\x1b[31m"})
            peer.say("/step", "std_msgs/msg/Float64", {"data": 0.01})
            texts = [one["status"][0]["message"] for one in peer.take("/events", 2)]
    assert r"no event '\x1b[31m'" in texts[0] and r"no event '\x1b[31m'" in said[0]


class FakeReader:
    def __init__(self, topic: str, kind: str, payloads: list[bytes], sent: int) -> None:
        self.topic, self.kind, self.payloads, self.sent = topic, kind, payloads, sent

    def take(self) -> list[tuple[int, int, bytes]]:
        return [(self.sent, 1, payload) for payload in self.payloads]

    def sender(self, publication: int) -> object:
        return publication


class FakeParticipant:
    """A participant whose readers have received bytes."""

    def __init__(self, payloads: list[bytes]) -> None:
        self.payloads, self.topics = payloads, 0

    def reader(self, topic: str, kind: str) -> FakeReader:
        self.topics += 1
        return FakeReader(
            topic, kind, self.payloads, -self.topics
        )  # each topic is sent before the one before


def test_malformed_bytes_are_refused_on_every_topic() -> None:
    rng = np.random.default_rng(7)
    sizes = (0, 1, 3, 4, 5, 8, 12, 40, 200)
    payloads = [b"\0\1\0\0" + rng.bytes(size) for size in sizes] + [rng.bytes(size) for size in sizes]
    inbox: Any = Inbox(FakeParticipant(payloads))  # type: ignore[arg-type]
    add_run_topics(inbox)
    add_system_topics(inbox, "robot", "", frames_of("", ROBOT), {"arm": list(ARM)})
    found = inbox.take()
    assert len(found) == len(payloads) * len(list(inbox.topics()))
    refused = [one for one in found if one.refusal is not None]
    assert any(one.refusal.startswith("the message is malformed (") for one in refused)
    assert all(not one.entries for one in refused)
    topics = [one.topic for one in found]
    assert topics == sorted(topics, key=[name for name, _ in inbox.topics()][::-1].index), (
        "in order of sending"
    )
    run = {"/pause", "/reset", "/step", "/trigger"}
    assert {one.topic for one in found if one.refusal is None} <= run, "random bytes never name joints"
