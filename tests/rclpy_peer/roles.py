"""The simulator beside each role of the peer."""

from __future__ import annotations

import contextlib
import json
import os
import re
import subprocess
import tempfile
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from environment import HERE, variables
from report import Report

import onorbit_rs as oo
from onorbit_rs.ros2 import Node

DOMAIN = 1 + os.getpid() % 230
ROBOT = oo.robots.load("humanoid_torso")
ARM, WRIST = ROBOT.joint_names[:4], ROBOT.joint_names[4:]
PAGE = Path("docs/howto/ros2.md")
PERIOD = 5e-3
"""Control period of the commands, s."""


class Peer:
    """A process with rclpy in a role."""

    def __init__(self, python: Path, role: str, argument: object) -> None:
        self._logs = tempfile.TemporaryDirectory()
        self._process = subprocess.Popen(
            [str(python), str(HERE / "peer.py"), role, str(argument)],
            stdout=subprocess.PIPE, text=True, env=variables(DOMAIN, Path(self._logs.name)),
        )  # fmt: skip

    def wait(self) -> None:
        """Waits until the peer is ready."""
        assert self._process.stdout is not None
        line = self._process.stdout.readline()
        assert line == "ready\n", f"the peer ended: {line!r}"

    def result(self) -> Any:
        """Returns what the peer reports."""
        text, _ = self._process.communicate(timeout=60)
        self._logs.cleanup()
        return json.loads(text.splitlines()[-1])


@contextlib.contextmanager
def node_of(simulation: oo.Simulation, **options: Any) -> Iterator[Node]:
    node = Node(simulation, domain=DOMAIN, **options)
    try:
        yield node
    finally:
        node.close()


@contextlib.contextmanager
def spinning(node: Node, duration: float) -> Iterator[list[Any]]:
    """Runs a node in a thread; the list contains its trace at the end of the block."""
    found: list[Any] = []
    thread = threading.Thread(target=lambda: found.append(node.spin(duration)))
    thread.start()
    yield found
    thread.join()


def simulation() -> oo.Simulation:
    """Returns a simulation of seven joints: four follow positions, three follow efforts."""
    controls = [
        oo.Control(oo.External(kp=100.0, kd=20.0), joints=ARM, name="arm"),
        oo.Control(oo.External(), joints=WRIST, name="wrist"),
    ]
    return oo.Simulation(
        ROBOT, ROBOT.neutral(), np.zeros(ROBOT.nv), controller=controls, control_period=PERIOD
    )


def graph(python: Path, report: Report) -> None:
    """Checks what `ros2 node list` and `ros2 topic info -v` show, and which subscriptions get messages."""
    with node_of(simulation()) as node:
        peer = Peer(python, "inspect", "")
        peer.wait()
        with spinning(node, 3.0):
            seen = peer.result()
        topics = {name: kinds[0] for name, kinds in seen["topics"].items()}
        published = {name for name, _ in node.published}
        known = dict([*node.published, *node.subscribed]).items() <= topics.items()
        report.check("node list", "onorbit" in seen["nodes"], ", ".join(seen["nodes"]))
        report.check("topics with their types", known, f"{len(published)} and {len(node.subscribed)}")
        report.check("publishers of the node", published <= seen["by node"].keys(), len(seen["by node"]))
        (states,), (robot,), (commands,) = seen["states"], seen["robot"], seen["commands"]
        report.check("QoS of /joint_states", states[3:] == ["RELIABLE", "VOLATILE"], " ".join(states[3:]))
        report.check(
            "QoS of /robot_description", robot[3:] == ["RELIABLE", "TRANSIENT_LOCAL"], " ".join(robot[3:])
        )
        hashes = [endpoint[2] for endpoint in (states, robot, commands)]
        report.check("hashes of types", all("INVALID" not in one for one in hashes), len(set(hashes)))
        report.check("node of the subscription", commands[0] == "onorbit", commands[0])
        heard = seen["heard"]
        report.check("heard by best effort", heard["best effort"][0] > 100, heard["best effort"][0])
        report.check(
            "heard by a late joiner", heard["latched"] == [1, ['<robot name="humanoi']], heard["latched"][0]
        )


def messages(python: Path, report: Report) -> None:
    """Checks that the node obeys one message of every kind, encoded by Fast DDS."""
    lines: list[str] = []
    with node_of(simulation(), pace="stepped", on_message=lines.append) as node:
        peer = Peer(python, "say", ",".join(ROBOT.joint_names))
        with spinning(node, 0.01):
            peer.wait()
            peer.result()
        name = next(iter(simulation().models))
        expected = [
            {"control": "wrist", "values": [0.25, 0.5, 1.0]},
            {"control": "arm", "values": [0.1, 0.2, 0.3, 0.4]},
            {
                "control": "arm",
                "trajectory": {"times": [2.0], "positions": [[0.5] * 4], "velocities": [[0.0] * 4]},
            },
            {"control": "wrist", "effort": [0.125, 0.0, 0.0]},
            {"body": ROBOT.body_names[0], "force": [0.0] * 3, "torque": [0.0, 0.0, 0.75], "frame": "body"},
        ]
        expected = [{"system": name, **entry, "time": 0.0} for entry in expected]
        report.check("a command of every kind", node.commands == expected, len(node.commands))
        topics = [line.split(":")[0] for line in lines]
        report.check("pause, trigger, step", topics == ["/pause", "/trigger", "/step"], ", ".join(topics))


