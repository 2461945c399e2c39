"""Runs exported as bags: every value is read back with other packages, files are complete or absent."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import world_runs
from bag_files import differences, expected, numbers, read_mcap, read_rosbags
from commands import SPIN, onorbit, refusal
from rosbags.highlevel import AnyReader

import onorbit_rs as oo
from onorbit_rs.exceptions import DtypeError, InputError, OutputFolderError, Ros2Error
from onorbit_rs.ros2 import export
from onorbit_rs.ros2.recorded import recorded
from onorbit_rs.ros2.ros1_bag import Ros1Bag

ARM = {
    "robot": "humanoid_torso",
    "orbit": {"kind": "kepler", "semi_major_axis": "6800 km", "inclination": "51.6 deg"},
    "environment": [{"kind": "body_wrench", "body": "torso", "force": [1, 2, 3]}],
    "controller": {"kind": "joint_computed_torque", "kp": 10, "kd": 6},
    "reference": {"kind": "joint_ramps", "speed": "20 deg/s", "moves": [{"joint": "arm_joint_4", "to": 0.3}]},
    "simulation": {"duration": "0.25 s", "time_step": "1 ms", "record_wrenches": True},
}


@pytest.fixture(scope="module")
def arm() -> oo.Run:
    return oo.run(ARM, quiet=True)


@pytest.fixture(scope="module")
def file(arm: oo.Run, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Returns the exported run."""
    file = tmp_path_factory.mktemp("bags") / "run.mcap"
    done: list[float] = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(export, "_ROWS", 100)
        oo.ros2.export_mcap(arm, file, tell=done.append)
    assert done == [1 / 3, 2 / 3, 1]
    return file


@pytest.mark.parametrize("read", [read_rosbags, read_mcap])
def test_every_value_of_a_robot_is_read_back(arm: oo.Run, file: Path, read: Any) -> None:
    found, source = read(file), recorded(arm)
    wanted = expected(source)
    assert len(wanted["/joint_states"]) == len(arm.trace.time) == 251
    assert "/wrench/body_wrench/torso" in wanted and "/orbit/pose" in wanted
    assert differences(found, wanted) == []
    for topic, rows in found.items():
        stamps = [(message[0], message[1]) for _, message in rows[::50]] if topic not in LATCHED else []
        assert stamps == [divmod(time, 10**9) for time, _ in rows[::50]][: len(stamps)], topic
    # negative control: one bit of one number
    topic = "/joint_states"
    wanted[topic][170][1][3] = float(np.nextafter(wanted[topic][170][1][3], np.inf))
    assert differences(found, wanted) == [topic]


LATCHED = ("/tf_static", "/robot_description", "/events")


def test_joint_states_are_the_columns_of_the_run(arm: oo.Run, file: Path) -> None:
    rows = [message for _, message in read_rosbags(file)["/joint_states"]]
    assert rows[0][3:10] == list(arm.model.joint_names)
    values = np.array([row[10:] for row in rows])
    np.testing.assert_array_equal(values, np.hstack([arm.trace.q[:, 7:], arm.trace.v[:, 6:], arm.trace.tau]))


def test_a_run_whose_orbit_data_are_gone_is_exported_with_a_warning(tmp_path: Path) -> None:
    """The rate of the frame `orbit` then follows from the recorded state, without the slow turn of the plane.

    All other messages are unchanged.
    """
    t = np.linspace(0.0, 10.0, 11)
    path = np.stack([t, 7e6 * np.cos(1e-3 * t), 7e6 * np.sin(1e-3 * t), 0.0 * t], axis=1)
    np.savetxt(tmp_path / "path.csv", path, delimiter=",", header="t,x,y,z", comments="", fmt="%.17g")
    (tmp_path / "run.yaml").write_text(
        "robot: target_satellite\norbit: {kind: custom_path, file: path.csv}\n"
        "simulation: {duration: 2 s, time_step: 100 ms}\n"
    )
    oo.run(tmp_path / "run.yaml", out=tmp_path / "run", quiet=True)
    oo.ros2.export_mcap(tmp_path / "run", tmp_path / "before.mcap")
    (tmp_path / "path.csv").unlink()
    with pytest.warns(UserWarning, match=r"orbit cannot be computed again \(.*path.csv.*/orbit/twist"):
        oo.ros2.export_mcap(tmp_path / "run", tmp_path / "after.mcap")
    before, after = read_mcap(tmp_path / "before.mcap"), read_mcap(tmp_path / "after.mcap")
    twists = [[numbers(message) for _, message in bag.pop("/orbit/twist")] for bag in (before, after)]
    assert before == after and len(before["/odom"]) == 21
    np.testing.assert_allclose(*twists, atol=1e-6)


