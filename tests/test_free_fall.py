"""A robot stays on a reference orbit integrated in its gravity; contradicting settings are rejected."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.exceptions import EarthError, GravityError, OrbitError

EPOCH, OTHER = "2024-03-20T00:00:00 UTC", "2024-03-20T06:00:00 UTC"
START = ([6.8e6, 0.0, 0.0], [0.0, 4e3, 6.5e3])
# a single body: gravity acts at its centre of mass
ROBOT = oo.Model.rigid_body(100.0, np.diag([5.0, 6.0, 7.0]))


def field(degree: int = 8) -> oo.GravityField:
    return oo.GravityField("egm2008", degree=degree)


def gravity() -> list[Any]:
    return [field(), oo.ThirdBody("moon"), oo.ThirdBody("sun")]


def run(orbit: oo.Orbit, earth: Any, environment: list[Any], mode: str = "true") -> oo.Trace:
    return oo.Simulation(
        ROBOT, ROBOT.neutral(), np.zeros(6), orbit=orbit, earth=earth, environment=environment,
        time_step=20.0, gravity_mode=mode,
    ).run(2000.0)  # fmt: skip


@pytest.mark.parametrize("mode", ["true", "carried"])
def test_a_robot_at_rest_on_its_reference_stays_there_to_the_last_bit(mode: str) -> None:
    orbit = oo.Numerical(*START, environment=gravity(), earth=oo.Earth(EPOCH))
    for earth, environment in ((oo.Earth(EPOCH), gravity()), (oo.Earth(EPOCH), gravity()[::-1]), (None, [])):
        trace = run(orbit, earth, environment, mode)
        assert np.abs(trace.q[:, :3]).max() == 0.0
        if mode == "carried":
            assert trace.reference_residual is not None
            assert np.abs(trace.reference_residual).max() == 0.0
    # negative control: an ellipse does not fall like the robot
    kepler = oo.Kepler.from_state(*START, mu=field().mu)
    assert np.abs(run(kepler, oo.Earth(EPOCH), gravity()).q[:, :3]).max() > 100.0


def test_a_run_that_contradicts_its_reference_is_rejected() -> None:
    earth = oo.Earth(EPOCH)
    orbit = oo.Numerical(*START, environment=gravity(), earth=earth)
    with pytest.raises(EarthError, match="give both the same epoch") as epochs:
        run(orbit, oo.Earth(OTHER), gravity())
    assert "06:00" in epochs.value.got
    with pytest.raises(EarthError, match="give both the same epoch"):
        run(orbit, oo.Earth(OTHER), [])
    moonlit = oo.Numerical(*START, environment=[oo.ThirdBody("moon")], earth=earth)
    with pytest.raises(EarthError, match="give both the same epoch"):
        run(moonlit, oo.Earth(OTHER), [])
    for changed, environment, what in (
        (earth, [field(7), *gravity()[1:]], "the planet's mu or field"),
        (earth, gravity()[:2], "the third bodies"),
        (oo.Earth(EPOCH, ut1_minus_utc=0.1), gravity(), "the Earth"),
        (oo.Earth(EPOCH, rotation="about_z"), gravity(), "the Earth"),
    ):
        with pytest.raises(GravityError, match=f"differ in {what}.* remove gravity from the run"):
            run(orbit, changed, environment)
    # a reference around a point mass may differ from the robot's fall, such as a Kepler orbit
    plain = oo.Numerical(*START, mu=field().mu)
    assert np.abs(run(plain, earth, gravity()).q[:, :3]).max() > 100.0


def test_the_reference_accepts_only_gravity() -> None:
    air = oo.Drag(oo.ConstantAtmosphere(1e-12), surfaces=oo.Cannonball(1.0, drag_coefficient=2.2))
    with pytest.raises(OrbitError, match=r"Drag, GravityGradient cannot act on it"):
        oo.Numerical(*START, environment=[field(), air, oo.GravityGradient()], earth=oo.Earth(EPOCH))
    from onorbit_rs.scenario.build import build

    inertia = [[1.0, 0, 0], [0, 2.0, 0], [0, 0, 2.5]]
    built = build(
        oo.Scenario(
            robot={"rigid_body": {"mass": 10.0, "inertia": inertia}},
            orbit={"kind": "numerical", "position": START[0], "velocity": START[1]},
            epoch=EPOCH,
            environment=[
                {"kind": "gravity_field", "model": "egm2008", "degree": 4},
                {"kind": "gravity_gradient"},
            ],
            simulation={"duration": "20 min", "time_step": "10 s"},
        )
    )
    assert np.abs(built.simulation.run(1200.0).q[:, :3]).max() == 0.0


def test_third_bodies_alone_imply_the_earth() -> None:
    earth = oo.Earth(EPOCH)
    orbit = oo.Numerical(*START, environment=[oo.ThirdBody("sun")], earth=earth)
    assert orbit.mu == oo.Numerical(*START).mu == 3.986004418e14
    apart = orbit.state(86400.0)[0] - oo.Numerical(*START).state(86400.0)[0]
    assert 1.0 < np.linalg.norm(apart) < 1e4
    with pytest.raises(OrbitError, match="mu is -1"):
        oo.Numerical(*START, environment=[oo.ThirdBody("sun")], earth=earth, mu=-1.0)


def test_the_time_at_which_an_orbit_meets_the_planet_is_reported() -> None:
    zonal = oo.GravityField.zonal(2)
    falls = oo.Numerical([6.8e6, 0, 0], [0.0, 7e3, 0.0], environment=[zonal])
    with pytest.raises(OrbitError, match=r"inside the planet at t = .* m from its centre") as caught:
        falls.state(86400.0)
    assert 0.0 < caught.value.time < 6000.0
    assert caught.value.expected == pytest.approx(0.996 * zonal.radius)
    falls.state(caught.value.time - 1.0)
    for environment in ([], [zonal]):
        with pytest.raises(OrbitError, match=r"begins inside the planet, 7000 m .* kilometres"):
            oo.Numerical([7000.0, 0, 0], [0.0, 7.5, 0.0], environment=environment)
    with pytest.raises(OrbitError, match="begins inside the planet, 6000000 m"):
        oo.Numerical([6e6, 0, 0], [0.0, 7.5e3, 0.0], environment=[zonal])


MU, RADIUS = 3.986004415e14, 6378136.3


def coefficients(**entries: float) -> oo.GravityField:
    """Returns coefficients of degree 3, such as ``c20=…``, with ``mu`` and ``radius``."""
    mu, radius = entries.pop("mu", MU), entries.pop("radius", RADIUS)
    arrays = {"c": np.zeros((4, 4)), "s": np.zeros((4, 4))}
    for name, value in ({"c20": -4.84e-4} | entries).items():
        arrays[name[0]][int(name[1]), int(name[2])] = value
    return oo.GravityField.from_coefficients(**arrays, mu=mu, radius=radius)


@pytest.mark.parametrize(
    ("entries", "message"),
    [
        ({"c20": -1.0826e-3}, "not fully normalised"),
        ({"c11": 1e-3}, "degree 1, order 1 is 0.001"),
        ({"s31": 0.7}, "truncated"),
        ({"c12": 1e-9}, r"c\[1, 2\] is .* this term does not exist"),
        ({"s20": 1e-9}, r"s\[2, 0\] is"),
        ({"mu": 398600.4415, "radius": 6378.1363}, "radius is 6378.14; .*kilometres"),
        ({"mu": 398600.4415}, "mu is 398600; .*kilometres"),
    ],
)
def test_coefficients_of_no_planet_are_rejected(entries: dict[str, float], message: str) -> None:
    coefficients(c11=1e-9, s33=1.4e-6)
    coefficients(mu=4.9028e12, radius=1.738e6, c20=-9e-5)  # the Moon
    with pytest.raises(GravityError, match=message):
        coefficients(**entries)


def test_a_file_truncated_inside_its_last_number_is_rejected(tmp_path: Path) -> None:
    file = tmp_path / "cut.gfc"
    head = f"product_type gravity_field\nearth_gravity_constant {MU}\nradius {RADIUS}\n"
    head += "max_degree 2\nerrors no\nend_of_head\n"
    whole = head + "gfc 2 0 -4.84e-04 0\ngfc 2 1 0 0\ngfc 2 2 2.4383e-06 -1.4003e-06"
    for left_out in range(5):
        file.write_text(whole[: len(whole) - left_out])
        if left_out == 0:
            oo.GravityField.from_gfc(file)
            continue
        with pytest.raises(GravityError, match=r"truncated|the row is"):
            oo.GravityField.from_gfc(file)


def test_ut1_stays_near_utc() -> None:
    for given in (
        {"ut1_minus_utc": 32.4},
        {"ut1_minus_utc": -7.7},
        {"eop": [[60388, 0, 0, 0], [60391, 0, 0, -7.7]]},
    ):
        with pytest.raises(EarthError, match=r"at most 0.9 s") as caught:
            oo.Earth(EPOCH, **given)  # type: ignore[arg-type]
        assert abs(caught.value.got) > 1.0
    oo.Earth(EPOCH, ut1_minus_utc=-0.9)
    oo.Earth("1965-01-01T00:00:00 TAI", ut1_minus_utc=-3.8)  # UT1 - TAI, since UTC did not exist
    oo.Earth("2050-06-15T00:00:00 TAI", ut1_minus_utc=-2.5)  # leap seconds of that time are unknown


def test_sun_and_moon_with_uniform_rotation_use_the_requested_axes() -> None:
    times = np.linspace(0.0, 86400.0, 5)
    for body in (oo.Earth.sun, oo.Earth.moon):
        given = {
            axes: body(oo.Earth(EPOCH, rotation="about_z", axes=axes), times) for axes in ("GCRF", "TEME")
        }
        for axes, seen in given.items():
            assert np.allclose(seen, body(oo.Earth(EPOCH, axes=axes), times), rtol=1e-9, atol=0.0)
        # a quarter of a century of precession
        apart = np.linalg.norm(given["TEME"] - given["GCRF"], axis=1) / np.linalg.norm(given["GCRF"], axis=1)
        assert np.all(np.degrees(apart) > 0.2)
    assert oo.Earth(EPOCH, rotation="about_z", axes="TEME").axes == "TEME"
    assert oo.Earth(rotation="about_z").axes is None
    orbit = oo.Numerical(*START, axes="TEME", environment=[oo.ThirdBody("sun")], earth=oo.Earth(EPOCH))
    even = oo.Numerical(
        *START, axes="TEME", environment=[oo.ThirdBody("sun")], earth=oo.Earth(EPOCH, rotation="about_z")
    )
    assert np.allclose(orbit.state(86400.0)[0], even.state(86400.0)[0], rtol=0, atol=1e-6)