def commands(python: Path, report: Report, count: int = 400) -> None:
    """Measures the time from a command to its effect in the state."""
    with node_of(simulation()) as node:
        peer = Peer(python, "command", count)
        with spinning(node, 3.0 + 0.016 * count) as found:
            peer.wait()
            sent = np.array(peer.result()["sent"])
        start = node._clock._start
    (trace,) = found
    effort = trace.tau[:, 4]
    values = 1e-6 * np.arange(1, count + 1)
    obeyed = {entry["values"][0]: entry["time"] for entry in node.commands}
    effects, wrong = [], 0
    for value, wall in zip(values, sent, strict=True):
        rows = np.flatnonzero(effort == value)
        if not len(rows):
            continue
        acts = trace.time[rows[0]]
        effects.append(start + acts - wall)
        update = np.ceil(obeyed[value] / PERIOD - 1e-9) * PERIOD
        wrong += abs(acts - update) > 1e-9
    delays = np.array(effects)
    median, high = np.quantile(delays, [0.5, 0.99])
    late = np.mean(delays > 2.0 * PERIOD)
    report.check(
        "commands of rclpy received", len(node.commands) == count, f"{len(node.commands)} of {count}"
    )
    report.check("the effect is at the update after the recorded time", not wrong, f"{len(effects)} effects")
    report.check(
        "command to effect, median", median < 2.0 * PERIOD, f"{1e3 * median:.2f} ms", f"{2e3 * PERIOD:g} ms"
    )
    report.check(
        "command to effect, 99 %", high < 2.0 * PERIOD, f"{1e3 * high:.2f} ms", f"{2e3 * PERIOD:g} ms", False
    )
    report.check("later than two control periods", late == 0.0, f"{100 * late:.2f} %", "0 %", False)


def example(python: Path, report: Report) -> None:
    """Checks that the node in docs/howto/ros2.md moves the arm."""
    code = re.search(r'```python title="track.py"\n(.*?)```', PAGE.read_text(), re.DOTALL)
    assert code is not None
    with tempfile.TemporaryDirectory() as folder, node_of(simulation()) as node:
        script = Path(folder) / "track.py"
        script.write_text(code[1])
        peer = subprocess.Popen(
            [str(python), str(script)],
            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, env=variables(DOMAIN, Path(folder)),
        )  # fmt: skip
        with spinning(node, 6.0) as found:
            time.sleep(5.5)
            peer.terminate()
            printed, _ = peer.communicate(timeout=10)
    error = float(np.abs([float(value) for value in re.findall(r"error (\S+) rad", printed)[50:]]).max())
    moved = float(np.ptp(found[0].q[:, 7]))
    report.check(
        "the example of the documentation moves the arm", moved > 0.15, f"{moved:.2f} rad", "0.15 rad"
    )
    report.check("its error", error < 0.02, f"{error:.3f} rad", "0.02 rad")


def listening(python: Path, report: Report, seconds: float) -> None:
    """Measures a reliable subscription to joint states at 1 kHz, with priority if that is permitted."""
    count = round(seconds * 1000) + 1
    node = Node.of_scenario("humanoid_reach", domain=DOMAIN, has_priority=True)
    with contextlib.closing(node):
        peer = Peer(python, "listen", count)
        peer.wait()
        end = time.monotonic() + 10.0
        while not node._publisher._writers["/joint_states"].subscribers():
            assert time.monotonic() < end, "the subscription is not found"
            time.sleep(0.01)
        time.sleep(1.0)
        cpu = time.process_time()
        node.spin(seconds)
        cpu = time.process_time() - cpu
        heard = peer.result()
    stamps, latency = np.array(heard["stamps"]), 1e-6 * np.array(heard["latencies"])
    lost = count - len(np.unique(stamps))
    jitter = node.jitter
    median, high, highest = (*np.quantile(latency, [0.5, 0.99]), latency.max())
    report.check(f"/joint_states lost of {count}", lost == 0 and len(stamps) == count, lost, "0")
    report.check("in order", bool((np.diff(stamps) > 0).all()))
    report.check("latency, median", median < 1.0, f"{median:.3f} ms", "1 ms")
    report.check("latency, 99 %", high < 5.0, f"{high:.3f} ms", "5 ms", False)
    report.check("latency, largest", True, f"{highest:.1f} ms")
    late = [1e3 * jitter[name] for name in ("late_median_s", "late_99_s", "late_max_s")]
    report.check("jitter, median, 99 %, largest", True, "{:.3f}, {:.3f}, {:.1f} ms".format(*late))
    report.check(
        "ticks missed, --priority", jitter["missed"] < 1e-3, f"{100 * jitter['missed']:.3f} %", "0.1 %", False
    )
    report.check("processor time of the node", True, f"{100 * cpu / seconds:.0f} % of a core")