@pytest.mark.parametrize(
    ("write", "name", "read"),
    [("export_mcap", "run.mcap", read_rosbags), ("export_mcap", "run.mcap", read_mcap),
     ("export_bag", "run.bag", read_rosbags)],
)  # fmt: skip
def test_every_value_and_event_of_a_world_is_read_back(
    tmp_path: Path, write: str, name: str, read: Any
) -> None:
    built, trace = world_runs.trio()
    models = {system: own.model for system, own in built.systems.items()}
    getattr(oo.ros2, write)(trace, tmp_path / name, models=models)
    found = read(tmp_path / name)
    wanted = expected(recorded(trace, models))
    assert {"/chaser/joint_states", "/target/odom", "/third/odom"} <= set(wanted)
    assert differences(found, wanted) == []
    for (time, message), record in zip(found["/events"], trace.events, strict=True):
        assert time == round(record.time * 1e9)
        if write == "export_bag":
            assert message.pop(0) == 0, "headers of ROS 1 begin with a number"
        assert message[:3] == [*divmod(time, 10**9), "world"]
        level, name, text = message[3:6]
        assert (level in (0, b"\0"), name, text) == (True, record.name, f"{record.kind}: chaser and target")
        pairs = dict(zip(message[7::2], message[8::2], strict=True))
        assert [float(number) for number in pairs["impulse"].split()] == record.impulse.tolist()
        assert float(pairs["energy_lost"]) == record.energy_lost
    assert len(found["/tf_static"]) == len(found["/target/robot_description"]) == 1


