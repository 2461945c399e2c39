"""Recordings of a live node: everything published, the commands obeyed, and complete files after signals."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import world_runs
from bag_files import differences, expected, numbers, read_mcap, read_rosbags
from commands import SPIN, refusal
from ros2_runs import DOMAIN, Peer, node_of, spinning
from stepper_runs import assert_same_bits

import onorbit_rs as oo
from onorbit_rs.exceptions import OutputFolderError
from onorbit_rs.ros2 import Node
from onorbit_rs.ros2.recorded import recorded

ROBOT = oo.robots.load("humanoid_torso")
FLOATS = "std_msgs/msg/Float64MultiArray"


def simulation() -> oo.Simulation:
    control = oo.Control(oo.External(kp=100.0, kd=20.0), joints=ROBOT.joint_names, name="arm")
    orbit = oo.Kepler(semi_major_axis=7e6)
    return oo.Simulation(ROBOT, ROBOT.neutral(), np.zeros(ROBOT.nv), orbit=orbit, controller=[control])


def wanted_of(run: oo.Simulation, trace: Any) -> Any:
    models: Any = run.models if isinstance(trace, oo.WorldTrace) else next(iter(run.models.values()))
    return expected(replace(recorded(trace, models), orbit=run.orbit))


def test_commands_and_answers_are_recorded_and_a_reset_is_refused(tmp_path: Path) -> None:
    file, run = tmp_path / "run.mcap", simulation()
    with Peer() as peer, node_of(run, pace="stepped", record=file) as node, spinning(node, 0.3) as found:
        peer.hear("/events", "diagnostic_msgs/msg/DiagnosticArray")
        assert peer.publisher("/events")

        def say(topic: str, kind: str, values: dict[str, Any]) -> str:
            peer.say(topic, kind, values)
            (message,) = peer.take("/events", 1)
            return str(message["status"][0]["message"])

        assert say("/step", "std_msgs/msg/Float64", {"data": 0.1}) == "advanced to t = 0.1 s"
        refused = "refused: the run is recorded, and times in a bag do not go back"
        assert say("/reset", "std_msgs/msg/Empty", {}) == refused
        assert say("/arm/commands", FLOATS, {"data": [1.0]}).startswith(
            "refused: the array 'data' has length 1; "
        )
        peer.say("/arm/commands", FLOATS, {"data": [0.1] * 7})
        end = time.monotonic() + 5.0
        while not node.commands:
            assert time.monotonic() < end
            time.sleep(0.002)
        assert say("/step", "std_msgs/msg/Float64", {"data": 0.2}) == "advanced to t = 0.3 s"
    assert not list(tmp_path.glob(".partial-*"))
    bag, wanted = read_mcap(file), wanted_of(run, found[0])
    # the row at 0.1 s was published before the command of that time set its efforts
    rows = [row for table in (bag, wanted) for row in table["/joint_states"] if row[0] == 10**8]
    before, after = numbers(rows[0][1]), rows[1][1]
    assert before[:14] == after[:14] and np.abs(before[14:]).max() < 1e-6 < np.abs(after[14:]).max()
    after[14:] = before[14:]
    assert differences(bag, wanted) == []
    assert [(stamp, numbers(message)) for stamp, message in bag["/arm/commands"]] == [(10**8, [0.1] * 7)]
    assert [(stamp, numbers(message)) for stamp, message in bag["/step"]] == [(0, [0.1]), (10**8, [0.2])]
    assert "/reset" not in bag
    assert [(stamp, message[5]) for stamp, message in bag["/events"]][1] == (10**8, refused)
    assert len(bag["/tf_static"]) == len(bag["/robot_description"]) == 1


def test_a_world_is_recorded_with_its_events(tmp_path: Path) -> None:
    run = world_runs.built(world_runs.data()).simulation
    with node_of(run, pace="fast", record=tmp_path / "run.mcap") as node:
        trace = node.spin(0.5)
        assert next(tmp_path.iterdir()).name.startswith(".partial-"), "absent before it is complete"
    bag = read_rosbags(tmp_path / "run.mcap")
    assert differences(bag, wanted_of(run, trace)) == []
    assert [message[4] for _, message in bag["/events"]] == ["grasp", "let_go"]
    assert_same_bits(trace["chaser"], world_runs.pair()[1]["chaser"])


@pytest.mark.skipif(os.name != "posix", reason="sends SIGINT")
def test_ctrl_c_loses_no_row(tmp_path: Path) -> None:
    run = simulation()
    with node_of(run, pace="fast", record=tmp_path / "run.mcap") as node:
        sender = threading.Timer(0.1, os.kill, (os.getpid(), signal.SIGINT))
        sender.start()
        trace = node.spin()
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    assert len(trace.time) > 100
    bag = read_mcap(tmp_path / "run.mcap")
    assert differences(bag, wanted_of(run, trace)) == []
    assert bag["/events"][-1][1][4:6] == ["run", "stopped"]


@pytest.mark.skipif(os.name != "posix", reason="sends SIGTERM")
def test_a_terminated_command_completes_its_file(tmp_path: Path) -> None:
    (tmp_path / "spin.yaml").write_text(SPIN)
    words = ["ros2", "spin.yaml", "--for", "60", "--record", "run.mcap", "--domain", str(DOMAIN)]
    command = [sys.executable, "-m", "onorbit_rs", *words]
    with subprocess.Popen(
        command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        assert process.stderr is not None and process.stderr.readline().startswith("ROS 2 domain")
        time.sleep(0.1)
        process.send_signal(signal.SIGTERM)
        out, err = process.communicate(timeout=20)
    assert process.returncode == 0, err
    assert "recording: run.mcap" in out
    assert sorted(file.name for file in tmp_path.iterdir()) == ["run.mcap", "spin.yaml"]
    assert read_rosbags(tmp_path / "run.mcap")["/events"][-1][1][4:6] == ["run", "stopped"]


def test_a_recording_that_cannot_be_written_is_refused_at_once(tmp_path: Path) -> None:
    (tmp_path / "old.mcap").write_bytes(b"before")
    assert "already exists; replace it with --force" in refusal(
        "ros2", "x", "--record", tmp_path / "old.mcap"
    )
    assert "must end in .mcap" in refusal("ros2", "x", "--record", tmp_path / "run.bag")
    with pytest.raises(OutputFolderError, match="cannot write"):
        Node(simulation(), domain=DOMAIN, record=tmp_path / "none" / "run.mcap")
    assert (tmp_path / "old.mcap").read_bytes() == b"before"
