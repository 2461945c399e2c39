"""Commands of another process: what they do, what is refused and why, and the same run from the log."""

from __future__ import annotations

import time
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from ros2_runs import DOMAIN, Peer, needs_ros2, node_of, spinning
from stepper_runs import assert_same_bits

import onorbit_rs as oo
from onorbit_rs.simulation.command_format import read_commands
from onorbit_rs.simulation.replay import replay_commands

needs_ros2()

from onorbit_rs.ros2 import Node  # noqa: E402
from onorbit_rs.ros2.live_run import LiveRun  # noqa: E402

ROBOT = oo.robots.load("humanoid_torso")
ARM, WRIST = ROBOT.joint_names[:4], ROBOT.joint_names[4:]
PERIOD = 0.01
FLOATS = "std_msgs/msg/Float64MultiArray"
TRAJECTORY = "trajectory_msgs/msg/JointTrajectory"
STATE = "sensor_msgs/msg/JointState"
WRENCH = "geometry_msgs/msg/WrenchStamped"
STEP = "std_msgs/msg/Float64"
EVENTS = ("/events", "diagnostic_msgs/msg/DiagnosticArray")


def simulation(**wrist: Any) -> oo.Simulation:
    """Returns a simulation of a robot whose arm follows positions and whose wrist follows efforts."""
    controls = [
        oo.Control(oo.External(kp=100.0, kd=20.0), joints=ARM, name="arm"),
        oo.Control(oo.External(**wrist), joints=WRIST, name="wrist"),
    ]
    q = ROBOT.neutral()
    return oo.Simulation(ROBOT, q, np.zeros(ROBOT.nv), controller=controls, control_period=PERIOD)


@pytest.fixture(scope="module")
def peer() -> Iterator[Peer]:
    with Peer() as found:
        yield found


def answer(peer: Peer) -> tuple[int, str, str]:
    (message,) = peer.take("/events", 1)
    (status,) = message["status"]
    return status["level"], status["name"], status["message"]


def step(peer: Peer, length: float) -> None:
    peer.say("/step", STEP, {"data": length})
    assert answer(peer)[0] == 0


def obeyed(node: Node, count: int) -> None:
    """Waits until the node has obeyed a number of commands."""
    end = time.monotonic() + 20.0
    while len(node.commands) < count:
        assert time.monotonic() < end, node.commands
        time.sleep(0.002)


def point(seconds: float, **values: Any) -> dict[str, Any]:
    sec, nanosec = divmod(round(seconds * 1e9), 10**9)
    return values | {"time_from_start": {"sec": sec, "nanosec": nanosec}}


def test_every_kind_of_command_moves_the_robot_and_the_log_repeats_the_run(
    peer: Peer, tmp_path: Path
) -> None:
    log = tmp_path / "commands.jsonl"
    with node_of(simulation(), pace="stepped", log=log) as node:
        peer.hear(*EVENTS)
        assert peer.publisher("/events")
        assert {"/arm/commands", "/wrist/commands", "/arm/joint_trajectory", "/joint_commands"} <= dict(
            node.subscribed
        ).keys()
        with spinning(node, 1.0) as found:
            peer.say("/arm/commands", FLOATS, {"data": [0.1, 0.0, 0.0, 0.0]})
            peer.say("/wrist/commands", FLOATS, {"data": [0.02, 0.0, 0.0]})
            obeyed(node, 2)
            step(peer, 0.3)
            backwards = ARM[::-1]
            points = [point(0.1, positions=[0.0, 0.0, 0.0, 0.2]), point(0.2, positions=[0.0, 0.1, 0.0, 0.2])]
            peer.say("/arm/joint_trajectory", TRAJECTORY, {"joint_names": backwards, "points": points})
            obeyed(node, 3)
            step(peer, 0.3)
            back = {"name": ARM, "position": [0.0] * 4, "velocity": [0.0] * 4, "effort": [0.0] * 4}
            peer.say("/joint_commands", STATE, back)
            obeyed(node, 4)
            peer.say("/joint_commands", STATE, {"name": WRIST, "effort": [0.0, 0.0, -0.01]})
            wrench = {"force": {"x": 1.0, "y": 0.0, "z": 0.0}, "torque": {"x": 0.0, "y": 0.0, "z": 0.1}}
            peer.say(
                "/wrench_command", WRENCH, {"header": {"frame_id": ROBOT.body_names[3]}, "wrench": wrench}
            )
            obeyed(node, 6)
            step(peer, 0.4)
    (trace,) = found
    q, tau = trace.q[:, 7:], trace.tau
    assert abs(q[300, 0] - 0.1) < 0.03 and abs(q[0, 0]) < 1e-12, "the positions of the first command"
    np.testing.assert_array_equal(tau[1, 4:], [0.02, 0.0, 0.0])
    assert abs(q[600, 0] - 0.2) < 0.05 and abs(q[600, 2] - 0.1) < 0.06, "joints are matched by their names"
    np.testing.assert_array_equal(tau[601, 4:], [0.0, 0.0, -0.01])
    assert np.abs(trace.impulse[-1]).max() > 0.3 and not trace.impulse[600].any(), "the wrench acts"
    assert [entry["time"] for entry in node.commands] == [0.0, 0.0, 0.3, 0.6, 0.6, 0.6]
    assert read_commands(log) == node.commands
    stepper = simulation().start()
    replay_commands(stepper, read_commands(log), 1.0)
    assert_same_bits(stepper.finish(), trace)
    without = simulation().start()
    replay_commands(without, read_commands(log)[:2], 1.0)
    assert (without.finish().q[-1] != trace.q[-1]).any()


