"""Pickling of robots, effects, atmospheres, surfaces, references and laws, as required by multiprocessing."""

from __future__ import annotations

import pickle
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.exceptions import ModelError

EARTH = oo.Earth("2024-03-01T12:00:00 UTC")
BALL = oo.Cannonball(1.5, drag_coefficient=2.0, reflectivity=1.3)
AIR = oo.Nrlmsise00(f107=150, f107a=140, ap=[4, 5, 6, 7, 8, 9, 10])
EFFECTS: dict[str, Callable[[], oo.Effect]] = {
    "gravity gradient": oo.GravityGradient,
    "third body": lambda: oo.ThirdBody("moon"),
    "wrench": lambda: oo.BodyWrench("base", force=[0.1, 0, 0], torque=[0, 0.2, 0], start=3.0),
    "drag": lambda: oo.Drag(AIR, surfaces={"base": BALL}),
    "light": lambda: oo.RadiationPressure(surfaces=BALL, flux=1300.0, shadow=False),
    "faces": lambda: oo.Drag(
        oo.ConstantAtmosphere(1e-10),
        surfaces=oo.Plates([1.0, 2.0], [[1, 0, 0], [0, 1, 0]], [[0, 0, 0.1], [0, 0.2, 0]], specular=0.3),
    ),
    "field": lambda: oo.GravityField("egm2008", degree=4),
}


def back(thing: Any) -> Any:
    return pickle.loads(pickle.dumps(thing))


@pytest.mark.parametrize("name", EFFECTS)
def test_a_pickled_effect_acts_as_before(name: str) -> None:
    robot = oo.Model.rigid_body(10.0, np.diag([1.0, 2.0, 2.5]))
    orbit = oo.Kepler(semi_major_axis=6.7e6, inclination=0.9, mu=3.986004415e14)
    v = np.array([0, 0, 0, 0.01, 0.02, 0.03])

    def end(effect: oo.Effect) -> Any:
        simulation = oo.Simulation(
            robot, robot.neutral(), v, orbit=orbit, earth=EARTH, environment=[effect], time_step=1.0
        )
        return simulation.run(10.0).v[-1]

    effect = EFFECTS[name]()
    again = back(effect)
    assert type(again) is type(effect)
    np.testing.assert_array_equal(end(again), end(effect))
    bare = oo.Simulation(robot, robot.neutral(), v, orbit=orbit, time_step=1.0).run(10.0).v[-1]
    assert not np.array_equal(end(effect), bare)


@pytest.mark.parametrize(
    "air",
    [
        oo.ConstantAtmosphere(1e-12),
        oo.ExponentialAtmosphere(),
        oo.ExponentialAtmosphere(density=1e-11, altitude=4e5, scale_height=6e4),
        oo.HarrisPriester(exponent=6.0, lag=0.4),
        AIR,
    ],
)
def test_a_pickled_atmosphere_has_the_same_density(air: oo.Atmosphere) -> None:
    density = air.density(4.2e5, 0.3, 0.4, 100.0, earth=EARTH)
    assert back(air).density(4.2e5, 0.3, 0.4, 100.0, earth=EARTH) == density > 0


