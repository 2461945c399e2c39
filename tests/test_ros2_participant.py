"""Joining a domain: who can reach it, what ROS learns about it, and what cannot be joined."""

from __future__ import annotations

import contextlib
import os
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import pytest
from ros2_runs import DOMAIN, Peer, needs_ros2, wait_for_subscriber
from stepper_runs import scenario

import onorbit_rs as oo

needs_ros2()

from onorbit_rs.ros2 import Node, loopback  # noqa: E402
from onorbit_rs.ros2.domains import chosen_domain  # noqa: E402
from onorbit_rs.ros2.participant import Participant  # noqa: E402

STATES = ("/joint_states", "sensor_msgs/msg/JointState")
JOINED = "from onorbit_rs.ros2.participant import Participant as P; P({})"
linux = pytest.mark.skipif(
    sys.platform != "linux", reason="the test reads the sockets of a process from /proc"
)


def open_ports() -> list[str]:
    """Returns the local addresses of the UDP sockets of this process."""
    inodes = {Path(f"/proc/self/fd/{fd}").readlink().name for fd in loopback.udp_sockets()}
    found = []
    for table in ("udp", "udp6"):
        for line in Path(f"/proc/self/net/{table}").read_text().splitlines()[1:]:
            cells = line.split()
            if f"socket:[{cells[9]}]" in inodes:
                found.append(cells[1])
    return found


def devices() -> set[bytes]:
    """Returns the devices that the UDP sockets of this process are bound to."""
    found = set()
    for descriptor in loopback.udp_sockets():
        with socket.socket(fileno=os.dup(descriptor)) as copy:
            found.add(copy.getsockopt(socket.SOL_SOCKET, socket.SO_BINDTODEVICE, 16).rstrip(b"\0"))
    return found


@linux
def test_no_port_is_open_beyond_loopback_and_none_after_the_end() -> None:
    assert not open_ports()
    participant = Participant(DOMAIN)
    assert len(open_ports()) >= 3 and devices() == {b"lo"}
    participant.close()
    participant.close()
    assert not open_ports()


@linux
def test_all_networks_are_used_only_when_asked() -> None:
    """Negative control of the test above."""
    participant = Participant(DOMAIN, network="all")
    assert b"lo" not in devices()
    with pytest.raises(oo.exceptions.Ros2Error, match=f"has joined DDS domain {DOMAIN} with network='all'"):
        Participant(DOMAIN)
    participant.close()


def test_ros_learns_the_node_of_each_publisher_and_subscription() -> None:
    with Peer() as peer:
        peer.hear("ros_discovery_info", "rmw_dds_common/msg/ParticipantEntitiesInfo", is_latched=True)
        peer.hear(*STATES)
        node = Node(scenario(), domain=DOMAIN)
        (info,) = peer.take("ros_discovery_info", 1)
        (own,) = info["node_entities_info_seq"]
        assert (own["node_namespace"], own["node_name"]) == ("/", "onorbit")
        assert {"data": peer.publisher("/joint_states")} in own["writer_gid_seq"]
        assert len(own["writer_gid_seq"]) == len(node.published)
        assert len(own["reader_gid_seq"]) == len(node.subscribed)
        node.close()


def test_two_nodes_of_a_process_share_a_domain() -> None:
    first, second = Participant(DOMAIN), Participant(DOMAIN)
    first.close()
    writer, reader = second.writer(*STATES), second.reader(*STATES)
    assert writer.subscribers() == 1
    assert reader.take() == []
    second.close()


@pytest.mark.parametrize("domain", [-1, 233, 0.5, True, "0"])
def test_a_domain_out_of_range_is_refused(domain: object) -> None:
    with pytest.raises(oo.exceptions.InputError, match=r"must be an integer from 0 to 232"):
        Participant(domain)  # type: ignore[arg-type]
    with pytest.raises(oo.exceptions.InputError, match="network is 'wifi'; give 'loopback' or 'all'"):
        Participant(0, network="wifi")


def test_a_node_joins_the_domain_of_the_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", str(DOMAIN))
    with contextlib.closing(Node(scenario())) as node, Peer() as peer:
        assert node.domain == DOMAIN
        peer.hear(*STATES)
        assert peer.publisher("/joint_states"), "negative control: other domains do not hear it"
    monkeypatch.setenv("ROS_DOMAIN_ID", "9999")
    with contextlib.closing(Node(scenario(), domain=DOMAIN)) as node:
        assert node.domain == DOMAIN
    for text in ("9999", "233", "-1", "010", "0x10", "4.0", "x", "1" * 5000):
        monkeypatch.setenv("ROS_DOMAIN_ID", text)
        with pytest.raises(
            oo.exceptions.InputError, match=r"ROS_DOMAIN_ID in .* is '.*from 0 to 232"
        ) as found:
            Node(scenario())
        assert (found.value.name, found.value.got) == ("ROS_DOMAIN_ID", text)
    for text in ("", "  ", "0"):
        monkeypatch.setenv("ROS_DOMAIN_ID", text)
        assert chosen_domain(None) == 0
    monkeypatch.delenv("ROS_DOMAIN_ID")
    assert chosen_domain(None) == 0


def test_the_last_domain_can_be_joined(capfd: pytest.CaptureFixture[str]) -> None:
    Participant(232).close()
    assert capfd.readouterr().err == "", "CycloneDDS complains on stderr about ports beyond 65535"


def test_a_domain_whose_participants_are_all_taken_is_named() -> None:
    taken = []
    for port in loopback._ports(DOMAIN):
        taken.append(socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
        taken[-1].bind(("127.0.0.1", port))
    with pytest.raises(oo.exceptions.Ros2Error, match=f"DDS domain {DOMAIN} is full"):
        Participant(DOMAIN)
    taken.pop().close()
    Participant(DOMAIN).close()
    for one in taken:
        one.close()


def test_without_a_network_the_error_names_what_to_enable() -> None:
    alone = ["unshare", "-rn", sys.executable, "-c", JOINED.format(DOMAIN)]
    try:
        done = subprocess.run(alone, capture_output=True, text=True, timeout=60, check=False)
    except FileNotFoundError:
        pytest.skip("unshare, which removes the network, is not installed")
    if "unshare" in done.stderr:
        pytest.skip(f"the network cannot be removed here: {done.stderr.strip()}")
    message = "the loopback interface cannot be used (Network is unreachable); enable it: ip link set lo up"
    assert done.stderr.splitlines()[-1].endswith(message)
    assert "interfaces" not in done.stderr, "CycloneDDS prints its cause"


def test_a_subscriber_that_stops_delays_the_end_by_a_second_at_most() -> None:
    """CycloneDDS waits a second for each of its publishers."""
    with Peer() as peer:
        node = Node(scenario(), domain=DOMAIN, pace="fast")
        peer.hear(*STATES)
        peer.hear("/odom", "nav_msgs/msg/Odometry")
        assert peer.publisher("/joint_states") and peer.publisher("/odom")
        wait_for_subscriber(node, "/joint_states", "/odom")
        os.kill(peer.process.pid, signal.SIGSTOP)
        node.spin(0.1)
        begin = time.monotonic()
        node.close()
        os.kill(peer.process.pid, signal.SIGCONT)
        assert 0.9 < time.monotonic() - begin < 1.5
