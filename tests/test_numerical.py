"""Numerically integrated orbits through Python: fields, other orbits, scenarios, pickling."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.exceptions import OrbitError, ScenarioError
from onorbit_rs.visuals.earth_shape import is_earth

# Lobatto collocation with 16 nodes in numpy's longdouble, 160 steps a day; start: GMAT's case leo_1day
R0, V0 = np.array([-2436450.0, -2436450.0, 6891037.0]), np.array([5088.611, -5088.611, 0.0])
MU, RADIUS, J2 = 3.986004415e14, 6378136.3, 1.0826355e-3
END = np.array([-5751472.01891163, 4721180.09890137, 2046029.54898335])


def flattened() -> oo.GravityField:
    return oo.GravityField.zonal(j=[J2], mu=MU, radius=RADIUS)


def test_a_day_under_j2_agrees_with_extended_precision() -> None:
    orbit = oo.Numerical(R0, V0, environment=[flattened()])
    assert np.linalg.norm(orbit.state(86400.0)[0] - END) < 3e-6
    assert orbit.mu == MU
    # negative control: without J2 the error is hundreds of kilometres
    assert np.linalg.norm(oo.Numerical(R0, V0, mu=MU).state(86400.0)[0] - END) > 1e5


def test_an_integrated_orbit_can_start_from_any_orbit() -> None:
    kepler = oo.Kepler.from_state(R0, V0, mu=MU)
    orbit = oo.Numerical.from_orbit(kepler)
    assert np.allclose(orbit.state(5e4)[0], kepler.state(5e4)[0], rtol=0, atol=1e-5)
    later = oo.Numerical.from_orbit(
        oo.Numerical(R0, V0, environment=[flattened()]), t0=4e4, environment=[flattened()]
    )
    assert np.linalg.norm(later.state(86400.0)[0] - END) < 1e-5
    line1 = "1 06251U 62025E   06176.82412014  .00008885  00000-0  12808-3 0  3985"
    line2 = "2 06251  58.0579  54.0425 0030035 139.1568 221.1854 15.56387291  6774"
    assert oo.Numerical.from_orbit(oo.Sgp4(line1, line2)).axes == "TEME"


def test_an_integrated_orbit_can_be_pickled() -> None:
    orbit = oo.Numerical(R0, V0, t0=3.0, environment=[flattened()], axes="TEME")
    back = pickle.loads(pickle.dumps(orbit))
    assert np.array_equal(back.state(1000.0)[0], orbit.state(1000.0)[0])
    assert back.axes == "TEME"


def test_an_orbit_that_meets_the_earth_is_reported_with_its_time() -> None:
    orbit = oo.Numerical([7e6, 0.0, 0.0], [0.0, 3e3, 0.0])
    with pytest.raises(OrbitError, match="inside the planet at t = ") as caught:
        orbit.state(86400.0)
    assert 0.0 < caught.value.time < 2000.0
    orbit.state(caught.value.time - 1.0)
    with pytest.raises(OrbitError, match="mu is -1"):
        oo.Numerical(R0, V0, mu=-1.0)


SCENARIO = {
    "robot": {"rigid_body": {"mass": 10.0, "inertia": [[1.0, 0, 0], [0, 2.0, 0], [0, 0, 2.5]]}},
    "simulation": {"duration": "20 min", "time_step": "10 s"},
}


def test_a_scenario_uses_an_integrated_orbit() -> None:
    from onorbit_rs.scenario.build import build

    orbit = {"kind": "numerical", "position": [*R0], "velocity": [*V0]}
    built = build(oo.Scenario(**SCENARIO, orbit=orbit))
    assert isinstance(built.orbit, oo.Numerical)
    trace = built.simulation.run(1200.0)
    free = oo.Kepler.from_state(R0, V0).state(trace.time)[0]
    # the robot falls with its reference: they differ by rounding only
    assert np.allclose(trace.position_eci, free, rtol=0, atol=1e-5)
    with pytest.raises(ScenarioError, match="secular_j2"):
        oo.Scenario(**SCENARIO, orbit=orbit | {"secular_j2": True})


@pytest.mark.parametrize("share", [0.9899, 0.9901, 0.999, 4e14 / oo.MU_EARTH, 1.0, 1.0099, 1.0101])
def test_figures_and_engine_use_the_same_earth_radius(share: float) -> None:
    """A point 6000 km from the centre of the Earth is below ground; other planets have no known radius."""
    mu = share * oo.MU_EARTH
    is_ground = False
    try:
        oo.Numerical([6e6, 0.0, 0.0], [0.0, 8e3, 0.0], mu=mu)
    except OrbitError:
        is_ground = True
    assert is_ground == is_earth(mu) == (abs(share - 1.0) < 0.01)


def test_secular_rates_are_an_option_of_kepler() -> None:
    # Curtis, example 12.2: -0.172 and 0.282 deg/h
    r, v = np.array([-2384.46e3, 5729.01e3, 3050.46e3]), np.array([-7361.38, -2989.97, 1643.54])
    orbit = oo.Kepler.from_state(r, v, mu=3.986e14, secular_j2=True)
    assert orbit.secular_j2
    period = orbit.period
    assert period is not None

    def node(t: float) -> float:
        h = np.cross(*orbit.state(t))
        return float(np.degrees(np.arctan2(h[0], -h[1])))

    hours = 50 * period / 3600.0
    assert (node(50 * period) - node(0.0)) / hours == pytest.approx(-0.172, rel=0.01)
    again = pickle.loads(pickle.dumps(orbit))
    assert np.array_equal(again.state(1e4)[0], orbit.state(1e4)[0])
    plain = oo.Kepler.from_state(r, v, mu=3.986e14)
    assert np.linalg.norm(plain.state(1e5)[0] - orbit.state(1e5)[0]) > 1e4
    with pytest.raises(OrbitError, match="eccentricity is 2"):
        oo.Kepler(semi_major_axis=-7e6, eccentricity=2.0, secular_j2=True)
    with pytest.raises(ScenarioError, match="secular_j2: true"):
        oo.Scenario(**SCENARIO, orbit={"semi_major_axis": "7000 km", "j2": 1e-3})
    from onorbit_rs.scenario.build import build

    built = build(oo.Scenario(**SCENARIO, orbit={"semi_major_axis": "7000 km", "secular_j2": True}))
    assert isinstance(built.orbit, oo.Kepler)
    assert built.orbit.secular_j2