def test_a_command_takes_effect_at_the_next_update(peer: Peer) -> None:
    """An external effort is in the state at most two control periods after it was sent."""
    with node_of(simulation(), pace="stepped") as node:
        peer.hear(*EVENTS)
        assert peer.publisher("/events")
        with spinning(node, 0.06) as found:
            step(peer, 0.013)
            peer.say("/wrist/commands", FLOATS, {"data": [0.02, 0.0, 0.0]})
            obeyed(node, 1)
            step(peer, 0.1)
    tau = found[0].tau[:, 4]
    assert node.commands[0]["time"] == pytest.approx(0.013)
    assert not tau[:20].any() and (tau[20:] == 0.02).all()


NAN, INF = float("nan"), float("inf")
HERE = [0.0] * 4
PAST = {"header": {"stamp": {"sec": 0, "nanosec": 1}}}
PATH = "/arm/joint_trajectory"
REFUSED = [
    ("/arm/commands", FLOATS, {"data": [0.1]}, "'data' has length 1; the required length is 4, one number"),
    ("/arm/commands", FLOATS, {"data": [0.0, NAN, 0.0, 0.0]}, f"joint {ARM[1]} in 'data' is nan; it must be"),
    ("/arm/commands", FLOATS, {"data": [0.0, 0.0, 0.0, INF]}, f"joint {ARM[3]} in 'data' is inf; it must be"),
    (PATH, TRAJECTORY, {"joint_names": [*ARM[:3], "elbow"], "points": [point(1.0)]}, "elbow; it must"),
    (PATH, TRAJECTORY, {"joint_names": ARM}, "the trajectory has no points"),
    (PATH, TRAJECTORY, {"joint_names": ARM, "points": [point(1.0)]}, "'positions' has length 0; the"),
    (PATH, TRAJECTORY,
     {"joint_names": ARM, "points": [point(0.2, positions=HERE), point(0.1, positions=HERE)]}, "times"),
    (PATH, TRAJECTORY, PAST | {"joint_names": ARM, "points": [point(0.1, positions=HERE)]}, "ends"),
    ("/joint_commands", STATE, {"name": ["knee"], "position": [0.0]}, "no external control drives knee"),
    ("/joint_commands", STATE, {"name": ARM}, "'velocity' and 'effort' of the message are all empty"),
    ("/joint_commands", STATE, {}, "the field 'name' of the message is empty"),
    ("/joint_commands", STATE, {"name": ARM[:2], "effort": [0.0, 0.0]}, "joint of the control once: "),
    ("/joint_commands", STATE, {"name": [ARM[0], *ARM[:3]], "effort": HERE}, "joint of the control once: "),
    ("/wrench_command", WRENCH, {"header": {"frame_id": "moon"}}, "frame_id 'moon' is not a frame"),
    ("/wrench_command", WRENCH, {"wrench": {"force": {"x": NAN}}}, "force is [nan, 0.0, 0.0] N, torque is"),
]  # fmt: skip


def test_what_cannot_be_obeyed_is_refused_with_its_reason(peer: Peer) -> None:
    with node_of(simulation(), pace="stepped") as node:
        peer.hear(*EVENTS)
        assert peer.publisher("/events")
        with spinning(node, 0.5) as found:
            step(peer, 0.4)
            for topic, kind, values, reason in REFUSED:
                assert peer.say(topic, kind, values)
                level, name, text = answer(peer)
                assert (level, name) == (2, topic) and text.startswith("refused: "), text
                assert reason in text, text
            step(peer, 0.1)
    assert node.commands == []
    assert_same_bits(found[0], simulation().run(0.5))


