"""CDR of the messages: the templates against the encoder and the decoder of rosbags."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from ros2_runs import needs_ros2
from stepper_runs import scenario
from world_runs import pair

from onorbit_rs.scenario import load
from onorbit_rs.scenario.build import build

needs_ros2()

from onorbit_rs.ros2.events import event_message  # noqa: E402
from onorbit_rs.ros2.messages import Marks, Template, decode, encode, message, stamp  # noqa: E402
from onorbit_rs.ros2.rows import Rows, rows_of_trace  # noqa: E402
from onorbit_rs.ros2.topics import Topics, topics  # noqa: E402


def one_robot() -> tuple[Topics, dict[str, Rows]]:
    """Returns the topics and rows of a robot with an orbit, joints and recorded wrenches."""
    data = load("humanoid_reach").resolved()
    data["simulation"] |= {"duration": 0.01, "record_wrenches": True}
    simulation = build(load(data)).simulation
    rows = rows_of_trace(simulation.run(0.01), simulation.models)
    return topics(simulation.models, rows), rows


def two_craft() -> tuple[Topics, dict[str, Rows]]:
    world, trace = pair()
    rows = rows_of_trace(trace, world.simulation.models)
    return topics(world.simulation.models, rows), rows


@pytest.mark.parametrize("run", [one_robot, two_craft])
def test_every_topic_has_the_bytes_of_the_encoder(run: Any) -> None:
    found, rows = run()
    kinds = set()
    for topic, data in found.messages(rows):
        kinds.add(topic.kind)
        assert len(data) == len(rows[topic.system]) > 1
        for row in (data[0], data[-1]):
            assert encode(decode(row.tobytes(), topic.kind)) == row.tobytes(), topic.name
    for latched in found.latched:
        assert encode(decode(latched.data, latched.kind)) == latched.data
    expected = {"/clock", "/tf", "/orbit/pose", "/orbit/twist"}
    assert expected <= {topic.name for topic in found.series}
    if run is one_robot:
        assert "geometry_msgs/msg/WrenchStamped" in kinds and "/joint_states" in {
            t.name for t in found.series
        }


def test_joint_states_have_the_values_and_the_time_of_the_rows() -> None:
    found, rows = one_robot()
    (topic,) = (topic for topic in found.series if topic.name == "/joint_states")
    own = rows[topic.system]
    for k, row in enumerate(topic.messages(own)):
        content = decode(row.tobytes(), topic.kind)
        assert content.header.stamp.sec == 0 and content.header.stamp.nanosec == k * 1_000_000
        np.testing.assert_array_equal(content.position, own["q"][k, 7:])
        np.testing.assert_array_equal(content.velocity, own["v"][k, 6:])
        np.testing.assert_array_equal(content.effort, own["tau"][k])
    assert list(content.name) == scenario().models["humanoid_torso"].joint_names


@pytest.mark.parametrize("frame", ["", "x", "world", "eine/lange_Bezeichnung"])
@pytest.mark.parametrize("joints", [1, 2, 3])
def test_templates_fit_every_length_of_a_text(frame: str, joints: int) -> None:
    """Lengths of texts move the numbers behind them; CDR aligns them."""

    def build(marks: Marks) -> Any:
        fields = {name: marks.array(name, joints) for name in ("position", "velocity", "effort")}
        names = [frame + "j" * k for k in range(joints)]
        return message("sensor_msgs/msg/JointState", header=marks.header(frame), name=names, **fields)

    template = Template(build)
    time = np.array([0.0, 1.5, 7e6])
    values = {name: np.random.default_rng(1).normal(size=(3, joints)) for name in template._fields}
    for k, row in enumerate(template.fill(time, values)):
        content = decode(row.tobytes(), template.kind)
        assert content.header.frame_id == frame and len(row) % 4 == 0
        assert content.header.stamp.sec + 1e-9 * content.header.stamp.nanosec == time[k]
        for name, numbers in values.items():
            np.testing.assert_array_equal(getattr(content, name), numbers[k])


def test_times_are_rounded_to_nanoseconds_and_never_to_a_whole_second() -> None:
    just_below = stamp(1.0 - 1e-10)
    assert (just_below.sec, just_below.nanosec) == (1, 0)
    assert (stamp(0.3).sec, stamp(0.3).nanosec) == (0, 300_000_000)
    assert (stamp(2.0**31 - 1.0).sec, stamp(2.0**31 - 1.0).nanosec) == (2**31 - 1, 0)


def test_an_answer_has_its_level_and_its_values() -> None:
    content = decode(
        event_message(1.5, "/step", 2, "refused", {"a": "1"}), "diagnostic_msgs/msg/DiagnosticArray"
    )
    (status,) = content.status
    assert (status.level, status.name, status.message, status.hardware_id) == (
        2,
        "/step",
        "refused",
        "onorbit",
    )
    assert [(pair.key, pair.value) for pair in status.values] == [("a", "1")]
    assert content.header.frame_id == "world" and content.header.stamp.sec == 1
