"""A live node and another process: topics heard, also by late joiners; the run controlled by messages."""

from __future__ import annotations

import contextlib
import socket
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from bag_files import read_mcap
from ros2_runs import DOMAIN, Peer, needs_ros2, node_of, spinning, wait_for_subscriber
from stepper_runs import assert_same_bits, passive, scenario
from world_runs import built, data

import onorbit_rs as oo

needs_ros2()

from onorbit_rs.ros2 import Node, loopback  # noqa: E402
from onorbit_rs.ros2.series import Series  # noqa: E402

EVENTS = ("/events", "diagnostic_msgs/msg/DiagnosticArray")
STATES = ("/joint_states", "sensor_msgs/msg/JointState")


@pytest.fixture(scope="module")
def peer() -> Iterator[Peer]:
    with Peer() as found:
        yield found


def test_a_run_without_a_row_can_be_advanced_and_ended() -> None:
    short = passive(time_step=0.01)
    with node_of(short, pace="fast") as node:
        assert len(node.spin(0.0005)) == 2
    adaptive = passive(time_step=0.01, integrator="dormand_prince")
    with node_of(adaptive, pace="fast") as node:
        trace = node.spin(0.05)
    assert_same_bits(trace, adaptive.run(0.05))


def test_a_log_replaces_a_file_only_when_the_node_has_joined(tmp_path: Path) -> None:
    log = tmp_path / "commands.jsonl"
    log.write_text("precious")
    with pytest.raises(oo.exceptions.InputError, match="network is 'wifi'"):
        Node(passive(), domain=DOMAIN, network="wifi", log=log)
    assert log.read_text() == "precious"


def heard(peer: Peer, *topics: tuple[str, str]) -> None:
    """Waits until the peer has found the publishers of topics."""
    for topic, kind in topics:
        peer.hear(topic, kind)
    for topic, _ in topics:
        assert peer.publisher(topic), topic


def answers(peer: Peer, count: int) -> list[tuple[int, str, str]]:
    found = [status for one in peer.take("/events", count) for status in one["status"]]
    return [(status["level"], status["name"], status["message"]) for status in found]


def stamp(message: Any) -> float:
    time = message["header"]["stamp"]
    return float(time["sec"] + 1e-9 * time["nanosec"])


def test_another_process_hears_every_row_and_the_run_keeps_its_bits(peer: Peer) -> None:
    duration = 0.3
    alone = scenario().run(duration)
    with node_of(scenario(), pace="fast") as node:
        heard(peer, STATES, ("/odom", "nav_msgs/msg/Odometry"), ("/clock", "rosgraph_msgs/msg/Clock"))
        wait_for_subscriber(node, "/joint_states", "/odom", "/clock")
        trace = node.spin(duration)
    assert_same_bits(trace, alone)
    states = peer.take("/joint_states", 301)
    assert len(states) == 301 and not node.commands
    np.testing.assert_allclose([stamp(one) for one in states], alone.time, atol=1e-9)
    np.testing.assert_array_equal([one["position"] for one in states], alone.q[:, 7:])
    np.testing.assert_array_equal([one["effort"] for one in states], alone.tau)
    clock = peer.take("/clock", 301)
    assert [one["clock"] for one in clock] == [one["header"]["stamp"] for one in states]
    last = peer.take("/odom", 301)[-1]
    assert list(last["pose"]["pose"]["position"].values()) == alone.q[-1, :3].tolist()
    assert list(last["twist"]["twist"]["angular"].values()) == alone.v[-1, 3:6].tolist()
    assert (last["header"]["frame_id"], last["child_frame_id"]) == ("world", "base")


def test_the_bits_are_those_of_the_run_also_without_listeners_and_in_real_time() -> None:
    alone = scenario().run(0.1)
    for pace in ("fast", "real_time"):
        with node_of(scenario(), pace=pace) as node:
            assert_same_bits(node.spin(0.1), alone)
    assert node.jitter["ticks"] == 100


class Counting(oo.Controller):
    """Controller whose torques grow with the number of its updates."""

    def __init__(self) -> None:
        self.updates = 0

    def update(self, t: float, state: Any) -> Any:
        self.updates += 1
        return np.full(7, 1e-4 * self.updates)


def test_a_controller_in_python_is_updated_as_often_as_in_a_run() -> None:
    alone = passive(controller=Counting(), control_period=0.01).run(0.1)
    with node_of(passive(controller=Counting(), control_period=0.01), pace="fast") as node:
        assert_same_bits(node.spin(0.1), alone)


