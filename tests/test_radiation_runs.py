"""Radiation pressure through the public ``Simulation``: GMAT's orbits of 24 days, Curtis' balloon."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo

MU = 3.986004415e14
RADIUS = 6_378_136.3  # GMAT's Earth
DAYS = 24 * 86_400.0
BODY = oo.Model.rigid_body(300.0, 100.0 * np.eye(3))
# GMAT, as published with nyx' tests: 300 kg, 16 m², 1367 W/m², epoch 2000-01-01T00:00:00 TAI; semi-major axis
# km, eccentricity, inclination degrees; position after 24 days, km. The reflectivity is not stated: 1.8 is
# GMAT's default.
GMAT = {
    "high circle": ((24396.0, 0.0, 0.0), (-10269.72958057943, -22135.59895717367, 0.008121155161511498)),
    "low circle": ((7000.0, 0.0, 0.0), (791.0288295053131, -6955.409986553813, -0.02614433515330551)),
    "ellipse": ((14000.0, 0.5, 20.0), (-10536.43092609598, -11023.53096010533, -4012.155888856515)),
}


def kepler(a_km: float, e: float, i_deg: float) -> oo.Kepler:
    return oo.Kepler(
        semi_major_axis=a_km * 1e3, eccentricity=e, inclination=np.radians(i_deg), raan=0.0,
        argument_of_periapsis=0.0, mean_anomaly=0.0, mu=MU,
    )  # fmt: skip


def after_24_days(orbit: oo.Orbit, reflectivity: float = 1.8, **settings: Any) -> Any:
    ball = oo.Cannonball(16.0, reflectivity=reflectivity)
    light = oo.RadiationPressure(surfaces=ball, flux=1367.0, **({"earth_radius": RADIUS} | settings))
    sim = oo.Simulation(
        BODY, BODY.neutral(), np.zeros(6), orbit=orbit, earth=oo.Earth("2000-01-01T00:00:00 TAI"),
        environment=[light], integrator="dormand_prince", tolerance=1e-11, time_step=86_400.0,
        rereference_beyond=np.inf,
    )  # fmt: skip
    return np.array(sim.run(DAYS).position_eci[-1])


@pytest.mark.parametrize(("name", "gate", "metres"), [("high circle", 1e-3, 1.0), ("ellipse", 1e-3, 10.0)])
def test_gmat_to_a_thousandth_of_what_light_does(name: str, gate: float, metres: float) -> None:
    elements, expected = GMAT[name]
    orbit, position = kepler(*elements), np.array(expected) * 1e3
    undisturbed, _ = orbit.state(DAYS)
    displacement = np.linalg.norm(position - undisturbed)
    error = np.linalg.norm(after_24_days(orbit) - position)
    print(f"{name}: {error:.3f} m of {displacement / 1e3:.1f} km, {error / displacement:.1e}")
    assert error < gate * displacement
    assert error < metres
    # another reflectivity would miss by more than the gate
    assert np.linalg.norm(after_24_days(orbit, 1.81) - position) > 3 * gate * displacement


def test_gmat_in_356_eclipses_to_what_its_publisher_reaches() -> None:
    # The displacement is 1.2 km, most of it having cancelled, and each eclipse ends in a penumbra: nyx
    # differs from GMAT by up to 7 m here. Ours differs by 6.3 m, along the track; RK4 at 1 s ends 0.2 m
    # from the adaptive pair.
    elements, expected = GMAT["low circle"]
    orbit, position = kepler(*elements), np.array(expected) * 1e3
    error = after_24_days(orbit) - position
    along = np.array([position[1], -position[0], 0.0]) / np.linalg.norm(position)
    assert np.linalg.norm(error) < 7.0
    assert np.linalg.norm(error - along * (along @ error)) < 0.05
    # without the shadow
    assert np.linalg.norm(after_24_days(orbit, shadow=False) - position) > 100.0


@pytest.mark.slow
def test_a_balloon_drifts_as_in_curtis() -> None:
    # Curtis, Orbital Mechanics for Engineering Students, 2013, example 12.9: changes of eccentricity,
    # inclination, node and argument of perigee (degrees) after 200, 400 and 600 days, read off graphs by
    # poliastro's authors, who ask for 100 % of each. The node, which does not oscillate, is asked to 3 %.
    # C_R A/m = 4 m²/kg, 4.56e-6 Pa.
    mu = 3.98600e14
    orbit = oo.Kepler(
        semi_major_axis=10_085.44e3, eccentricity=0.025422, inclination=np.radians(88.3924),
        raan=np.radians(45.38124), argument_of_periapsis=np.radians(227.493), mean_anomaly=np.radians(344.24),
        mu=mu,
    )  # fmt: skip
    body = oo.Model.rigid_body(100.0, np.eye(3))
    light = oo.RadiationPressure(
        surfaces=oo.Cannonball(200.0, reflectivity=2.0),
        flux=4.56e-6 * 299_792_458.0,
        earth_radius=6_378_000.0,
    )
    sim = oo.Simulation(
        body, body.neutral(), np.zeros(6), orbit=orbit, earth=oo.Earth("1964-01-01T00:00:00 TDB"),
        environment=[light], integrator="dormand_prince", tolerance=1e-9, time_step=200 * 86_400.0,
        rereference_beyond=np.inf,
    )  # fmt: skip
    trace = sim.run(600 * 86_400.0)
    r, v = np.array(trace.position_eci), np.array(trace.velocity_eci)
    h = np.cross(r, v)
    h_unit = h / np.linalg.norm(h, axis=1)[:, None]
    e = np.cross(v, h) / mu - r / np.linalg.norm(r, axis=1)[:, None]
    node = np.cross([0, 0, 1], h_unit)
    inclination, raan = np.degrees(np.arccos(h_unit[:, 2])), np.degrees(np.arctan2(node[:, 1], node[:, 0]))
    across = np.cross(h_unit, node)
    periapsis = np.degrees(np.arctan2(np.sum(e * across, axis=1), np.sum(e * node, axis=1)))
    elements = np.column_stack([np.linalg.norm(e, axis=1), inclination, raan, periapsis])
    changes = (elements - elements[0])[1:]
    changes[:, 3] = (changes[:, 3] + 180.0) % 360.0 - 180.0
    read_off = np.array([[0.003, -0.008, -0.035, -80], [-0.0013, 0.01, -0.07, 8], [0.007, 0.03, -0.1, -80]])
    print(changes)
    assert np.all(np.abs(changes - read_off) < np.abs(read_off))
    assert changes[:, 2] == pytest.approx(read_off[:, 2], rel=0.03)
