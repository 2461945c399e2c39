"""A ROS 2 node that listens to the simulator or drives it; runs in an environment with rclpy.

It prints one JSON object at its end. Usage: python peer.py ROLE ARGUMENT
"""

from __future__ import annotations

import json
import sys
import time
from typing import Any

import rclpy
from geometry_msgs.msg import WrenchStamped
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool, Float64, Float64MultiArray, String
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint


def ready() -> None:
    """Prints a line, which announces that the subscriptions exist."""
    print("ready", flush=True)


def listen(node: Any, count: str) -> dict[str, Any]:
    """Returns stamps and latencies, ns, of ``count`` joint states, or of fewer after two silent seconds."""
    stamps: list[int] = []
    latencies: list[int] = []

    def hear(message: JointState, info: dict[str, int]) -> None:
        latencies.append(time.time_ns() - info["source_timestamp"])
        stamps.append(message.header.stamp.sec * 10**9 + message.header.stamp.nanosec)

    node.create_subscription(JointState, "/joint_states", hear, QoSProfile(depth=5000))
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    ready()
    last = time.monotonic()
    while len(stamps) < int(count) and (not stamps or time.monotonic() - last < 2.0):
        before = len(stamps)
        executor.spin_once(timeout_sec=0.5)
        last = time.monotonic() if len(stamps) > before else last
    return {"stamps": stamps, "latencies": latencies, "cpu_s": time.process_time()}


def command(node: Any, count: str) -> dict[str, Any]:
    """Returns the times, s on the clock of the machine, at which efforts `1e-6 k` were sent."""
    publisher = node.create_publisher(Float64MultiArray, "/wrist/commands", 10)
    while not publisher.get_subscription_count():
        time.sleep(0.01)
    time.sleep(0.5)
    ready()
    sent = []
    for k in range(1, int(count) + 1):
        sent.append(time.perf_counter())
        publisher.publish(Float64MultiArray(data=[1e-6 * k, 0.0, 0.0]))
        time.sleep(0.0137)
    time.sleep(0.5)
    return {"sent": sent}


def inspect(node: Any, _: str) -> dict[str, Any]:
    """Returns what ROS knows about the simulator, and what each kind of subscription hears."""
    heard: dict[str, list[Any]] = {"best effort": [], "latched": []}
    best_effort = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    node.create_subscription(
        JointState, "/joint_states", lambda m: heard["best effort"].append(len(m.name)), best_effort
    )
    node.create_subscription(
        String, "/robot_description", lambda m: heard["latched"].append(m.data[:20]), latched
    )
    ready()
    end = time.monotonic() + 3.0
    while time.monotonic() < end:
        rclpy.spin_once(node, timeout_sec=0.1)
    states = node.get_publishers_info_by_topic("/joint_states")
    robot = node.get_publishers_info_by_topic("/robot_description")
    commands = node.get_subscriptions_info_by_topic("/wrist/commands")
    return {
        "nodes": [name for name, _ in node.get_node_names_and_namespaces()],
        "topics": dict(node.get_topic_names_and_types()),
        "states": [_endpoint(one) for one in states], "robot": [_endpoint(one) for one in robot],
        "commands": [_endpoint(one) for one in commands],
        "by node": dict(node.get_publisher_names_and_types_by_node("onorbit", "/")),
        "heard": {name: [len(values), values[:1]] for name, values in heard.items()},
    }  # fmt: skip


def _endpoint(info: Any) -> list[Any]:
    qos = info.qos_profile
    return [
        info.node_name,
        info.topic_type,
        str(info.topic_type_hash),
        qos.reliability.name,
        qos.durability.name,
    ]


def say(node: Any, joints: str) -> dict[str, Any]:
    """Sends one message of every kind to a stepped simulator."""
    names = joints.split(",")
    topics = {
        "/wrist/commands": Float64MultiArray(data=[0.25, 0.5, 1.0]),
        "/arm/commands": Float64MultiArray(data=[0.1, 0.2, 0.3, 0.4]),
        "/arm/joint_trajectory": JointTrajectory(
            joint_names=names[:4],
            points=[JointTrajectoryPoint(positions=[0.5] * 4, velocities=[0.0] * 4)],
        ),
        "/joint_commands": JointState(name=names[4:], effort=[0.125, 0.0, 0.0]),
        "/wrench_command": WrenchStamped(),
        "/pause": Bool(data=True),
        "/trigger": String(data="nothing"),
        "/step": Float64(data=0.01),
    }
    topics["/arm/joint_trajectory"].points[0].time_from_start.sec = 2
    topics["/wrench_command"].wrench.torque.z = 0.75
    publishers = {topic: node.create_publisher(type(message), topic, 10) for topic, message in topics.items()}
    while not all(publisher.get_subscription_count() for publisher in publishers.values()):
        time.sleep(0.01)
    time.sleep(0.5)
    ready()
    for topic, message in topics.items():
        publishers[topic].publish(message)
        time.sleep(0.1)
    time.sleep(0.5)
    return {}


def main() -> None:
    role, argument = sys.argv[1:]
    rclpy.init()
    node = rclpy.create_node(f"peer_{role}")
    print(
        json.dumps(
            {"listen": listen, "command": command, "inspect": inspect, "say": say}[role](node, argument)
        )
    )


if __name__ == "__main__":
    main()