def test_a_reset_sets_a_controller_in_python_back(peer: Peer) -> None:
    alone = passive(controller=Counting(), control_period=0.01).run(0.1)
    with node_of(passive(controller=Counting(), control_period=0.01), pace="stepped") as node:
        heard(peer, EVENTS)
        with spinning(node, 0.1) as found:
            for topic, kind, values in (
                ("/step", "std_msgs/msg/Float64", {"data": 0.05}),
                ("/reset", "std_msgs/msg/Empty", {}),
                ("/step", "std_msgs/msg/Float64", {"data": 0.1}),
            ):
                peer.say(topic, kind, values)
                assert answers(peer, 1)[0][0] == 0
    assert_same_bits(found[0], alone)


def test_topics_without_subscribers_are_not_computed(monkeypatch: pytest.MonkeyPatch) -> None:
    computed: list[str] = []
    messages = Series.messages
    monkeypatch.setattr(
        Series, "messages", lambda self, rows: computed.append(self.name) or messages(self, rows)
    )
    with contextlib.closing(Node(scenario(), pace="fast", domain=231)) as node:  # where nobody listens
        assert node.spin(0.05).time[-1] == 0.05
    assert computed == []


def test_real_time_takes_the_time_of_the_clock() -> None:
    with node_of(scenario()) as node:
        begin = time.perf_counter()
        node.spin(0.3)
        took = time.perf_counter() - begin
        lost = node.jitter["slipped_s"] + node.jitter["late_max_s"]  # on a machine that others use
        assert 0.299 <= took < 0.5 + lost
        assert set(node.jitter) == {
            "late_median_s", "late_99_s", "late_max_s", "missed", "slipped_s", "ticks",
        }  # fmt: skip
    with node_of(scenario(), pace="fast") as node:
        node.spin(0.1)
        assert node.jitter == {}


def test_who_joins_late_gets_the_robot_and_its_fixed_frames(peer: Peer) -> None:
    with node_of(scenario(), pace="fast") as node:
        node.spin(0.01)
        for topic, kind in (
            ("/robot_description", "std_msgs/msg/String"),
            ("/tf_static", "tf2_msgs/msg/TFMessage"),
        ):
            peer.hear(topic, kind, is_latched=True)
        (text,) = peer.take("/robot_description", 1)
        (frames,) = peer.take("/tf_static", 1)
    model = oo.robots.load("humanoid_torso")
    read = oo.Model.from_urdf_string(text["data"])
    assert read.body_names == model.body_names and read.joint_names == model.joint_names
    assert {one["child_frame_id"] for one in frames["transforms"]} >= {
        frame.name for frame in model.frames
    } - set(model.body_names)


def test_a_run_is_stepped_paused_and_reset_by_messages(peer: Peer) -> None:
    with node_of(scenario(), pace="stepped") as node:
        heard(peer, STATES, EVENTS)
        wait_for_subscriber(node, "/joint_states")
        with spinning(node, 0.1) as found:
            assert [stamp(state) for state in peer.take("/joint_states", 1)] == [0.0], "before the first step"
            assert peer.say("/step", "std_msgs/msg/Float64", {"data": 0.025})
            assert answers(peer, 1) == [(0, "/step", "advanced to t = 0.025 s")]
            states = peer.take("/joint_states", 25)
            assert len(states) == 25 and stamp(states[-1]) == 0.025, "the row at the new time is published"
            for step in (-1.0, float("nan"), 0.0, 1e-12):
                peer.say("/step", "std_msgs/msg/Float64", {"data": step})
            refused = answers(peer, 4)
            assert [level for level, _, _ in refused] == [2, 2, 2, 2]
            assert (
                refused[3][2]
                == "refused: the step is 1e-12 s; the clock resolves 1e-09 s, so give a longer step"
            )
            for is_paused in (False, True):
                peer.say("/pause", "std_msgs/msg/Bool", {"data": is_paused})
                assert answers(peer, 1) == [
                    (1, "/pause", "/pause has no effect with pace stepped; the run advances only on /step")
                ]
            assert refused[0][2] == "refused: the step is -1.0 s; it must be positive and finite"
            peer.say("/step", "std_msgs/msg/Float64", {"data": 0.025})
            assert answers(peer, 1) == [(0, "/step", "advanced to t = 0.05 s")]
            states = peer.take("/joint_states", 25)
            np.testing.assert_allclose([stamp(one) for one in states], np.arange(26, 51) * 1e-3, atol=1e-9)
            peer.say("/reset", "std_msgs/msg/Empty", {})
            assert answers(peer, 1) == [(0, "/reset", "reset to t = 0 s")]
            assert stamp(peer.take("/joint_states", 1)[0]) == 0.0
            peer.say("/step", "std_msgs/msg/Float64", {"data": 5.0})
            assert answers(peer, 1) == [(0, "/step", "advanced to t = 0.1 s")], "not beyond the end"
    assert_same_bits(found[0], scenario().run(0.1))


