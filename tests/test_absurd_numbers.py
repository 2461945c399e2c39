"""Absurdly large or small numbers are rejected with the accepted range; they once became NaN or infinity."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from test_convert import ORBIT

import onorbit_rs as oo
from onorbit_rs.exceptions import (
    ControlError,
    ElementSetError,
    InputError,
    ModelError,
    OnOrbitError,
    OrbitError,
    PathError,
    ScenarioError,
)

LINK = (
    '<link name="{0}"><inertial><origin xyz="{x} 0 0"/><mass value="{m}"/>'
    '<inertia ixx="{i}" iyy="{i}" izz="{i}" ixy="0" ixz="0" iyz="0"/></inertial></link>'
)
JOINT = (
    '<joint name="j{0}" type="continuous"><origin xyz="{o} 0 0"/><axis xyz="0 0 {a}"/>'
    '<dynamics damping="{d}" friction="{f}"/><parent link="{p}"/><child link="{0}"/></joint>'
)


def robot(m: float = 1, i: float = 1, x: float = 0, **joint: float) -> oo.Model:
    values = {"o": 0.0, "a": 1.0, "d": 0.0, "f": 0.0} | joint
    links = LINK.format("base", m=1, i=1, x=0) + LINK.format("hand", m=m, i=i, x=x)
    return oo.Model.from_urdf_string(f"<robot>{links}{JOINT.format('hand', p='base', **values)}</robot>")


def path(velocity: float = 1.0, position: float = 1e7, **more: Any) -> oo.Orbit:
    velocities = np.array([[0.0, velocity, 0.0]] * 2)
    return oo.CustomPath([0.0, 1.0], [[7e6, 0, 0], [position, 0, 0]], velocities=velocities, **more)


def starting(x: float = 0.0, v: Any = None, **settings: float) -> oo.Simulation:
    model = robot()
    q = np.array(model.neutral())
    q[0] = x
    return oo.Simulation(model, q, np.zeros(7) if v is None else np.array(v, dtype=float), **settings)


def pose(x: float = 0.0) -> np.ndarray:
    made = np.eye(4)
    made[0, 3] = x
    return made


ABSURD: dict[str, tuple[Callable[[], object], type[OnOrbitError], tuple[str, ...]]] = {
    "mass": (lambda: robot(m=1e300), ModelError, ("hand", "1e300", "1e-20 kg to 1e20 kg")),
    "small mass": (lambda: robot(m=1e-300), ModelError, ("hand", "1e-300", "1e-20 kg to 1e20 kg")),
    "rigid body": (lambda: oo.Model.rigid_body(1e300, np.eye(3)), ModelError, ("base", "1e20 kg")),
    "inertia": (lambda: robot(i=1e300), ModelError, ("hand", "at most 1e40")),
    "centre of mass": (lambda: robot(x=1e300), ModelError, ("hand", "at most 1e12 m")),
    "joint origin": (lambda: robot(o=1e300), ModelError, ("jhand", "at most 1e12 m")),
    "axis": (lambda: robot(a=1e300), ModelError, ("jhand", "the axis")),
    "damping": (lambda: robot(d=1e300), ModelError, ("jhand", "damping", "1e20")),
    "friction": (lambda: robot(f=1e300), ModelError, ("jhand", "friction", "1e20")),
    "eccentricity": (
        lambda: oo.Kepler(semi_latus_rectum=7e6, eccentricity=1e300),
        OrbitError,
        ("eccentricity", "1e300", "between -1e60 and 1e60"),
    ),
    "large eccentricity": (
        lambda: oo.Kepler(semi_latus_rectum=7e6, eccentricity=1e21),
        OrbitError,
        ("eccentricity", "at most 1e20"),
    ),
    "semi-major axis": (lambda: oo.Kepler(semi_major_axis=1e300), OrbitError, ("semi-major axis", "1e60")),
    "mu": (lambda: oo.Kepler(semi_major_axis=7e6, mu=1e300), OrbitError, ("mu", "1e60")),
    "path velocity": (lambda: path(velocity=1e308), PathError, ("velocities[0]", "1e60")),
    "path position": (lambda: path(position=-1e308), PathError, ("positions[1]", "1e60")),
    "hold": (lambda: oo.Hold(pose(1e308)), ControlError, ("pose", "1e60")),
    "line": (lambda: oo.Line(pose(), pose(1e308), duration=1.0), ControlError, ("1e60",)),
    "short line": (lambda: oo.Line(pose(), pose(1.0), duration=1e-300), ControlError, ("1e-12",)),
    "joint hold": (lambda: oo.JointHold([1e308]), ControlError, ("q", "1e60")),
    "time step": (lambda: starting(time_step=1e-300), InputError, ("1e-300 s", "between 1e-12 and 1e9 s")),
    "angular velocity": (
        lambda: starting(v=[0, 0, 0, 1e200, 0, 0, 0]),
        InputError,
        ("v[3], the angular velocity of the base about x, is 1e200 rad/s", "below 1e9 rad/s"),
    ),
    "beyond the speed of light": (
        lambda: starting(v=[0, 4e8, 0, 0, 0, 0, 0]),
        InputError,
        ("v[1], the velocity of the base along y", "299792458 m/s, the speed of light"),
    ),
    "joint rate": (lambda: starting(v=[0] * 6 + [1e200]), InputError, ("joint 'jhand'", "1e9 rad/s")),
    "base position": (lambda: starting(x=1e300), InputError, ("q[0], the position of the base", "1e15 m")),
    "gain": (lambda: oo.JointComputedTorque(kp=1e308, kd=1.0), ControlError, ("kp", "1e20")),
    "gain of a PID": (lambda: oo.JointPid(p=[1.0, 1e308]), ControlError, ("p ", "1e20")),
    "stiffness": (
        lambda: oo.Compliance(oo.robots.load("humanoid_torso"), "tool", stiffness=1e308, damping=1.0),
        ControlError,
        ("stiffness", "1e20"),
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", ABSURD)
def test_an_absurd_number_is_rejected_with_the_accepted_range(name: str) -> None:
    make, error, words = ABSURD[name]
    with pytest.raises(error) as caught:
        make()
    assert all(word in str(caught.value) for word in words), str(caught.value)


def test_large_realistic_numbers_are_accepted() -> None:
    """Control: the ranges include asteroids, interstellar flybys and gravity of neutron stars."""
    assert robot(m=10.0, x=1e4, o=1e6, d=1e9, a=1e-3).mass == 11.0
    assert oo.Model.rigid_body(1e16, 1e24 * np.eye(3)).mass == 1e16
    assert np.isfinite(oo.Kepler(semi_latus_rectum=7e6, eccentricity=1e15).state(1.0)[0]).all()
    assert np.isfinite(oo.Kepler(semi_major_axis=1e16, eccentricity=0.2, mu=1e31).state(1.0)[1]).all()
    assert np.isfinite(path(velocity=3e8, position=1e20).state(0.5)[0]).all()
    oo.JointComputedTorque(kp=1e12, kd=1e6)


@pytest.mark.parametrize("gain", ["kp", "kd"])
def test_a_scenario_with_an_absurd_gain_is_rejected_by_name(gain: str) -> None:
    from onorbit_rs.scenario import load
    from onorbit_rs.scenario.build import build

    data = load("humanoid_reach").resolved()
    data["controller"][gain] = 1e308
    with pytest.raises(ControlError, match=rf"{gain} holds 1e308"):
        build(load(data))


def chain(joints: int) -> str:
    links = LINK.format("base", m=1, i=1, x=0) + "".join(
        LINK.format(f"l{k}", m=1, i=1, x=0)
        + JOINT.format(f"l{k}", p=f"l{k - 1}" if k else "base", o=0.1, a=1, d=0, f=0)
        for k in range(joints)
    )
    return f"<robot>{links}</robot>"


def test_a_robot_with_5000_joints_is_rejected_before_memory_is_allocated() -> None:
    with pytest.raises(ModelError, match="more than 2000 moving joints"):
        oo.Model.from_urdf_string(chain(5000))
    assert len(oo.Model.from_urdf_string(chain(200)).joint_names) == 200


@pytest.mark.parametrize("text", ["[" * 100_000, '{"a":' * 100_000, "<a>" * 100_000 + "</a>" * 100_000])
def test_an_omm_nested_100_000_levels_deep_is_rejected(text: str) -> None:
    with pytest.raises(ElementSetError, match=r"OMM|messages"):
        oo.Sgp4.from_omm(text)


@pytest.mark.parametrize(
    ("line", "other"),
    [("semi_major_axix: 7000", "semi_major_axix: -7000"), ("eccentricity: 0.001", "eccentricity: 1.5")],
)
def test_an_onorbitros_orbit_that_is_not_elliptic_is_rejected(line: str, other: str, tmp_path: Path) -> None:
    from onorbit_rs.tools.interop.onorbitros import convert

    file = tmp_path / "orbit.yaml"
    file.write_text(ORBIT.replace(line, other))
    with pytest.raises(ScenarioError, match="of an ellipse"):
        convert([file])
