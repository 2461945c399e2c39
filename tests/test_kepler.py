"""Two-body motion from Python: scalars and arrays, and the local orbital frame.

Textbooks and GMAT are in ``onorbit_rs.tools.validation.kepler``.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo


def test_a_hyperbola_has_no_period() -> None:
    orbit = oo.Kepler.from_state([6678137.0, 0, 0], [0, 15000.0, 0], mu=3.986e14)
    assert orbit.semi_major_axis < 0 and orbit.eccentricity > 1 and orbit.period is None


ORBITS = {
    "circle": oo.Kepler(semi_major_axis=7e6),
    "ellipse": oo.Kepler(
        semi_major_axis=26.6e6, eccentricity=0.74, inclination=1.1, raan=2.0, mean_anomaly=3.0
    ),
    "near parabola": oo.Kepler(semi_latus_rectum=1.4e7, eccentricity=0.9999999, true_anomaly=-1.0),
    "parabola": oo.Kepler(semi_latus_rectum=1.4e7, eccentricity=1.0, inclination=0.3, periapsis_time=100.0),
    "hyperbola": oo.Kepler(semi_major_axis=-2e7, eccentricity=1.6, inclination=2.5, mean_anomaly=-1.0),
    "retrograde": oo.Kepler(semi_major_axis=8e6, eccentricity=0.1, inclination=np.pi),
}


@pytest.mark.parametrize("name", ORBITS)
def test_arrays_equal_their_scalars(name: str) -> None:
    orbit, times = ORBITS[name], np.linspace(-5000.0, 5000.0, 41)
    (r, v), (rot, rate) = orbit.state(times), orbit.lvlh(times)
    assert [x.shape for x in (r, v, rot, rate)] == [(41, 3), (41, 3), (41, 3, 3), (41, 3)]
    for k, t in enumerate(times):
        for one, many in zip((*orbit.state(t), *orbit.lvlh(t)), (r, v, rot, rate), strict=True):
            np.testing.assert_array_equal(one, many[k])
    for t in (3, np.float32(3), np.int64(3), np.array(3.0)):
        assert orbit.state(t)[0].shape == (3,)
    np.testing.assert_array_equal(orbit.state(range(3))[0], orbit.state([0.0, 1.0, 2.0])[0])
    assert orbit.state([])[0].shape == (0, 3) and orbit.lvlh([])[0].shape == (0, 3, 3)


@pytest.mark.parametrize("name", ORBITS)
def test_the_motion_satisfies_newtons_law(name: str) -> None:
    orbit, h = ORBITS[name], 0.5
    t = np.linspace(-3000.0, 3000.0, 25)
    (r, v), (_, before), (_, after) = orbit.state(t), orbit.state(t - h), orbit.state(t + h)
    ahead, behind = orbit.state(t + h)[0], orbit.state(t - h)[0]
    # central differences: h²/6 of the third derivative, some (n h)² ~ 1e-6 of the value, less far out
    np.testing.assert_allclose((ahead - behind) / (2 * h), v, rtol=0, atol=2e-7 * np.abs(v).max())
    pull = -oo.MU_EARTH * r / np.linalg.norm(r, axis=1, keepdims=True) ** 3
    np.testing.assert_allclose((after - before) / (2 * h), pull, rtol=0, atol=2e-6 * np.abs(pull).max())


@pytest.mark.parametrize("name", ORBITS)
def test_the_local_orbital_frame_by_differences(name: str) -> None:
    orbit, h = ORBITS[name], 0.1
    for t in (-2000.0, 0.0, 1234.5):
        r, v = orbit.state(t)
        rot, rate = orbit.lvlh(t)
        np.testing.assert_allclose(rot.T @ rot, np.eye(3), atol=1e-15)
        assert np.linalg.det(rot) == pytest.approx(1.0, abs=1e-14)
        np.testing.assert_allclose(rot[:, 0], r / np.linalg.norm(r), atol=1e-15)  # x radial outward
        momentum = np.cross(r, v)
        np.testing.assert_allclose(rot[:, 2], momentum / np.linalg.norm(momentum), atol=1e-14)
        assert rot[:, 1] @ v > 0  # y along track
        # Rᵀ dR/dt = [ω]×, ω in L axes; the difference is good to h² of ω³ and 1e-16 / h
        spin = rot.T @ (orbit.lvlh(t + h)[0] - orbit.lvlh(t - h)[0]) / (2 * h)
        differenced = np.array([spin[2, 1], spin[0, 2], spin[1, 0]])
        np.testing.assert_allclose(rate, differenced, rtol=0, atol=1e-6 * np.abs(rate).max() + 1e-14)
        assert rate[1] == 0.0 and abs(rate[0]) < 1e-15 * rate[2]  # two-body motion stays in its plane


def test_control_a_frame_that_points_down_is_rejected() -> None:
    orbit = ORBITS["ellipse"]
    r, _ = orbit.state(0.0)
    assert orbit.lvlh(0.0)[0][:, 2] @ r == pytest.approx(0.0, abs=1e-6)  # unlike NASA's frame with z down
    assert orbit.lvlh(0.0)[0][:, 0] @ r > 0


@pytest.mark.parametrize("name", ORBITS)
def test_elements_are_recovered_from_a_state(name: str) -> None:
    orbit = ORBITS[name]
    again = oo.Kepler.from_state(*orbit.state(0.0))
    assert again.semi_latus_rectum == pytest.approx(orbit.semi_latus_rectum, rel=1e-12)
    assert again.eccentricity == pytest.approx(orbit.eccentricity, abs=1e-12)
    assert again.inclination == pytest.approx(orbit.inclination, abs=1e-7)  # acos near 0 and pi
    for x, y in zip(again.state(777.0), orbit.state(777.0), strict=True):
        np.testing.assert_allclose(x, y, rtol=0, atol=1e-11 * np.abs(y).max())


def test_the_state_repeats_after_one_period() -> None:
    orbit = ORBITS["ellipse"]
    assert orbit.period == pytest.approx(2 * np.pi * np.sqrt(26.6e6**3 / oo.MU_EARTH), rel=1e-15)
    assert orbit.period is not None
    now, later = orbit.state(0.0), orbit.state(orbit.period)
    np.testing.assert_allclose(later[0], now[0], rtol=0, atol=1e-6)


def test_all_kinds_of_anomaly_define_the_same_orbit() -> None:
    by_mean: dict[str, Any] = {"semi_major_axis": 1e7, "eccentricity": 0.3, "mean_anomaly": 0.7}
    orbit = oo.Kepler(**by_mean)
    assert orbit.period is not None
    before = -0.7 / (2 * np.pi) * orbit.period
    other = oo.Kepler(semi_major_axis=1e7, eccentricity=0.3, periapsis_time=before)
    np.testing.assert_allclose(orbit.state(500.0)[0], other.state(500.0)[0], rtol=0, atol=1e-7)
    later = oo.Kepler(**by_mean, epoch=100.0)
    np.testing.assert_allclose(later.state(600.0)[0], orbit.state(500.0)[0], rtol=0, atol=1e-7)
    assert orbit.mean_anomaly == pytest.approx(0.7) and "Kepler" in repr(orbit)
