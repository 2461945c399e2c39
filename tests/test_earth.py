"""The rotating Earth in Python: epochs, shapes, kernels, scenarios, invalid input."""

from __future__ import annotations

import pickle
import struct
import sys
from datetime import UTC, datetime, timedelta, timezone
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

import onorbit_rs as oo
from onorbit_rs.exceptions import EarthError, EffectError, NotFoundError, OrbitError, ReadError, ScenarioError
from onorbit_rs.scenario import load
from onorbit_rs.scenario.build import build

NOON = "2024-03-01T12:00:00 UTC"
BODY = oo.Model.rigid_body(100.0, np.diag([1.0, 2.0, 3.0]))
TLE = (
    "1 25544U 98067A   08264.51782528 -.00002182  00000-0 -11606-4 0  2927",
    "2 25544  51.6416 247.4627 0006703 130.5360 325.0288 15.72125391563537",
)


def simulation(**keywords: Any) -> oo.Simulation:
    keywords = {"orbit": oo.Kepler(semi_major_axis=7e6), "time_step": 1.0} | keywords
    return oo.Simulation(BODY, BODY.neutral(), np.zeros(BODY.nv), **keywords)


def test_epochs_are_text_or_aware_datetimes() -> None:
    summer = timezone(timedelta(hours=2))
    for epoch in (NOON, datetime(2024, 3, 1, 12, tzinfo=UTC), datetime(2024, 3, 1, 14, tzinfo=summer)):
        assert oo.Earth(epoch).epoch == "2024-03-01T12:00:00.000000 UTC"
    for wrong in ("2024-03-01T12:00:00", "noon", datetime(2024, 3, 1, 12), 20240301, None):
        with pytest.raises(EarthError):
            oo.Earth(wrong)  # type: ignore[arg-type]


def test_scalar_and_array_times() -> None:
    earth = oo.Earth(NOON, ut1_minus_utc=-0.0077, polar_motion=[-6e-8, 1.5e-6])
    times = np.array([0.0, 3600.0, 86_400.0])
    r = np.array([[7e6, 0, 0], [0, 7e6, 1e6], [1e5, -2e5, -6.9e6]])
    assert earth.rotation(times).shape == (3, 3, 3)
    for k, t in enumerate(times):
        np.testing.assert_array_equal(earth.rotation(times)[k], earth.rotation(t))
        np.testing.assert_array_equal(earth.sun(times)[k], earth.sun(t))
        np.testing.assert_array_equal(earth.moon(times)[k], earth.moon(t))
        np.testing.assert_allclose(earth.to_fixed(t, r[k]), earth.rotation(t) @ r[k], rtol=1e-15)
        for many, one in zip(earth.geodetic(times, r), earth.geodetic(t, r[k]), strict=True):
            assert many[k] == one
    latitude, longitude, altitude = earth.geodetic(0.0, earth.rotation(0.0).T @ [0.0, 6_378_137.0 + 4e5, 0.0])
    assert (float(latitude), float(longitude), float(altitude)) == pytest.approx(
        (0.0, np.pi / 2, 4e5), abs=1e-8
    )
    with pytest.raises(oo.exceptions.ShapeError):
        earth.geodetic(times, r[0])
    with pytest.raises(EarthError, match="expected at least 50000 m"):
        earth.geodetic(0.0, np.zeros(3))
    with pytest.raises(EarthError, match="2100"):
        earth.sun(1e10)


def test_an_earth_can_be_pickled() -> None:
    for earth in (oo.Earth(NOON, ut1_minus_utc=0.1, axes="TEME"), oo.Earth(rotation="about_z", angle=0.3)):
        again = pickle.loads(pickle.dumps(earth))
        np.testing.assert_array_equal(again.rotation(1e4), earth.rotation(1e4))
        assert repr(again) == repr(earth)


def test_contradicting_settings_are_rejected() -> None:
    rows = np.array([[60_370.0, 0, 0, -0.0077], [60_380.0, 0, 0, -0.0081]])
    assert oo.Earth(NOON, eop=rows).epoch is not None
    for keywords in (
        {"rotation": "even"},
        {"axes": "ITRF"},
        {"angle": 1.0},
        {"rotation": "about_z", "ut1_minus_utc": 0.1},
        {"rotation": "about_z", "rate": np.nan},
        {"eop": rows, "ut1_minus_utc": 0.0},
        {"eop": rows[:, ::-1]},
        {"eop": rows + np.array([100.0, 0, 0, 0])},
        {"ut1_minus_utc": np.nan},
        {"polar_motion": [0.1, 0.3]},
    ):
        with pytest.raises(EarthError):
            oo.Earth(NOON, **keywords)  # type: ignore[arg-type]


