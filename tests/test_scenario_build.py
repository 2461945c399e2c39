"""Building the engine's objects from a scenario: values in SI, and errors of the engine."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.exceptions import (
    FrameError,
    ModelError,
    NotFoundError,
    OnOrbitError,
    OrbitError,
    ReadError,
    ScenarioError,
    ShapeError,
)
from onorbit_rs.scenario import load
from onorbit_rs.scenario.build import Built, build

ANGLES = {"inclination": "51.6 deg", "raan": "30 deg", "argument_of_periapsis": "40 deg"}


def scenario(**parts: Any) -> dict[str, Any]:
    body = {"rigid_body": {"mass": 10.0, "inertia": [1.0, 2.0, 2.5]}}
    return {"robot": body, "simulation": {"duration": 1.0, "time_step": 0.01}} | parts


def built(**parts: Any) -> Built:
    return build(load(scenario(**parts)))


def orbit(**elements: Any) -> oo.Kepler:
    made = built(orbit={"kind": "kepler"} | elements).orbit
    assert made is not None
    return made


def test_elements_reach_the_orbit_in_si() -> None:
    made = orbit(semi_major_axis="7000 km", eccentricity=0.1, mean_anomaly="60 deg", **ANGLES)
    expected = oo.Kepler(
        semi_major_axis=7e6, eccentricity=0.1, inclination=np.radians(51.6), raan=np.radians(30.0),
        argument_of_periapsis=np.radians(40.0), mean_anomaly=np.radians(60.0),
    )  # fmt: skip
    for got, want in zip(made.state(123.0), expected.state(123.0), strict=True):
        np.testing.assert_allclose(got, want, rtol=1e-14)


@pytest.mark.parametrize("phase", ["mean_anomaly", "true_anomaly", "periapsis_time"])
@pytest.mark.parametrize(
    "size",
    [
        {"semi_major_axis": "7200 km", "eccentricity": 0.1},
        {"semi_latus_rectum": "7200 km", "eccentricity": 0.1},
        {"semi_major_axis": "-7200 km", "eccentricity": 2.1},
    ],
)
def test_every_form_of_elements_can_be_built(size: dict[str, Any], phase: str) -> None:
    position, velocity = orbit(**size, **ANGLES, **{phase: 0.2}).state(0.0)
    assert np.all(np.isfinite(position)) and np.all(np.isfinite(velocity))
    again = orbit(position=list(position), velocity=list(velocity))
    for got, want in zip(again.state(60.0), orbit(**size, **ANGLES, **{phase: 0.2}).state(60.0), strict=True):
        np.testing.assert_allclose(got, want, rtol=1e-10)  # rounding of the conversion to elements and back


def test_a_parabola_is_built_from_its_semi_latus_rectum() -> None:
    position, velocity = orbit(semi_latus_rectum="14000 km", eccentricity=1, periapsis_time=0).state(0.0)
    escape = np.sqrt(2.0 * oo.MU_EARTH / np.linalg.norm(position))
    assert np.linalg.norm(velocity) == pytest.approx(escape, rel=1e-12)


def test_a_base_at_rest_in_the_local_orbital_frame_rotates_with_it() -> None:
    made = built(
        orbit={"kind": "kepler", "semi_major_axis": "7000 km", **ANGLES},
        initial={"frame": "lvlh", "position": [0, 2, 0], "attitude": {"roll_pitch_yaw": [0, 0, "90 deg"]}},
    )
    assert made.orbit is not None
    rot_il, rate = made.orbit.lvlh(0.0)
    np.testing.assert_allclose(made.q[:3], rot_il @ [0, 2, 0], atol=1e-14)
    np.testing.assert_allclose(made.v[3:6], rate, atol=1e-18)  # the yaw axis is the axis of the rate
    # A point 2 m along track in a frame rotating at n about z moves at -2 n along x: body y after the yaw.
    np.testing.assert_allclose(made.v[:3], [0.0, 2.0 * rate[2], 0.0], atol=1e-17)


def test_joints_by_name_equal_joints_in_order() -> None:
    by_list = load("humanoid_reach")
    names = oo.robots.load("humanoid_torso").joint_names
    data = by_list.resolved()
    data["initial"]["joints"] = dict(reversed(list(zip(names, data["initial"]["joints"], strict=True))))
    data["initial"]["joint_rates"] = {names[2]: "10 deg/s"}
    made = build(load(data))
    np.testing.assert_array_equal(made.q, build(by_list).q)
    assert made.v[8] == pytest.approx(np.radians(10.0)) and np.count_nonzero(made.v) == 1


def test_a_timed_wrench_gives_its_impulse() -> None:
    wrench = {"kind": "body_wrench", "body": "base", "force": ["2 N", 0, 0], "start": "0.2 s", "end": "0.7 s"}
    trace = oo.run(scenario(environment=[wrench]), quiet=True).trace
    np.testing.assert_allclose(trace.momentum[-1, :3], [1.0, 0.0, 0.0], atol=1e-12)


def test_gains_as_number_list_or_matrix_are_equivalent() -> None:
    data = load("humanoid_reach").resolved()
    data["simulation"] |= {"duration": 0.05}
    traces = []
    for shape in (1.0, [1.0] * 6, np.eye(6).tolist()):
        gains = {"kp": (90.0 * np.array(shape)).tolist(), "kd": (15.0 * np.array(shape)).tolist()}
        data["controller"] |= gains
        traces.append(oo.run(data, quiet=True).trace)
    for other in traces[1:]:
        np.testing.assert_array_equal(other.tau, traces[0].tau)


@pytest.mark.parametrize(
    ("right", "wrong", "error", "place"),
    [
        ("tool: tool ", "tool: toll ", FrameError, "tool"),
        ("robot: humanoid_torso", "robot: nobody.urdf", NotFoundError, "robot"),
        ("robot: humanoid_torso", "robot: ./folder.urdf", ReadError, "robot"),
        ("robot: humanoid_torso", "robot: ./junk.urdf", ModelError, "robot"),
        ("robot: humanoid_torso", "robot: nobody", NotFoundError, "robot"),
        ("joints: [0.5342, ", "joints: [", ShapeError, "initial"),
        ("joints: [", "joints: {arm_joint_9: 1} # [", FrameError, "initial"),
        ("51.6 deg", "200 deg", OrbitError, "orbit"),
        ("- kind: gravity_gradient", "- {kind: body_wrench, body: nose}", FrameError, "environment[0]"),
    ],
)
def test_errors_of_the_engine_keep_their_class_and_gain_a_place(
    tmp_path: Path, right: str, wrong: str, error: type[OnOrbitError], place: str
) -> None:
    (tmp_path / "folder.urdf").mkdir()
    (tmp_path / "junk.urdf").write_text("not xml")
    text = oo.scenarios.path("humanoid_reach").read_text()
    assert right in text
    file = tmp_path / "mine.yaml"
    file.write_text(text.replace(right, wrong))
    with pytest.raises(error) as caught:
        build(load(file))
    line = load(file).line_of(*(("environment", 0) if "[" in place else (place,)))
    assert str(caught.value).startswith(f"{file}:{line}: {place}: ")


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"controller": "computed_torqe"}, "did you mean 'computed_torque'"),
        ({"orbit": "keppler"}, "did you mean 'kepler'"),
        ({"robot": 3}, "must be a bundled name"),
    ],
)
def test_a_scenario_made_in_python_has_the_same_errors(change: dict[str, Any], says: str) -> None:
    data: dict[str, Any] = {"robot": "humanoid_torso", "simulation": {"duration": "1 s"}} | change
    with pytest.raises(ScenarioError, match=says):
        oo.Scenario(**data)
    with pytest.raises(ScenarioError, match=says):
        load(data)


def test_the_resolved_scenario_contains_all_defaults() -> None:
    data = oo.Scenario(
        robot="humanoid_torso", tool="tool", orbit={"semi_major_axis": "6778 km"},
        controller="computed_torque", simulation={"duration": "1 s"},
    ).resolved()  # fmt: skip
    assert data["orbit"]["mu"] == oo.MU_EARTH and data["orbit"]["true_anomaly"] == 0.0
    assert {"damping", "null_space_damping", "compensate_environment", "compensate_friction"} <= set(
        data["controller"]
    )
    assert data["reference"] == {"kind": "hold", "frame": "world"}


def test_metres_on_a_revolute_joint_are_rejected() -> None:
    data: dict[str, Any] = {"robot": "humanoid_torso", "simulation": {"duration": "1 s"}}
    joint = oo.robots.load("humanoid_torso").joint_names[0]
    for wrong in (
        {"joints": {joint: "30 m"}},
        {"joint_rates": {joint: "1 m/s"}},
        {"joints": ["30 m", *[0] * 6]},
    ):
        with pytest.raises(OnOrbitError, match=f"{joint} is revolute; give an ang"):
            build(load(data | {"initial": wrong}))
    built = build(load(data | {"initial": {"joints": {joint: "30 deg"}}}))
    assert built.q[7] == pytest.approx(np.pi / 6)
