"""Systems that start on different orbits: motion against Kepler and Hill, element sets, bad input."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.exceptions import OrbitError, ScenarioError
from onorbit_rs.relative import hill_transition, to_lvlh, to_world
from onorbit_rs.scenario import WorldScenario, load
from onorbit_rs.scenario.build_world import BuiltWorld, build_world

ELEMENTS: dict[str, float] = {
    "semi_major_axis": 6878e3, "eccentricity": 0.001, "inclination": 0.9, "raan": 0.4,
    "argument_of_periapsis": 0.3, "true_anomaly": 1.0,
}  # fmt: skip
REFERENCE = oo.Kepler(**ELEMENTS)
BOX = oo.Model.rigid_body(40.0, np.diag([3.0, 4.0, 5.0]))

TLE = """1 25544U 98067A   24061.50000000  .00016717  00000-0  30270-3 0  9994
2 25544  51.6400 208.9163 0006317  69.9862  25.2906 15.50000000    18"""
LATER = TLE.replace("24061.50000000", "24061.51000000")  # 864 s later


def tle(text: str = TLE) -> oo.Sgp4:
    return oo.Sgp4(*text.splitlines(), check_checksum=False)


def deputy(**changes: float) -> oo.Kepler:
    return oo.Kepler(**ELEMENTS | {name: ELEMENTS[name] + change for name, change in changes.items()})


def test_the_state_is_the_difference_of_two_orbits() -> None:
    other = deputy(true_anomaly=1e-4, inclination=2e-5, semi_major_axis=120.0)
    for t in (0.0, 700.0):
        (r, v), (ref, ref_v) = other.state(t), REFERENCE.state(t)
        position, velocity = to_world(REFERENCE, other, t)
        np.testing.assert_allclose(position, r - ref, rtol=0, atol=2e-9)
        np.testing.assert_allclose(velocity, v - ref_v, rtol=0, atol=2e-12)
    zero = to_world(REFERENCE, REFERENCE)
    assert not np.any(zero[0]) and not np.any(zero[1])


def run(orbit: oo.Kepler, duration: float, reference: oo.Orbit = REFERENCE) -> tuple[Any, Any]:
    """Return time and position in W of a system on an orbit; its attitude differs from the axes of W."""
    q, v = BOX.neutral(), np.zeros(6)
    q[3:7] = [0.5, 0.5, 0.5, 0.5]
    rot_wb = BOX.frame_pose(q, "base")[:3, :3]
    q[:3], velocity = to_world(reference, orbit)
    v[:3] = rot_wb.T @ velocity
    world = oo.World([oo.System("one", BOX, q, v), oo.System("two", BOX, BOX.neutral(), np.zeros(6))],
                     orbit=reference)  # fmt: skip
    trace = oo.Simulation(world, time_step=5.0).run(duration)
    return trace["one"].time, trace["one"].q[:, :3]


@pytest.mark.parametrize("changes", [{"true_anomaly": 1e-3}, {"semi_major_axis": 2e3, "raan": 1e-3}])
def test_a_system_follows_its_orbit(changes: dict[str, float]) -> None:
    other = deputy(**changes)
    time, position = run(other, 6000.0)
    expected = np.array(other.state(time)[0]) - np.array(REFERENCE.state(time)[0])
    assert np.linalg.norm(expected[0]) > 1e3
    np.testing.assert_allclose(position, expected, rtol=0, atol=1e-6)  # 2.5e-7 measured, steps of 5 s
    # control: with the velocity in axes of W instead of those of the base, the error is kilometres
    q, v = BOX.neutral(), np.zeros(6)
    q[3:7] = [0.5, 0.5, 0.5, 0.5]
    q[:3], v[:3] = to_world(REFERENCE, other)
    world = oo.World([oo.System("one", BOX, q, v)], orbit=REFERENCE)
    wrong = oo.Simulation(world, time_step=5.0).run(600.0)
    assert np.linalg.norm(wrong.q[-1, :3] - expected[time == 600.0][0]) > 100.0


def test_small_separations_follow_hill() -> None:
    circle = oo.Kepler(semi_major_axis=7000e3, inclination=0.5)
    n = np.sqrt(circle.mu / 7000e3**3)
    duration = 2 * np.pi / n
    errors = []
    for size in (10.0, 100.0):
        # Hill ellipse: x = ½ρ sin, y = ρ cos; the same semi-major axis
        other = oo.Kepler(
            semi_major_axis=7000e3, eccentricity=size / 2 / 7000e3, inclination=0.5 + size / 7000e3
        )
        time, position = run(other, duration, circle)
        r, v = circle.state(time)
        rho, _ = to_lvlh(circle, time, np.asarray(r) + position, np.asarray(v))
        start = np.concatenate(to_lvlh(circle, 0.0, *other.state(0.0)))
        hill = np.array([hill_transition(n, t) @ start for t in time])[:, :3]
        errors.append(np.linalg.norm(rho - hill, axis=1).max())
        assert errors[-1] < 10 * size**2 / 7000e3, (size, errors[-1])
    assert 90 < errors[1] / errors[0] < 110, errors  # the neglected terms grow as ρ²/r


def test_element_sets_are_evaluated_at_the_same_instant() -> None:
    first, later = tle(), tle(LATER)
    position, velocity = to_world(first, later, 1000.0)
    np.testing.assert_allclose(
        position, np.array(later.state(1000.0 - 864.0)[0]) - np.array(first.state(1000.0)[0]), atol=1e-6
    )
    # the velocity is the derivative of the position, from which SGP4's velocity differs
    h = 0.5
    before, after = (to_world(first, later, 1000.0 + dt)[0] for dt in (-h, h))
    np.testing.assert_allclose(velocity, (np.array(after) - np.array(before)) / (2 * h), atol=1e-4)
    with pytest.raises(OrbitError, match=r"epoch of the orbit is 2024-03-01T12:00:00.*give 'earth'"):
        to_world(REFERENCE, first)


def test_axes_are_converted_with_the_earth() -> None:
    earth = oo.Earth("2024-03-01T12:00:00 UTC")
    position, _ = to_world(REFERENCE, tle(), earth=earth)
    r = np.array(tle().state(0.0)[0])
    naive = r - np.array(REFERENCE.state(0.0)[0])
    turned = np.linalg.norm(position - naive)
    assert 10e3 < turned < 40e3  # 0.3 degrees of precession since 2000
    in_teme = oo.Earth("2024-03-01T12:00:00 UTC", axes="TEME").rotation(0.0) @ r
    same = earth.rotation(0.0) @ (position + np.array(REFERENCE.state(0.0)[0]))
    np.testing.assert_allclose(same, in_teme, atol=1e-6)


def test_orbits_around_other_planets_are_refused() -> None:
    with pytest.raises(OrbitError, match=r"mu of the orbit is 4.28e13"):
        to_world(REFERENCE, oo.Kepler(semi_major_axis=6878e3, mu=4.28e13))


YAML = """\
orbit: {semi_major_axis: 6878 km, inclination: 51 deg}
systems:
  chief:
    robot: {rigid_body: {mass: 40 kg, inertia: [3, 4, 5]}}
  deputy:
    robot: {rigid_body: {mass: 40 kg, inertia: [3, 4, 5]}}
    orbit: {semi_major_axis: 6878 km, inclination: 51 deg, true_anomaly: 0.01 deg}
    initial: {frame: lvlh, attitude: {roll_pitch_yaw: [0, 0, 90 deg]}, angular_velocity: [0, 0, 1 deg/s]}
