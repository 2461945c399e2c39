"""Pickling of robots, effects, atmospheres and surfaces, as required by multiprocessing."""

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
    with pytest.raises(ModelError, match=r"arm\.urdf .* was changed; restore the file, or load") as caught:
        pickle.loads(sent)
    assert back(caught.value).path == str(file)
    with pytest.raises(ModelError, match="it includes was changed"):
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