def test_a_paused_run_waits_and_goes_on(peer: Peer) -> None:
    with node_of(scenario(), is_paused=True) as node:
        heard(peer, STATES, EVENTS)
        with spinning(node, 0.05) as found:
            peer.say("/step", "std_msgs/msg/Float64", {"data": 0.01})
            assert answers(peer, 1) == [(0, "/step", "advanced to t = 0.01 s")]
            peer.say("/pause", "std_msgs/msg/Bool", {"data": False})
            assert answers(peer, 1) == [(0, "/pause", "running")]
    assert_same_bits(found[0], scenario().run(0.05))
    with node_of(scenario()) as node:
        heard(peer, EVENTS)
        with spinning(node, 2.0):
            peer.say("/step", "std_msgs/msg/Float64", {"data": 0.01})
            assert (
                answers(peer, 1)[0][2] == "refused: the run is not paused; use pace stepped, or /pause first"
            )
            peer.say("/pause", "std_msgs/msg/Bool", {"data": True})
            assert answers(peer, 1) == [(0, "/pause", "paused")]
            before = node._session.run.time
            time.sleep(0.05)
            assert node._session.run.time == before < 2.0
            peer.say("/step", "std_msgs/msg/Float64", {"data": 2.0})


def test_a_subscriber_that_joins_a_waiting_node_hears_the_present_state(peer: Peer) -> None:
    with node_of(scenario(), pace="stepped") as node, spinning(node, 0.1) as found:
        peer.hear(*EVENTS)
        assert peer.publisher("/events")
        peer.say("/step", "std_msgs/msg/Float64", {"data": 0.025})
        assert answers(peer, 1) == [(0, "/step", "advanced to t = 0.025 s")]
        for topic in (STATES, ("/tf", "tf2_msgs/msg/TFMessage"), ("/clock", "rosgraph_msgs/msg/Clock")):
            peer.hear(*topic)
            (first, *more) = peer.take(topic[0], 1)
            assert len(more) <= 1, "once or twice"
            if topic is STATES:
                assert stamp(first) == 0.025
        time.sleep(0.5)
        peer.take("/joint_states", 0, seconds=0.0)
        time.sleep(0.5)
        assert peer.take("/joint_states", 0, seconds=0.0) == [], "not again and again"
        peer.say("/step", "std_msgs/msg/Float64", {"data": 0.075})
        np.testing.assert_allclose(
            [stamp(one) for one in peer.take("/joint_states", 75)], np.arange(26, 101) * 1e-3, atol=1e-9
        )
    assert_same_bits(found[0], scenario().run(0.1))


class Unsaved(Counting):
    """A controller with an attribute that a checkpoint cannot contain."""

    def __init__(self) -> None:
        super().__init__()
        self.anything = object()


def test_an_adaptive_run_that_cannot_be_planned_is_pointed_out() -> None:
    settings: dict[str, Any] = {"control_period": 0.01, "integrator": "dormand_prince", "time_step": 0.01}
    for controller, count in ((Unsaved(), 1), (Counting(), 0)):
        said: list[str] = []
        run = passive(controller=controller, **settings)
        with node_of(run, pace="fast", on_message=said.append) as node:
            trace = node.spin(0.1)
        assert trace.time[-1] == 0.1 and len(said) == count
        assert all("adaptive steps differ" in text and "give it get_state()" in text for text in said)
    assert_same_bits(trace, passive(controller=Counting(), **settings).run(0.1))