def test_a_trajectory_stamped_by_the_wall_clock_is_pointed_out(peer: Peer) -> None:
    with node_of(simulation(), pace="stepped") as node:
        peer.hear(*EVENTS)
        assert peer.publisher("/events")
        with spinning(node, 0.01):
            late = {"header": {"stamp": {"sec": 1_790_000_000, "nanosec": 0}}, "joint_names": ARM}
            peer.say(
                "/arm/joint_trajectory", TRAJECTORY, late | {"points": [point(1.0, positions=[0.0] * 4)]}
            )
            assert answer(peer) == (
                1, "/arm/joint_trajectory",
                "the trajectory starts in 1.79e+09 s; set use_sim_time in the node that sends it",
            )  # fmt: skip
            step(peer, 0.01)
        assert len(node.commands) == 1


def test_of_two_senders_the_last_message_holds(peer: Peer) -> None:
    with Peer() as other, node_of(simulation(), pace="stepped") as node:
        peer.hear(*EVENTS)
        assert peer.publisher("/events")
        with spinning(node, 0.02) as found:
            for count, sender, effort in ((1, peer, 0.01), (2, other, 0.02), (3, other, 0.03)):
                sender.say("/wrist/commands", FLOATS, {"data": [effort, 0.0, 0.0]})
                obeyed(node, count)
                if count == 2:
                    name = next(iter(simulation().models))
                    text = f"several processes send to wrist of {name}; the last message takes effect"
                    assert answer(peer) == (1, "/wrist/commands", text)
            step(peer, 0.02)
    assert (found[0].tau[:, 4] == 0.03).all()
    assert [entry["values"][0] for entry in node.commands] == [0.01, 0.02, 0.03]


def test_a_sender_that_left_is_not_a_second_sender(peer: Peer) -> None:
    """The other topics of a control count too; a sender that ends in order may come back."""
    with node_of(simulation(), pace="stepped") as node:
        peer.hear(*EVENTS)
        assert peer.publisher("/events")
        with spinning(node, 0.02):
            for count in (1, 2):
                with Peer() as other:
                    other.say("/wrist/commands", FLOATS, {"data": [0.01 * count, 0.0, 0.0]})
                    obeyed(node, count)
            time.sleep(0.2)
            with Peer() as other:
                other.say("/wrist/commands", FLOATS, {"data": [0.01, 0.0, 0.0]})
                obeyed(node, 3)
                peer.say("/joint_commands", STATE, {"name": WRIST, "effort": [0.0] * 3})
                level, topic, text = answer(peer)
                assert (level, topic) == (1, "/joint_commands") and "send to wrist" in text, "only here"
            step(peer, 0.02)


def test_a_message_to_two_controls_is_obeyed_or_refused_as_a_whole(peer: Peer) -> None:
    with node_of(simulation(), pace="stepped") as node:
        peer.hear(*EVENTS)
        assert peer.publisher("/events")
        with spinning(node, 0.02) as found:
            both = {"name": [*ARM, *WRIST], "position": [0.1] * 7}
            peer.say("/joint_commands", STATE, both)
            assert answer(peer)[2].startswith("refused: "), "the wrist has no gains for a position"
            step(peer, 0.02)
    assert node.commands == []
    assert not found[0].tau[:, :4].any()


def test_the_timeout_acts_when_a_sender_vanishes() -> None:
    late = simulation(timeout=0.1, on_timeout="zero")
    with Peer() as peer, node_of(late, is_paused=True) as node, spinning(node, 0.4) as found:
        peer.say("/wrist/commands", FLOATS, {"data": [0.02, 0.0, 0.0]})
        obeyed(node, 1)
        peer.say("/pause", "std_msgs/msg/Bool", {"data": False})
        while node._session.is_paused:
            time.sleep(0.002)
        peer.process.kill()
    (trace,), (sent,) = found, (entry["time"] for entry in node.commands)
    acts = trace.time[trace.tau[:, 4] == 0.02]
    assert sent <= acts[0] < sent + 2 * PERIOD
    assert abs(acts[-1] - (sent + 0.1)) < 2.1 * PERIOD and trace.time[-1] == 0.4


def wrenches(trace: oo.Trace) -> np.ndarray:
    """Returns the linear impulse of each time step, N s."""
    return np.asarray(np.diff(trace.impulse[:, :3], axis=0))


