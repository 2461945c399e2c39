"""Relative motion through Python; its physics is tested in Rust."""

from __future__ import annotations

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs import relative
from onorbit_rs.exceptions import InputError, OrbitError, ShapeError

CHIEF = oo.Kepler(semi_major_axis=7e6, eccentricity=0.01, inclination=0.9, raan=0.2, mean_anomaly=0.4)
DEPUTY = oo.Kepler(
    semi_major_axis=7e6, eccentricity=0.0101, inclination=0.9001, raan=0.2, mean_anomaly=0.4001
)


def test_transition_matrices_accept_arrays_of_times() -> None:
    # for Vallado's numbers see onorbit_rs.tools.validation.relative
    n = 1e-3
    both = relative.hill_transition(n, [0.0, 300.0])
    assert both.shape == (2, 6, 6)
    assert np.array_equal(both[0], np.eye(6))
    assert np.array_equal(both[1], relative.hill_transition(n, 300.0))
    with pytest.raises(OrbitError, match="no impulse"):
        relative.intercept_velocity(n, [1.0, 0, 0], np.pi / n)


@pytest.mark.parametrize("frame", ["lvlh", "nadir"])
def test_local_coordinates_are_inverted(frame: str) -> None:
    t = np.linspace(0.0, 6000.0, 11)
    r, v = DEPUTY.state(t)
    local = relative.to_lvlh(CHIEF, t, r, v, frame=frame)
    back = relative.from_lvlh(CHIEF, t, *local, frame=frame)
    assert np.allclose(back[0], r, rtol=1e-12, atol=1e-5)
    assert np.allclose(back[1], v, rtol=1e-12, atol=1e-8)
    one = relative.to_lvlh(CHIEF, t[3], r[3], v[3], frame=frame)
    assert np.array_equal(one[0], local[0][3])
    # the frame of the orbit
    rotation, _ = CHIEF.lvlh(t[3])
    across = 2 if frame == "lvlh" else 1
    expected = rotation.T @ (r[3] - CHIEF.state(t[3])[0])
    assert abs(one[0][across]) == pytest.approx(abs(expected[2]))


def test_relative_elements_are_inverted() -> None:
    t = np.linspace(0.0, 6000.0, 11)
    chief, deputy = CHIEF.state(t), DEPUTY.state(t)
    elements = relative.relative_elements(*chief, *deputy)
    assert elements.shape == (11, 6)
    # both remain on Kepler orbits of the same period
    assert np.ptp(elements, axis=0).max() < 1e-12
    r, v = relative.deputy_state(*chief, elements)
    assert np.allclose(r, deputy[0], rtol=0, atol=1e-5)
    assert np.allclose(v, deputy[1], rtol=0, atol=1e-8)
    assert relative.relative_elements(chief[0][0], chief[1][0], deputy[0][0], deputy[1][0]).shape == (6,)


def test_invalid_input_is_rejected() -> None:
    with pytest.raises(InputError, match="'lvlh' and 'nadir'"):
        relative.to_lvlh(CHIEF, 0.0, [0, 0, 0], [0, 0, 0], frame="rsw")
    with pytest.raises(ShapeError, match="r has shape"):
        relative.to_lvlh(CHIEF, [0.0, 1.0], [0.0, 0, 0], [0.0, 0, 0])
    flat = oo.Kepler(semi_major_axis=7e6).state(0.0)
    with pytest.raises(OrbitError, match="equator"):
        relative.relative_elements(*flat, *flat)