def test_pickled_robots_are_equal(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = """<robot name="one"><link name="base"><inertial><mass value="3"/>
    <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>"""
    (tmp_path / "one.urdf").write_text(text)
    monkeypatch.chdir(tmp_path)
    file = oo.Model.from_urdf("one.urdf")
    monkeypatch.chdir("/")  # a worker may have another working directory
    torso = oo.robots.load("humanoid_torso")
    for model in (file, oo.Model.from_urdf_string(text), torso, oo.Model.rigid_body(2.0, np.eye(3))):
        again = back(model)
        assert again.frame_names == model.frame_names
        np.testing.assert_array_equal(again.mass_matrix(again.neutral()), model.mass_matrix(model.neutral()))
    built = oo.ModelBuilder("built", base="base", mass=1.0, inertia=np.eye(3)).build()
    with pytest.raises(TypeError, match="link by link"):
        pickle.dumps(built)


def test_a_robot_whose_file_changed_is_not_unpickled(tmp_path: Path) -> None:
    file = tmp_path / "arm.urdf"
    file.write_text(oo.robots.path("humanoid_torso").read_text())
    model = oo.Model.from_urdf(file)
    sent = pickle.dumps(model)
    file.write_text(file.read_text().replace('rgba="0.', 'rgba="0.1'))  # colours do not change the robot
    pickle.loads(sent)
    file.write_text(file.read_text().replace('<mass value="', '<mass value="1'))
    with pytest.raises(ModelError, match=r"arm\.urdf no longer describes the pickled robot; undo") as caught:
        pickle.loads(sent)
    assert back(caught.value).path == str(file)
    with pytest.raises(ModelError, match="no longer describes the pickled robot"):
        pickle.dumps(model)  # nor is it pickled: a pool worker that fails to read it would end silently


def test_warnings_about_a_robot_are_issued_once() -> None:
    with pytest.warns(UserWarning, match="triangle"):
        odd = oo.Model.rigid_body(1.0, np.diag([5.0, 1.0, 1.0]))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert back(odd).warnings == odd.warnings != []


def test_surfaces_are_pickled_as_given() -> None:
    spread: dict[str, oo.Surface] = {"base": BALL}
    drag = oo.Drag(oo.ConstantAtmosphere(1e-12), surfaces=spread)
    spread["no such link"] = BALL
    robot = oo.Model.rigid_body(10.0, np.eye(3))
    orbit = oo.Kepler(semi_major_axis=7e6)
    oo.Simulation(robot, robot.neutral(), np.zeros(6), orbit=orbit, earth=EARTH, environment=[back(drag)])


POSES = np.stack([np.eye(4)] * 3)
POSES[1:, 0, 3] = 0.1, 0.3
TABLE = [[0.0, 0.1], [0.2, 0.0], [0.1, 0.3]]
TARGET = oo.Target(np.eye(4), velocity=[0.1, 0, 0], spin=[0, 0.1, 0])
REFERENCES: dict[str, Callable[[], oo.Reference | oo.JointReference]] = {
    "Hold": lambda: oo.Hold(POSES[1], frame="lvlh"),
    "Line": lambda: oo.Line(POSES[0], POSES[1], speed=0.1, angular_speed=1.0, frame=TARGET),
    "LineParabola": lambda: oo.LineParabola(
        POSES[0], displacement=[0.1, 0, 0], duration=2.0, height=[0, 0, 0.1]
    ),
    "Circle": lambda: oo.Circle(
        POSES[1], center=[0, 0, 0], axis=[0, 0, 1], angle=1.0, duration=3.0, turns=False
    ),
    "Screw": lambda: oo.Screw(
        POSES[1], center=[0, 0, 0], axis=[0, 0, 1], angle=1.0, advance=0.2, ramp=0.2, speed=0.1, frame="base"
    ),
    "Waypoints": lambda: oo.Waypoints(POSES, speed=0.2, acceleration=0.1, stops=False),
    "Sampled": lambda: oo.Sampled([0.0, 1.0, 2.0], POSES, velocities=np.zeros((3, 6))),
    "JointHold": lambda: oo.JointHold([0.1, 0.2]),
    "JointWaypoints": lambda: oo.JointWaypoints(TABLE, speed=[0.1, 0.2], stops=False),
    "one_by_one": lambda: oo.JointWaypoints.one_by_one([0.0, 0.1], [(1, 0.5), (0, 0.2)], speed=0.1),
    "JointSampled": lambda: oo.JointSampled([0.0, 1.0, 2.0], TABLE, rates=np.ones((3, 2))),
}


def samples(reference: Any) -> list[bytes]:
    return [
        part.tobytes() for part in reference.sample(np.linspace(-0.1, 1.2 * reference.duration + 0.1, 50))
    ]


@pytest.mark.parametrize("name", REFERENCES)
def test_a_pickled_reference_has_the_same_samples(name: str) -> None:
    reference = REFERENCES[name]()
    there = back(reference)
    assert type(there) is type(reference) and there.duration == reference.duration
    assert samples(there) == samples(reference)


def test_every_reference_is_among_them() -> None:
    bases = (oo.Reference, oo.JointReference)
    classes = {
        c.__name__
        for c in vars(oo).values()
        if isinstance(c, type) and issubclass(c, bases) and c not in bases
    }
    assert classes == set(REFERENCES) - {"one_by_one"}


def test_a_reference_is_pickled_as_it_was_given() -> None:
    end = POSES[1].copy()
    reference = oo.Line(POSES[0], end, duration=1.0)
    end[0, 3] = 7.0
    assert samples(back(reference)) == samples(reference)


class RateDamper:
    """A controller of the user, which is pickled by its attributes."""

    def __init__(self, gain: float) -> None:
        self.gain = gain

    def update(self, t: float, state: Any) -> Any:
        return -self.gain * np.asarray(state.v)[6 : 6 + len(state.joints)]


def laws(robot: oo.Model, q: Any) -> dict[str, tuple[Any, Any]]:
    """Returns every law with a reference."""
    start = robot.frame_pose(q, "tool")
    end = start.copy()
    end[:3, 3] += [0.02, -0.03, 0.01]
    line = oo.Line(start, end, duration=0.3)
    joints = oo.JointWaypoints([q[7:], q[7:] + 0.1], times=[0.0, 0.4])
    stiffness, gains = np.diag([30.0, 30, 30, 5, 5, 5]), np.linspace(4.0, 9.0, robot.nv - 6)
    return {
        "computed torque": (
            oo.ComputedTorque(robot, "tool", kp=[9.0] * 6, kd=6.0, damping=0.1, null_space_damping=0.5), line
        ),
        "compliance": (oo.Compliance(robot, "tool", stiffness=stiffness, damping=[20.0] * 3 + [1] * 3), line),
        "joints": (oo.JointComputedTorque(kp=gains, kd=5.0, compensate_friction=False), joints),
        "pid": (oo.JointPid(p=gains, i=0.3, d=4.0, i_limit=0.01, effort_limit=2.0), joints),
        "external": (oo.External(gains, 5.0, timeout=0.5, on_timeout="damp"), None),
        "user": (RateDamper(3.0), None),
    }  # fmt: skip


@pytest.mark.parametrize("law", ["computed torque", "compliance", "joints", "pid", "external", "user"])
def test_a_pickled_law_runs_to_the_same_bits(law: str) -> None:
    robot = oo.robots.load("servicer")
    q = robot.neutral()
    q[7:] = [0, 1.4260, 0, 1.3391, 0, -1.1943, 0]
    controller, reference = laws(robot, q)[law]
    goal = None if law in ("external", "user") else oo.Goal(tolerance=1e-9, path_tolerance=1.0, time=0.2)
    control = oo.Control(
        controller, reference=reference, joints=list(robot.joint_names), tool="tool", name="arm",
        start=0.05, end=0.45, goal=goal, starts_at_present=goal is not None,
    )  # fmt: skip
    system = oo.System("a", robot, q, np.full(robot.nv, 0.01), controller=[control], control_period=0.01)
    here = oo.World([system])
    there, again = back(here), back(back(here))
    traces = [oo.Simulation(world, time_step=5e-3).run(0.5) for world in (here, there, again)]
    for trace in traces[1:]:
        for column in ("q", "v", "tau"):
            assert getattr(trace, column).tobytes() == getattr(traces[0], column).tobytes(), column
        assert trace.results == traces[0].results
    assert np.abs(traces[0].tau).max() > 1e-3


def test_a_controller_that_cannot_be_pickled_names_itself() -> None:
    controller = RateDamper(1.0)
    controller.update = lambda t, state: np.zeros(7)  # type: ignore[method-assign]
    with pytest.raises((AttributeError, pickle.PicklingError, TypeError), match="lambda"):
        pickle.dumps(oo.Control(controller))