simulation: {duration: 10 s, time_step: 1 s}
"""


def built(tmp_path: Any, text: str) -> BuiltWorld:
    file = tmp_path / "two.yaml"
    file.write_text(text)
    scenario = load(file)
    assert isinstance(scenario, WorldScenario)
    return build_world(scenario)


def test_a_scenario_starts_a_system_on_its_orbit(tmp_path: Any) -> None:
    world = built(tmp_path, YAML)
    orbit, one = world.orbit, world.systems["deputy"]
    own = oo.Kepler(semi_major_axis=6878e3, inclination=np.radians(51), true_anomaly=np.radians(0.01))
    assert orbit is not None
    position, velocity = to_world(orbit, own)
    np.testing.assert_array_equal(one.q[:3], position)
    rot_wb = BOX.frame_pose(one.q, "base")[:3, :3]
    np.testing.assert_allclose(rot_wb @ one.v[:3], velocity, atol=1e-12)
    # attitude and angular velocity are those of `initial`, relative to L of the reference
    rot_il, rate = orbit.lvlh(0.0)
    np.testing.assert_allclose(rot_wb, rot_il @ [[0, -1, 0], [1, 0, 0], [0, 0, 1]], atol=1e-12)
    np.testing.assert_allclose(one.v[3:], [0, 0, np.radians(1.0) + rate[2]], atol=1e-12)


def test_a_scenario_starts_a_system_on_an_element_set(tmp_path: Any) -> None:
    lines = "".join(f"        {line}\n" for line in LATER.splitlines())
    start = f"orbit:\n      kind: sgp4\n      check_checksum: false\n      tle: |\n{lines}"
    text = YAML.replace(
        "orbit: {semi_major_axis: 6878 km, inclination: 51 deg, true_anomaly: 0.01 deg}\n", start
    )
    text = "epoch: 2024-03-01T12:14:24 UTC\n" + text
    with pytest.warns(UserWarning, match=r"system 'deputy' starts .* m from the reference orbit.*e-9 m"):
        world = built(tmp_path, text)
    assert world.orbit is not None
    expected = to_world(world.orbit, tle(LATER), earth=world.earth)[0]
    np.testing.assert_array_equal(world.systems["deputy"].q[:3], expected)


INVALID = {
    "position": (
        "initial: {frame",
        "initial: {position: [1, 2, 3], frame",
        r":8: systems.deputy.initial.position: 'orbit' defines",
    ),
    "velocity": (
        "initial: {frame",
        "initial: {linear_velocity: [1, 2, 3], frame",
        r":8: systems.deputy.initial.linear_velocity: .*omit 'linear_velocity'",
    ),
    "no reference": (
        "orbit: {semi_major_axis: 6878 km, inclination: 51 deg}\n",
        "",
        r":6: systems.deputy.orbit: .*requires the reference",
    ),
    "kind": ("true_anomaly: 0.01 deg}", "kind: fixed_frame}", r":7: systems.deputy.orbit.*fixed_frame"),
    "key": ("true_anomaly", "true_anomly", r":7: systems.deputy.orbit.true_anomly: .*'true_anomaly'"),
    "planet": ("0.01 deg}", "0.01 deg, mu: 4.28e13}", r":7: systems.deputy.orbit: mu of the orbit is"),
}


@pytest.mark.parametrize("case", INVALID)
def test_invalid_starts_name_file_line_and_key(case: str, tmp_path: Any) -> None:
    old, new, message = INVALID[case]
    assert old in YAML
    with pytest.raises((ScenarioError, OrbitError), match=r"two\.yaml" + message):
        built(tmp_path, YAML.replace(old, new, 1))


def far(distance: float, *events: Any, beyond: float = 1e5) -> oo.World:
    q = BOX.neutral()
    q[1] = distance
    systems = [oo.System("near", BOX, BOX.neutral(), np.zeros(6)), oo.System("far", BOX, q, np.zeros(6)),
               oo.System("other", BOX, BOX.neutral(), np.zeros(6))]  # fmt: skip
    return oo.World(systems, orbit=REFERENCE, events=events, rereference_beyond=beyond)


@pytest.mark.filterwarnings("error")
def test_only_systems_that_lose_digits_give_a_warning() -> None:
    grasp = oo.Capture("grasp", "near/base", "far/base", on_command=True)
    apart = oo.Capture("grasp", "near/base", "other/base", on_command=True)
    for silent in ((4.4e6,), (9e4, grasp), (2e5, apart)):
        far(*silent)
    with pytest.raises(UserWarning, match=r"'far' starts 4600000 m .* resolved to 1.0\d*e-9 m; use"):
        far(4.6e6)
    with pytest.raises(
        UserWarning, match=r"'far' starts 200000 m .* systems that may interact keep this reference orbit"
    ):
        far(2e5, grasp)
