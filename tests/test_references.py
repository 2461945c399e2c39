"""References from Python and from scenarios: values, frames, and invalid input."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs import exceptions
from onorbit_rs.common.rotations import matrix_from_quaternion, quaternion_from_matrix
from onorbit_rs.scenario import load
from onorbit_rs.scenario.build import build

START = np.eye(4)
END = np.array([[0.0, -1, 0, 0.3], [1, 0, 0, 0.4], [0, 0, 1, 0], [0, 0, 0, 1]])
ORBIT = oo.Kepler(semi_major_axis=7e6, eccentricity=0.1, inclination=0.9)
TIMES = np.array([0.0, 1.0, 2.5])
POSES = np.array([START, END, START])

KINDS: dict[str, Callable[..., oo.Reference]] = {
    "hold": lambda **k: oo.Hold(END, **k),
    "line_parabola": lambda **k: oo.LineParabola(START, displacement=[1, 0, 0], duration=2.0, **k),
    "line": lambda **k: oo.Line(START, END, duration=2.0, **k),
    "circle": lambda **k: oo.Circle(
        END, center=[0, 0, 0], axis=[0, 1, 1], angle=3.0, speed=0.2, ramp=0.2, **k
    ),
    "screw": lambda **k: oo.Screw(
        END, center=[0, 0, 0], axis=[0, 0, 1], angle=3.0, advance=0.1, duration=2.0, **k
    ),
    "waypoints": lambda **k: oo.Waypoints(POSES, speed=0.3, angular_acceleration=1.0, stops=False, **k),
    "sampled": lambda **k: oo.Sampled(TIMES, POSES, **k),
}


@pytest.mark.parametrize("kind", KINDS)
def test_instants_give_rows_and_rates_are_derivatives(kind: str) -> None:
    reference = KINDS[kind]()
    assert isinstance(reference, oo.Reference)
    h, t = 1e-5, np.linspace(0.1, max(reference.duration, 1.0) - 0.1, 7) + 1e-3
    poses, velocity, acceleration = reference.sample(t)
    assert (poses.shape, velocity.shape, acceleration.shape) == ((7, 4, 4), (7, 6), (7, 6))
    for one, row in zip(reference.sample(t[3]), (poses[3], velocity[3], acceleration[3]), strict=True):
        np.testing.assert_array_equal(one, row)
    after, before = reference.sample(t + h), reference.sample(t - h)
    # central differences of 1e-5 s: 1e-10 of third derivatives, rounding 1e-11
    np.testing.assert_allclose((after[0] - before[0])[:, :3, 3] / (2 * h), velocity[:, :3], atol=1e-8)
    np.testing.assert_allclose((after[1] - before[1]) / (2 * h), acceleration, atol=1e-8)
    spin = (after[0] - before[0])[:, :3, :3] / (2 * h) @ np.swapaxes(poses[:, :3, :3], 1, 2)  # [ω] = Ṙ Rᵀ
    np.testing.assert_allclose(spin[:, [2, 0, 1], [1, 2, 0]], velocity[:, 3:], atol=1e-8)


@pytest.mark.parametrize("kind", KINDS)
def test_a_path_relative_to_the_orbital_frame_rotates_with_it(kind: str) -> None:
    inside, reference = KINDS[kind](), KINDS[kind](frame="lvlh")
    t = 0.7
    rot, rate = ORBIT.lvlh(t)
    pose, velocity, _ = reference.in_world(t, orbit=ORBIT)
    own_pose, own_velocity, _ = inside.sample(t)
    np.testing.assert_allclose(pose[:3, :3], rot @ own_pose[:3, :3], atol=1e-14)
    np.testing.assert_allclose(pose[:3, 3], rot @ own_pose[:3, 3], atol=1e-14)
    expected = rot @ (own_velocity[:3] + np.cross(rate, own_pose[:3, 3]))
    np.testing.assert_allclose(velocity[:3], expected, atol=1e-14)
    np.testing.assert_array_equal(reference.sample(t)[0], own_pose)


def test_a_reference_moves_with_a_target() -> None:
    target = oo.Target(END, velocity=[0.1, 0, 0], spin=[0, 0, 0.5])
    pose, velocity, acceleration = oo.Hold(END, frame=target).in_world(np.pi)
    turn = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])  # pi/2 about z
    arm = turn @ END[:3, :3] @ END[:3, 3]
    np.testing.assert_allclose(pose[:3, :3], turn @ END[:3, :3] @ END[:3, :3], atol=1e-15)
    np.testing.assert_allclose(pose[:3, 3], END[:3, 3] + [0.1 * np.pi, 0, 0] + arm, atol=1e-15)
    np.testing.assert_allclose(velocity, [0.1 - 0.5 * arm[1], 0.5 * arm[0], 0, 0, 0, 0.5], atol=1e-15)
    np.testing.assert_allclose(acceleration[:3], -0.25 * arm * [1, 1, 0], atol=1e-15)


def test_limits_set_the_duration_of_a_line() -> None:
    assert oo.Line(START, END, speed=0.1).duration == pytest.approx(1.875 * 0.5 / 0.1, rel=1e-14)
    by_acceleration = oo.Line(START, END, acceleration=0.1).duration
    assert by_acceleration == pytest.approx(np.sqrt(10 / np.sqrt(3) * 0.5 / 0.1), rel=1e-14)
    assert oo.Line(START, END, angular_speed=0.1).duration == pytest.approx(
        1.875 * np.pi / 2 / 0.1, rel=1e-14
    )


def test_joints_follow_waypoints_samples_and_one_another() -> None:
    points = np.array([[0.0, 1.0], [1.0, 0.5], [0.5, 0.0]])
    path = oo.JointWaypoints(points, speed=[0.5, 0.2])
    q, v, a = path.sample(np.linspace(0, path.duration, 2001))
    assert q.shape == v.shape == a.shape == (2001, 2)
    np.testing.assert_array_equal(q[[0, -1]], points[[0, 2]])
    assert 0.999 < (np.abs(v).max(axis=0) / [0.5, 0.2]).max() <= 1.0 + 1e-12
    t = np.linspace(0, 3, 31)
    sampled = oo.JointSampled(
        t, np.stack([np.sin(t), np.cos(t)], 1), rates=np.stack([np.cos(t), -np.sin(t)], 1)
    )
    np.testing.assert_allclose(sampled.sample(1.234)[0], [np.sin(1.234), np.cos(1.234)], atol=1e-7)
    moves = oo.JointWaypoints.one_by_one([0.0, 0.0], [(1, 1.0), (0, 2.0)], speed=0.1)
    np.testing.assert_allclose(moves.sample(18.75)[0], [0.0, 1.0], atol=1e-15)
    np.testing.assert_array_equal(oo.JointHold([0.1, 0.2]).sample(5.0)[0], [0.1, 0.2])


BAD: dict[str, tuple[Callable[[], Any], type[Exception], str]] = {
    "no time": (lambda: oo.Line(START, END), exceptions.ControlError, "limit"),
    "both": (lambda: oo.Line(START, END, duration=1.0, speed=1.0), exceptions.ControlError, "omit one"),
    "zero duration": (lambda: oo.Line(START, END, duration=0.0), exceptions.ControlError, "at least"),
    "a negative limit": (lambda: oo.Line(START, END, speed=-1.0), exceptions.ControlError, "-1"),
    "nan": (lambda: oo.Hold(START * np.nan), exceptions.InputError, "finite"),
    "no rotation": (lambda: oo.Hold(np.diag([2.0, 1, 1, 1])), exceptions.ControlError, "rotation"),
    "poses of a wrong shape": (lambda: oo.Waypoints(START, times=[0.0]), exceptions.ShapeError, "(K, 4, 4)"),
    "times that go back": (lambda: oo.Sampled([0, 2, 1], POSES), exceptions.ControlError, "increase"),
    "times that are nan": (lambda: oo.Sampled([0, np.nan, 1], POSES), exceptions.ControlError, "finite"),
    "one time short": (lambda: oo.Sampled([0, 1], POSES), exceptions.ShapeError, "expected"),
    "one sample": (lambda: oo.Sampled([0.0], POSES[:1]), exceptions.ControlError, "at least 2"),
    "velocities of five": (
        lambda: oo.Sampled(TIMES, POSES, velocities=np.zeros((3, 5))), exceptions.ShapeError, "(K, 6)"
    ),
    "no axis": (
        lambda: oo.Circle(END, center=[0, 0, 0], axis=[0, 0, 0], angle=1, duration=1),
        exceptions.ControlError, "axis",
    ),
    "a long ramp": (
        lambda: oo.Circle(END, center=[0, 0, 0], axis=[0, 0, 1], angle=1, duration=1, ramp=0.7),
        exceptions.ControlError, "0.5",
    ),
    "an unknown frame": (lambda: oo.Hold(END, frame="moon"), exceptions.ControlError, "moon"),  # type: ignore[arg-type]
    "no orbit": (lambda: oo.Hold(END, frame="lvlh").in_world(0.0), exceptions.ControlError, "orbit"),
    "relative to a base": (lambda: oo.Hold(END, frame="base").in_world(0.0), exceptions.ControlError, "base"),
    "limits of three joints": (
        lambda: oo.JointWaypoints([[0, 0], [1, 1]], speed=[1, 1, 1]), exceptions.ShapeError, "(2,)"
    ),
    "unknown joint": (
        lambda: oo.JointWaypoints.one_by_one([0.0], [(3, 1.0)], speed=1.0), exceptions.ControlError, "joint 3"
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", BAD)
def test_invalid_references_are_rejected(case: str) -> None:
    make, error, words = BAD[case]
    with pytest.raises(error) as caught:
        make()
    assert words in str(caught.value) and isinstance(caught.value, oo.OnOrbitError)


def test_a_reference_with_a_distant_start_reports_the_distance() -> None:
    model = oo.robots.load("humanoid_torso")
    q, v = model.neutral(), np.zeros(model.nv)
    q[7:] = [0.5342, -2.341, -2.0077, -2.2249, -2.2693, -0.1342, -0.1974]
    pose = np.array(model.frame_pose(q, "tool"))
    pose[0, 3] += 0.2
    law = oo.ComputedTorque(model, "tool")
    with pytest.raises(
        exceptions.ControlError,
        match=r"starts 0\.2 m and 0 rad from the frame; it must start within 0\.05 m and .*_tolerance",
    ) as caught:
        oo.Simulation(model, q, v, controller=law, reference=oo.Hold(pose))
    assert caught.value.got[0] == pytest.approx(0.2)
    oo.Simulation(
        model, q, v, controller=law, reference=oo.Hold(pose), reference_start_tolerance=[0.3, 0.1]
    ).run(0.01)


def scenario(folder: Path, reference: str) -> Path:
    text = (oo.scenarios.path("humanoid_reach")).read_text()
    before, after = text.split("reference:\n")
    rest = after[after.index("initial:") :]
    file = folder / "mine.yaml"
    file.write_text(f"{before}reference: {reference}\n\n{rest.replace('duration: 6 s', 'duration: 5 ms')}")
    return file


def write_csv(file: Path) -> None:
    t = np.linspace(0.0, 2.0, 41)
    pose, velocity, _ = oo.Line(START, END, duration=2.0).sample(t)
    table = np.column_stack([t, pose[:, :3, 3], quaternion_from_matrix(pose[:, :3, :3]), velocity])
    np.savetxt(
        file,
        table,
        delimiter=",",
        header="time,x,y,z,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz",
        comments="",
        fmt="%.17g",
    )


@pytest.mark.parametrize(
    "reference",
    [
        "{kind: line, goal: {displacement: [10 cm, 0, 0], turn: {roll_pitch_yaw: [0, 0, 10 deg]}},"
        " duration: 2 s}",
        "{kind: line, frame: lvlh, goal: {displacement: [0.1, 0, 0]}, speed: 5 cm/s,"
        " acceleration: 0.1 m/s^2}",
        "{kind: circle, center: [0, 0, 0.1], axis: [1, 0, 0], angle: 360 deg, duration: 4 s, turns: false}",
        "{kind: screw, frame: {target: {position: [1, 0, 0], spin: [0, 0, 1 deg/s]}}, center: [0, 0, 0.1],"
        " axis: [1, 0, 0], angle: 90 deg, advance: 5 cm, duration: 4 s}",
        "{kind: waypoints, points: [{displacement: [0.1, 0, 0]}, {displacement: [0.1, 0.1, 0]}],"
        " times: [1 s, 2 s]}",
        "{kind: sampled, file: motion.csv, relative: true}",
        "hold",
    ],
)
def test_scenarios_start_every_kind_at_the_tool(tmp_path: Path, reference: str) -> None:
    write_csv(tmp_path / "motion.csv")
    built = build(load(scenario(tmp_path, reference)))
    trace = built.simulation.run(0.005)
    assert np.linalg.norm(trace.position_error[0]) < 1e-12
    assert np.linalg.norm(trace.attitude_error[0]) < 1e-12
    again = load(built.scenario.resolved())
    assert again.reference == built.scenario.reference


def test_a_csv_reproduces_the_motion(tmp_path: Path) -> None:
    write_csv(tmp_path / "motion.csv")
    text = "{kind: sampled, file: motion.csv}"
    with pytest.raises(exceptions.ControlError, match=r"mine.yaml.*starts .* m and .* rad from the frame"):
        build(load(scenario(tmp_path, text)))
    from onorbit_rs.scenario.reference import SampledReference
    from onorbit_rs.scenario.reference.start import Start

    model = oo.robots.load("humanoid_torso")
    at = Start(model, model.neutral(), None, tmp_path, tool="tool")
    got = SampledReference(file="motion.csv").build(at).sample(0.777)[0]
    line = oo.Line(START, END, duration=2.0).sample(0.777)[0]
    np.testing.assert_allclose(got, line, atol=1e-6)  # fourth order of 0.05 s


def test_joint_references_of_scenarios(tmp_path: Path) -> None:
    from onorbit_rs.scenario import reference as parts
    from onorbit_rs.scenario.reference.start import Start

    model = oo.robots.load("humanoid_torso")
    names, q = list(model.joint_names), model.neutral()
    q[7:] = 0.1 * np.arange(7)
    at = Start(model, q, None, tmp_path)
    end = lambda part, at=at: part.build(at).sample(1e3)[0]  # noqa: E731
    np.testing.assert_array_equal(end(parts.JointHoldReference()), q[7:])
    points = parts.JointWaypointsReference(points=[{names[2]: "30 deg"}], speed="5 deg/s")
    expected = q[7:].copy()
    expected[2] = np.deg2rad(30)
    np.testing.assert_allclose(end(points), expected, atol=1e-15)
    assert points.build(at).duration == pytest.approx(1.875 * abs(expected[2] - q[9]) / np.deg2rad(5))
    ramps = parts.JointRampsReference(moves=[{"joint": names[1], "to": "1 rad"}], speed=0.1)
    group = Start(model, q, None, tmp_path, joints=(names[1], names[4]))
    np.testing.assert_allclose(end(ramps, group), [1.0, q[11]], atol=1e-15)
    (tmp_path / "joints.csv").write_text(f"time,{names[3]}\n0,0.3\n1,0.5\n2,0.9\n")
    sampled = parts.JointSampledReference(file="joints.csv")
    assert end(sampled)[3] == 0.9 and sampled.build(at).sample(1.0)[0][3] == 0.5
    (tmp_path / "joints.csv").write_text("time,elbow\n0,0.3\n")
    with pytest.raises(exceptions.ReadError, match="elbow"):
        sampled.build(at)
    with pytest.raises(exceptions.FrameError, match="no joint of the group is named"):
        parts.JointRampsReference(moves=[{"joint": "elbow", "to": 1}], speed=0.1).build(at)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("time,x,y,z,qx,qy,qz\n", "qw"),
        ("time,x,y,z,qx,qy,qz,qw\n0,0,0,0,0,0,0,one\n", r"motion\.csv:2: .one. is not a number"),
        ("time,x,y,z,qx,qy,qz,qw\n0,0,0\n", "number of cells is 3"),
        ("time,x,y,z,qx,qy,qz,qw,vx\n", "vy"),
    ],
)
def test_an_invalid_csv_is_reported(tmp_path: Path, text: str, words: str) -> None:
    (tmp_path / "motion.csv").write_text(text)
    with pytest.raises(exceptions.ReadError, match=words):
        build(load(scenario(tmp_path, "{kind: sampled, file: motion.csv}")))
    with pytest.raises(exceptions.NotFoundError, match=r"nowhere\.csv"):
        build(load(scenario(tmp_path, "{kind: sampled, file: nowhere.csv}")))


def test_quaternions_of_the_csv_are_the_attitudes() -> None:
    quat = quaternion_from_matrix(END[:3, :3])
    np.testing.assert_allclose(matrix_from_quaternion(quat), END[:3, :3], atol=1e-15)


@pytest.mark.parametrize("ramp", [0.5, 0.01, 5e-4, 1e-4])
def test_short_ramps_respect_the_limits(ramp: float) -> None:
    pose = np.eye(4)
    pose[0, 3] = 1.0
    circle = oo.Circle(
        pose, center=[0, 0, 0], axis=[0, 0, 1], angle=3.0, ramp=ramp, speed=1.0, acceleration=50.0,
        angular_speed=100.0, angular_acceleration=1e4,
    )  # fmt: skip
    ends = np.linspace(0.0, ramp * circle.duration, 2001)
    acceleration = np.linalg.norm(circle.sample(ends)[2][:, :3], axis=1).max()
    speed = np.linalg.norm(circle.sample(0.5 * circle.duration)[1][:3])
    assert acceleration <= 50.0 and speed <= 1.0
    assert max(acceleration / 50.0, speed) > 0.99


@pytest.mark.parametrize("span", [3.0, 1.5, 0.6])
def test_the_rate_of_the_local_frame_is_correct_on_a_short_path(span: float) -> None:
    """The orbital plane turns with the jerk of the path; differences were once formed beyond its ends."""
    times = np.linspace(0.0, span, 31)
    r, v = oo.Kepler(semi_major_axis=6.8e6).state(times)
    a = -oo.MU_EARTH * r / np.linalg.norm(r, axis=1)[:, None] ** 3
    r[:, 2], v[:, 2], a[:, 2] = 0.5 * times**3, 1.5 * times**2, 3.0 * times
    path = oo.CustomPath(times, r, velocities=v, accelerations=a)
    pose = np.eye(4)
    pose[:3, 3] = [1.0, 2.0, 0.5]
    hold = oo.Hold(pose, frame="lvlh")
    for t in np.array([0.3, 0.5, 0.7, 0.95]) * span:
        h = 1e-3 * span
        before, after = (hold.in_world(t + d, orbit=path)[1][3:] for d in (-h, h))
        found = hold.in_world(t, orbit=path)[2][3:]
        np.testing.assert_allclose(found, (after - before) / (2 * h), atol=2e-6)