def test_a_run_that_keeps_few_rows_publishes_and_records_all(tmp_path: Path) -> None:
    alone = scenario().run(0.5)
    with node_of(scenario(), pace="fast", keep_rows=50, record=tmp_path / "run.mcap") as node:
        trace = node.spin(0.5)
    rows = len(trace)
    assert 51 <= rows <= 1 + 2 * 50 + 20 < len(alone)
    kept = np.r_[0, len(alone) - rows + 1 : len(alone)]
    np.testing.assert_array_equal(trace.q, alone.q[kept])
    assert all(passed for *_, passed in trace.certificate())
    times = [stamp for stamp, _ in read_mcap(tmp_path / "run.mcap")["/joint_states"]]
    assert times == [round(1e9 * t) for t in alone.time]
    whole = built(data()).simulation.run(0.5)
    with node_of(built(data()).simulation, pace="fast", keep_rows=5) as node:
        two = node.spin(0.5)
    for name in ("chaser", "target"):
        assert len(two[name]) < 40 < len(whole[name])
        np.testing.assert_array_equal(two[name].q[-5:], whole[name].q[-5:])
        np.testing.assert_array_equal(two[name].q[0], whole[name].q[0])
    assert [event.name for event in two.events] == ["grasp", "let_go"]
    assert all(passed for *_, passed in two.certificate())
    for keep in (0, -1, 2.5):
        with pytest.raises(oo.exceptions.InputError, match=r"rows to keep is .* integer of at least 1"):
            Node(scenario(), domain=DOMAIN, keep_rows=keep)  # type: ignore[arg-type]


def test_events_of_two_craft_are_triggered_and_published(peer: Peer) -> None:
    source = data()
    source["events"][0]["when"] = {"on_command": True}
    with node_of(built(source).simulation, pace="stepped") as node:
        names = dict(node.published)
        assert {"/chaser/joint_states", "/chaser/odom", "/target/odom"} <= names.keys()
        assert "/chaser/wrench_command" in dict(node.subscribed)
        heard(peer, EVENTS, ("/chaser/joint_states", STATES[1]))
        wait_for_subscriber(node, "/chaser/joint_states")
        with spinning(node, 0.5) as found:
            peer.say("/trigger", "std_msgs/msg/String", {"data": "grab"})
            ((level, topic, text),) = answers(peer, 1)
            assert (level, topic) == (2, "/trigger") and text.startswith("refused: ") and "grasp" in text
            peer.say("/step", "std_msgs/msg/Float64", {"data": 0.1})
            answers(peer, 1)
            peer.say("/trigger", "std_msgs/msg/String", {"data": "grasp"})
            assert answers(peer, 1) == [(0, "/trigger", "grasp is due at t = 0.1 s")]
            peer.say("/step", "std_msgs/msg/Float64", {"data": 0.4})
            rest = answers(peer, 3)
    (trace,) = found
    assert [(event.name, event.kind) for event in trace.events] == [
        ("grasp", "capture"),
        ("let_go", "release"),
    ]
    assert node.commands == [{"trigger": "grasp", "time": 0.1}]
    assert {(name, text) for _, name, text in rest} == {
        ("grasp", "capture: chaser and target"), ("let_go", "release: chaser and target"),
        ("/step", "advanced to t = 0.5 s"),
    }  # fmt: skip
    times = [stamp(one) for one in peer.take("/chaser/joint_states", 40)]
    assert sorted(set(times)) == times, "one message per time, also at a capture"


def test_bytes_that_are_not_dds_do_not_disturb_a_node(peer: Peer) -> None:
    with node_of(scenario(), pace="stepped") as node:
        heard(peer, EVENTS)
        with (
            spinning(node, 0.01),
            contextlib.closing(socket.socket(socket.AF_INET, socket.SOCK_DGRAM)) as sender,
        ):
            rng = np.random.default_rng(5)
            for port in list(loopback._ports(DOMAIN))[:4]:
                for size in (0, 1, 20, 400, 60000):
                    for head in (b"", b"RTPS\x02\x01\x01\x10"):
                        sender.sendto(head + rng.bytes(size), ("127.0.0.1", port))
            peer.say("/step", "std_msgs/msg/Float64", {"data": 0.01})
            assert answers(peer, 1) == [(0, "/step", "advanced to t = 0.01 s")]


def test_a_node_runs_once() -> None:
    with node_of(scenario(), pace="fast") as node:
        with pytest.raises(
            oo.exceptions.InputError, match="the duration is nan; it must be a positive number of seconds"
        ):
            node.spin(float("nan"))
        node.spin(0.01)
        with pytest.raises(
            oo.exceptions.Ros2Error, match="has already run or was closed; create another Node"
        ):
            node.spin(0.01)


def test_a_second_simulator_in_the_domain_is_pointed_out() -> None:
    said: list[str] = []
    with node_of(scenario(), pace="stepped") as other, node_of(scenario(), on_message=said.append) as node:
        node.spin(1.5)
        assert other.published
    (text,) = said
    assert text.startswith("/clock: another node publishes the time in domain") and "--domain" in text