@pytest.mark.parametrize("timeout", [None, 0.1505])
def test_a_wrench_ends_after_its_timeout(peer: Peer, tmp_path: Path, timeout: float | None) -> None:
    log, push = tmp_path / "commands.jsonl", {"wrench": {"force": {"x": 1.0, "y": 0.0, "z": 0.0}}}
    with node_of(simulation(), pace="stepped", log=log, wrench_timeout=timeout) as node:
        peer.hear(*EVENTS)
        assert peer.publisher("/events")
        with spinning(node, 0.5) as found:
            peer.say("/wrench_command", WRENCH, push)
            obeyed(node, 1)
            step(peer, 0.1)
            peer.say("/wrench_command", WRENCH, push)  # confirms it
            obeyed(node, 2)
            peer.say("/step", STEP, {"data": 0.4})
            said = [one["status"][0] for one in peer.take("/events", 1 if timeout is None else 2)]
    (trace,) = found
    texts = [(one["level"], one["name"], one["message"]) for one in said]
    if timeout is None:
        assert texts == [(0, "/step", "advanced to t = 0.5 s")]
        assert wrenches(trace).any(axis=1).all()
        return
    root = ROBOT.body_names[0]
    ended = (1, "/wrench_command", f"no message came within the timeout; the wrench on {root} ended")
    assert texts == [ended, (0, "/step", "advanced to t = 0.5 s")]
    assert [entry["time"] for entry in node.commands] == pytest.approx([0.0, 0.1, 0.2505])
    acts = wrenches(trace).any(axis=1)
    middles = 0.5 * (trace.time[1:] + trace.time[:-1])
    np.testing.assert_array_equal(acts, middles < 0.2505)
    assert np.abs(trace.impulse[-1, :3]).max() == pytest.approx(0.2505, rel=1e-3)
    stepper = simulation().start()
    replay_commands(stepper, read_commands(log), 0.5)
    assert_same_bits(stepper.finish(), trace)


def test_a_wrench_ends_at_a_time_that_rounding_puts_after_a_tick() -> None:
    """0.1 + 0.2 is larger than 0.3, where a tick ends."""
    run = LiveRun(simulation(), wrench_timeout=0.2)
    (system,) = run.models
    force = {"system": system, "body": ROBOT.body_names[0], "force": [1.0, 0, 0], "frame": "body"}
    run.advance_to(0.1)
    run.command([force])
    ended = [run.advance_to(t) for t in (0.3, 0.301)]
    assert sum(map(len, ended)) == 1


def test_a_zero_wrench_needs_no_timeout(peer: Peer) -> None:
    with node_of(simulation(), pace="stepped", wrench_timeout=0.1) as node:
        peer.hear(*EVENTS)
        assert peer.publisher("/events")
        with spinning(node, 0.3):
            for count, force in ((1, 1.0), (2, 0.0)):
                peer.say("/wrench_command", WRENCH, {"wrench": {"force": {"x": force}}})
                obeyed(node, count)
            step(peer, 0.3)
    assert len(node.commands) == 2


@pytest.mark.parametrize("timeout", [0.0, -1.0, NAN, INF])
def test_a_timeout_of_wrenches_that_is_not_positive_is_refused(timeout: float) -> None:
    with pytest.raises(oo.exceptions.InputError, match=r"timeout of wrenches is .* positive and finite"):
        Node(simulation(), domain=DOMAIN, wrench_timeout=timeout)


LINK = (
    '<link name="{}"><inertial><mass value="1"/>'
    '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>'
)
HINGE = '<joint name="hinge" type="continuous"><parent link="{}"/><child link="{}"/></joint>'


@pytest.mark.parametrize(("parent", "child"), [("base", "tip"), ("root", "base")])
def test_a_wrench_in_the_frame_base_is_on_the_root_link(peer: Peer, parent: str, child: str) -> None:
    """This holds even if another link is named `base`; the frame of that link is then `base_2`."""
    text = "".join(map(LINK.format, (parent, child))) + HINGE.format(parent, child)
    robot = oo.Model.from_urdf_string(f'<robot name="r">{text}</robot>')
    run = oo.Simulation(robot, robot.neutral(), np.zeros(robot.nv))
    other = "tip" if child == "tip" else "base_2"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with node_of(run, pace="stepped") as node, spinning(node, 0.01):
            peer.hear(*EVENTS)
            assert peer.publisher("/events")
            for count, frame in enumerate(("", "base", other), 1):
                peer.say("/wrench_command", WRENCH, {"header": {"frame_id": frame}})
                obeyed(node, count)
            step(peer, 0.01)
    assert [entry["body"] for entry in node.commands] == [parent, parent, child]