def test_the_time_span_of_tables_is_checked_before_a_run(tmp_path: Path) -> None:
    table = tmp_path / "eop.csv"
    table.write_text("mjd,x_arcsec,y_arcsec,ut1_minus_utc_s\n60370,0,0.3,-0.0077\n60371,0,0.3,-0.0081\n")
    sim = simulation(earth=oo.Earth(NOON, eop=table))
    sim.run(5.0)
    with pytest.raises(EarthError, match=r"2024-03-02T00:00:00\.000000 UTC"):
        sim.run(50_000.0)
    with pytest.raises(NotFoundError):
        oo.Earth(NOON, eop=tmp_path / "none.csv")
    table.write_text("mjd,x,y\n")
    with pytest.raises(EarthError, match="line 1"):
        oo.Earth(NOON, eop=table)


def test_an_element_set_and_its_earth_have_the_same_epoch_and_axes() -> None:
    orbit = oo.Sgp4(*TLE)
    simulation(orbit=orbit, earth=oo.Earth(orbit.epoch)).run(2.0)
    with pytest.raises(EarthError, match="2008-09-20"):
        simulation(orbit=orbit, earth=oo.Earth(NOON))


def third_body(body: str, mu: float, earth: oo.Earth, t: float, r: Any) -> Any:
    s = earth.sun(t) if body == "sun" else earth.moon(t)
    return mu * ((s - r) / np.linalg.norm(s - r) ** 3 - s / np.linalg.norm(s) ** 3)


def test_third_bodies_move_a_robot_away_from_its_point_mass_orbit() -> None:
    # a Kepler reference excludes them, so the robot departs by the tide: ½ a t² at first
    earth, orbit = oo.Earth(NOON), oo.Kepler(semi_major_axis=4.2164e7)
    bodies = [oo.ThirdBody("sun"), oo.ThirdBody("moon")]
    trace = simulation(orbit=orbit, earth=earth, environment=bodies).run(60.0)
    r, _ = orbit.state(0.0)
    tide = sum(third_body(body.body, body.mu, earth, 0.0, r) for body in bodies)
    assert 1e-6 < np.linalg.norm(tide) < 2e-5
    np.testing.assert_allclose(trace.q[-1, :3], 0.5 * tide * 60.0**2, atol=2e-2 * np.linalg.norm(tide) * 1800)
    still = simulation(orbit=orbit, earth=earth).run(60.0)
    assert np.abs(still.q[-1, :3]).max() < 1e-9
    with pytest.raises(EarthError, match="epoch"):
        simulation(environment=bodies)
    with pytest.raises(EarthError, match="epoch"):
        simulation(environment=bodies, earth=oo.Earth(rotation="about_z"))
    with pytest.raises(oo.OnOrbitError, match="twice"):
        simulation(environment=[bodies[0], oo.ThirdBody("sun")], earth=earth)
    with pytest.raises(OrbitError, match="orbit"):
        simulation(environment=bodies, earth=earth, orbit=oo.FixedFrame())
    with pytest.raises(EffectError, match="'sun' and 'moon'"):
        oo.ThirdBody("mars")  # type: ignore[arg-type]


def kernel(path: Path, segments: list[tuple[int, int, float, float, Any]]) -> None:
    """Writes a SPICE kernel of type 2 with segments (target, centre, start, interval, coefficients).

    The coefficients of a segment are (intervals, 3, n); start and interval are in s.
    """
    words, summaries, at = [], [], 3 * 128 + 1
    for target, center, start, length, coefficients in segments:
        pieces, _, n = coefficients.shape
        data = []
        for k, piece in enumerate(coefficients):
            data += [start + (k + 0.5) * length, 0.5 * length, *piece.ravel()]
        data += [start, length, 2 + 3 * n, pieces]
        integers = (target, center, 1, 2, at, at + len(data) - 1)
        summaries.append(struct.pack("<2d6i", start, start + pieces * length, *integers))
        words += data
        at += len(data)
    head = struct.pack("<8sii60siii8s", b"DAF/SPK ", 2, 6, b" " * 60, 2, 2, at, b"LTL-IEEE")
    ftp = b"FTPSTR:\r:\n:\r\n:\r\x00:\x81:\x10\xce:ENDFTP"
    first = head.ljust(699, b"\0") + ftp
    second = struct.pack("<3d", 0.0, 0.0, float(len(summaries))) + b"".join(summaries)
    names = b" " * 1024
    records = [
        first.ljust(1024, b"\0"),
        second.ljust(1024, b"\0"),
        names,
        struct.pack(f"<{len(words)}d", *words),
    ]
    path.write_bytes(b"".join(records) + b"\0" * (-len(words) * 8 % 1024))


def series(seed: int, size: float, n: int = 6, pieces: int = 3) -> Any:
    rng = np.random.default_rng(seed)
    return rng.normal(size=(pieces, 3, n)) * size * 10.0 ** -np.arange(n)


