"""Negative controls for the orbits of GMAT, nyx and Curtis under radiation pressure.

The cases are in ``onorbit_rs.tools.validation.air_and_light`` and run in ``test_validation``.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from onorbit_rs.tools.validation import air_and_light as cases


@pytest.mark.parametrize(("name", "metres"), [("high circle", 1.0), ("ellipse", 10.0)])
def test_gmat_agrees_to_metres_and_another_reflectivity_is_detected(
    name: str, metres: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    (share,) = cases.from_gmat(name)
    assert share * cases.displacement(name) < metres
    monkeypatch.setattr(cases, "REFLECTIVITY", 1.81)
    assert cases.from_gmat(name)[0] > 3e-3


def test_356_eclipses_agree_with_nyx_and_not_with_gmat() -> None:
    # The displacement is 1.2 km, most of it having cancelled. GMAT's own end is 6 m off: its
    # script asks RungeKutta89 for 1e-11 of a step, and with steps of a minute across 710 edges of the shadow
    # an integration to that tolerance errs by metres (our DOP853 under the same control: 29 to 40 m, by
    # its first step; at 1e-14 it ends 0.3 m from here). nyx prints its elements to 1e-6 degrees: 0.2 m.
    orbit, displacement = cases.circle_or_ellipse("low circle"), cases.displacement("low circle")
    by_gmat = np.array(cases.GMAT["low circle"][1]) * 1e3
    assert cases.along_from_nyx(by_gmat) > 4e-3 * displacement  # GMAT from nyx
    # across the track, where errors of eclipse times do not accumulate, GMAT agrees
    end = cases.after_24_days(orbit)
    along = np.array([by_gmat[1], -by_gmat[0], 0.0]) / np.linalg.norm(by_gmat)
    off = end - by_gmat
    print(f"low circle: {np.linalg.norm(off):.3f} m from GMAT")
    assert np.linalg.norm(off) < 7.0
    assert np.linalg.norm(off - along * (along @ off)) < 0.05
    # without the shadow, and with a shadow one percent too wide
    settings: list[dict[str, Any]] = [{"shadow": False}, {"earth_radius": 1.01 * cases.RADIUS}]
    for setting in settings:
        assert cases.along_from_nyx(cases.after_24_days(orbit, **setting)) > 3e-3 * displacement


@pytest.mark.slow
def test_a_balloon_has_the_secular_changes_of_curtis() -> None:
    # changes of eccentricity, inclination, node and argument of perigee (degrees) after 200, 400 and 600
    # days, read off graphs by poliastro's authors, who ask for 100 % of each; the node's gate is 3 %
    read_off = np.array([[0.003, -0.008, -0.035, -80], [-0.0013, 0.01, -0.07, 8], [0.007, 0.03, -0.1, -80]])
    np.testing.assert_array_equal(read_off[:, 2], cases.BALLOON_NODE)
    changes = cases.balloon(600)
    print(changes)
    assert np.all(np.abs(changes - read_off) < np.abs(read_off))
    assert changes[:, 2] == pytest.approx(cases.BALLOON_NODE, rel=0.03)