def test_a_flipped_bit_in_the_file_is_found(file: Path, tmp_path: Path) -> None:
    raw = bytearray(file.read_bytes())
    raw[len(raw) // 2] ^= 1
    (tmp_path / "run.mcap").write_bytes(raw)
    for read in (read_rosbags, read_mcap):
        with pytest.raises(Exception, match=r"(?i)checksum|crc|decompress|zstd"):
            read(tmp_path / "run.mcap")


def test_a_bag_of_ros_1_has_every_value(arm: oo.Run, tmp_path: Path) -> None:
    oo.ros2.export_bag(arm, tmp_path / "run.bag")
    found, wanted = read_rosbags(tmp_path / "run.bag"), expected(recorded(arm))
    assert differences(found, wanted) == []
    assert found["/robot_description"][0][1][0].startswith("<robot")


def test_the_type_of_tf_is_that_of_ros_1(tmp_path: Path) -> None:
    with Ros1Bag(tmp_path / "run.bag") as bag:
        number = bag.add_topic("/tf", "tf2_msgs/msg/TFMessage")
    assert bag._topics[number].digest == "94810edda583a504dfda3829e70d7eec", "the checksum of ROS 1"


def test_topics_are_latched_as_the_node_latches_them(file: Path) -> None:
    with AnyReader([file]) as reader:
        durability = {
            connection.topic: connection.ext.offered_qos_profiles[0].durability.name  # type: ignore[union-attr]
            for connection in reader.connections
        }
    assert [topic for topic, name in durability.items() if name == "TRANSIENT_LOCAL"] == [
        "/tf_static", "/robot_description",
    ]  # fmt: skip


def test_the_command_exports_a_folder(tmp_path: Path, no_pictures: None) -> None:
    (tmp_path / "spin.yaml").write_text(SPIN)
    assert onorbit("run", "spin.yaml", "--out", "run", "-q", cwd=tmp_path).returncode == 0
    done = onorbit("export", "run", "--mcap", "run.mcap", "--bag", "run.bag", cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert [line.split(" (")[0] for line in done.stdout.splitlines()] == ["mcap: run.mcap", "bag: run.bag"]
    first, second = read_mcap(tmp_path / "run.mcap"), read_rosbags(tmp_path / "run.bag")
    assert set(first) == set(second) == {"/clock", "/tf", "/tf_static", "/robot_description", "/odom"}
    assert len(first["/clock"]) == 11
    assert "already exists; replace it with --force" in refusal(
        "export", "run", "--mcap", "run.mcap", cwd=tmp_path
    )
    assert onorbit("export", "run", "--mcap", "run.mcap", "--force", cwd=tmp_path).returncode == 0


def test_invalid_requests_are_refused(arm: oo.Run, tmp_path: Path) -> None:
    assert "no output file is given" in refusal("export", tmp_path)
    assert "must end in .mcap" in refusal("export", tmp_path, "--mcap", tmp_path / "run.bag")
    assert "no run in this folder" in refusal("export", tmp_path, "--mcap", tmp_path / "run.mcap")
    with pytest.raises(InputError, match="a trace does not contain its robots, so give a Model"):
        oo.ros2.export_mcap(arm.trace, tmp_path / "run.mcap")
    with pytest.raises(InputError, match="omit models"):
        oo.ros2.export_mcap(arm, tmp_path / "run.mcap", models=arm.model)
    with pytest.raises(InputError, match="the systems chaser, target"):
        oo.ros2.export_mcap(world_runs.pair()[1], tmp_path / "run.mcap", models=arm.model)
    with pytest.raises(DtypeError, match="cannot export int"):
        oo.ros2.export_mcap(3, tmp_path / "run.mcap")  # type: ignore[arg-type]
    with pytest.raises(OutputFolderError, match="cannot write"):
        oo.ros2.export_mcap(arm, tmp_path / "none" / "run.mcap")
    assert list(tmp_path.iterdir()) == []


def test_a_failed_export_leaves_the_earlier_file(arm: oo.Run, tmp_path: Path) -> None:
    file = tmp_path / "run.mcap"
    file.write_bytes(b"before")

    def stop(done: float) -> None:
        raise KeyboardInterrupt

    for write in (oo.ros2.export_mcap, oo.ros2.export_bag):
        with pytest.raises(KeyboardInterrupt):
            write(arm, file, tell=stop)
    assert file.read_bytes() == b"before"
    assert list(tmp_path.iterdir()) == [file]


@pytest.mark.skipif(os.name != "posix", reason="sends SIGKILL")
def test_a_killed_export_leaves_nothing_under_the_name(tmp_path: Path) -> None:
    program = (
        "import onorbit_rs as oo, time\n"
        "run = oo.run({'robot': 'small_satellite', 'simulation': {'duration': 1}}, quiet=True)\n"
        "def tell(done):\n    print('writing', flush=True); time.sleep(60)\n"
        f"oo.ros2.export_mcap(run, {str(tmp_path / 'run.mcap')!r}, tell=tell)\n"
    )
    process = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None and process.stdout.readline() == "writing\n"
    process.send_signal(signal.SIGKILL)
    process.communicate()
    assert [file.name for file in tmp_path.iterdir() if not file.name.startswith(".partial-")] == []


def test_without_the_extra_the_error_names_it(arm: oo.Run, monkeypatch: pytest.MonkeyPatch) -> None:
    from onorbit_rs.ros2 import extra

    monkeypatch.setattr(extra, "find_spec", lambda name: None)
    with pytest.raises(Ros2Error, match=r"require mcap and rosbags; .*onorbit-rs\[ros2\]"):
        _ = oo.ros2.export_mcap


def test_a_model_with_other_joints_is_refused(tmp_path: Path) -> None:
    model = oo.robots.load("servicer")
    trace = oo.Simulation(model, model.neutral(), np.zeros(model.nv)).run(0.01)
    other = oo.robots.load("target_satellite")
    with pytest.raises(oo.exceptions.InputError, match="has 0 joints, but the trace has 7"):
        oo.ros2.export_mcap(trace, tmp_path / "a.mcap", models=other)
    assert not list(tmp_path.iterdir())