def test_kernels_are_read_by_jplephem(tmp_path: Path) -> None:
    spk = pytest.importorskip("jplephem.spk", reason="jplephem, which is in the test extra, is not installed")
    path, start, day = tmp_path / "small.bsp", 24 * 365.25 * 86_400.0, 86_400.0
    one = lambda seed, size: series(seed, size, pieces=1)  # noqa: E731  # one piece each: smooth throughout
    kernel(path, [
        (3, 0, start, 64 * day, one(1, 1e8)), (10, 0, start, 64 * day, one(2, 1e6)),
        (301, 3, start, 64 * day, one(3, 4e5)), (399, 3, start, 64 * day, one(4, 5e3)),
    ])  # fmt: skip
    epoch = "2024-01-10T00:00:00 TT"
    earth = oo.Earth(epoch, ephemeris=path)
    t = np.linspace(0.0, 30 * day, 50)
    jd = 2_460_319.5 + t / day
    with spk.SPK.open(path) as read:
        moon = read[3, 301].compute(jd) - read[3, 399].compute(jd)
        sun = read[0, 10].compute(jd) - read[0, 3].compute(jd) - read[3, 399].compute(jd)
        np.testing.assert_allclose(earth.moon(t), moon.T * 1e3, atol=1.0)
        np.testing.assert_allclose(earth.sun(t), sun.T * 1e3, atol=100.0)
    assert np.abs(earth.sun(t) - oo.Earth(epoch).sun(t)).max() > 1e9
    with pytest.raises(EarthError, match="2024-"):
        oo.Earth("2025-01-01T00:00:00 UTC", ephemeris=path)
    with pytest.raises(EarthError, match="the Sun"):
        earth.sun(90 * day)


def test_unsuitable_kernels_are_rejected(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("jplephem.spk", reason="jplephem, which is in the test extra, is not installed")
    start, length = 24 * 365.25 * 86_400.0, 64 * 86_400.0
    moonless = tmp_path / "moonless.bsp"
    kernel(
        moonless,
        [(10, 0, start, length, series(1, 1e8, pieces=1)), (399, 0, start, length, series(2, 1e6, pieces=1))],
    )
    with pytest.raises(EarthError, match=r"Moon \(body 301; bodies in the kernel: 10, 399\)"):
        oo.Earth(NOON, ephemeris=moonless)
    with pytest.raises(NotFoundError, match=r"none\.bsp"):
        oo.Earth(NOON, ephemeris=tmp_path / "none.bsp")
    (tmp_path / "text.bsp").write_text("no kernel")
    with pytest.raises(ReadError, match="cannot be read as a SPICE kernel"):
        oo.Earth(NOON, ephemeris=tmp_path / "text.bsp")
    monkeypatch.setitem(sys.modules, "jplephem.spk", None)
    with pytest.raises(EarthError, match=r"pip install 'onorbit-rs\[spice\]'"):
        oo.Earth(NOON, ephemeris=moonless)


def scenario(**parts: Any) -> dict[str, Any]:
    return {
        "robot": {"rigid_body": {"mass": 100.0, "inertia": [[1, 0, 0], [0, 2, 0], [0, 0, 3]]}},
        "orbit": {"kind": "kepler", "semi_major_axis": 7e6},
        "simulation": {"duration": 2.0, "time_step": 1.0},
    } | parts


def built(tmp_path: Path, **parts: Any) -> Any:
    file = tmp_path / "scenario.yaml"
    file.write_text(yaml.safe_dump(scenario(**parts), sort_keys=False))
    return build(load(file))


def test_scenarios_define_epoch_and_rotation_of_the_earth(tmp_path: Path) -> None:
    (tmp_path / "eop.csv").write_text("mjd,x_arcsec,y_arcsec,ut1_minus_utc_s\n60370,0,0.3,0\n60380,0,0.3,0\n")
    pull = {"environment": [{"kind": "third_body", "body": "moon"}, {"kind": "third_body", "body": "sun"}]}
    for parts in (
        {"epoch": NOON},
        {
            "epoch": NOON,
            "earth": {"ut1_minus_utc": "-7.7 ms", "polar_motion": ["-0.01 arcsec", "0.3 arcsec"]},
        },
        {"epoch": NOON, "earth": {"eop": "eop.csv"}},
        {"epoch": NOON, "earth": {"rotation": "about_z", "angle": "10 deg"}},
        {"orbit": {"kind": "sgp4", "line1": TLE[0], "line2": TLE[1]}},
    ):
        made = built(tmp_path, **parts, **pull)
        made.simulation.run(2.0)
        assert load(made.scenario.resolved()).resolved() == made.scenario.resolved()
    for parts, place in (
        ({"epoch": "2024-03-01T12:00:00"}, "epoch"),
        ({"epoch": NOON, "earth": {"angle": 1.0}}, "earth"),
        ({"epoch": NOON, "earth": {"ut1": 0.1}}, "earth"),
        ({"epoch": NOON, "environment": [{"kind": "third_body", "body": "mars"}]}, "environment"),
    ):
        with pytest.raises(ScenarioError, match=place):
            built(tmp_path, **parts)
    with pytest.raises(EarthError, match="epoch"):
        built(tmp_path, **pull)
    with pytest.raises(EarthError, match="earth"):
        built(
            tmp_path,
            epoch=NOON,
            earth={"eop": "eop.csv", "ephemeris": None},
            simulation={"duration": "30 day", "time_step": "1 day"},
        )
    with pytest.raises(NotFoundError, match=r"other\.csv"):
        built(tmp_path, epoch=NOON, earth={"eop": "other.csv"})
