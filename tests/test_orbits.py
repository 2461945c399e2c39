"""SGP4, custom paths and fixed frames through Python: arrays, invalid input, CCSDS messages, pickling."""

from __future__ import annotations

import json
import pickle
from typing import Any

import numpy as np
import pytest
from sgp4.api import Satrec

import onorbit_rs as oo
from onorbit_rs.exceptions import (
    ElementSetError,
    InputError,
    OnOrbitError,
    OrbitError,
    PathError,
    Sgp4Error,
    ShapeError,
)

LINE1 = "1 00005U 58002B   00179.78495062  .00000023  00000-0  28098-4 0  4753"
LINE2 = "2 00005  34.2682 348.7242 1859667 331.7664  19.3264 10.82419157413667"
DECAYING = (
    "1 28872U 05037B   05333.02012661  .25992681  00000-0  24476-3 0  1534",
    "2 28872  96.4736 157.9986 0303955 244.0492 110.6523 16.46015938 10708",
)
OMM = {
    "OBJECT_NAME": "VANGUARD 1", "OBJECT_ID": "1958-002B", "CENTER_NAME": "EARTH", "REF_FRAME": "TEME",
    "TIME_SYSTEM": "UTC", "MEAN_ELEMENT_THEORY": "SGP4", "EPOCH": "2000-06-27T18:50:19.733568",
    "MEAN_MOTION": 10.82419157, "ECCENTRICITY": 0.1859667, "INCLINATION": 34.2682,
    "RA_OF_ASC_NODE": 348.7242, "ARG_OF_PERICENTER": 331.7664, "MEAN_ANOMALY": 19.3264,
    "NORAD_CAT_ID": 5, "BSTAR": 0.28098e-4,
}  # fmt: skip
TIMES = np.array([0.0, 1.0, 2.5, 4.0])
POINTS = np.array([[7e6, 0.0, 0.0], [7e6, 5.0, 0.0], [7e6, 20.0, 1.0], [7e6, 50.0, 3.0]])


def as_kvn() -> str:
    units = {"INCLINATION": " [deg]"}
    return "CCSDS_OMM_VERS = 2.0\nCOMMENT by = hand\n" + "\n".join(
        f"{key} = {value}{units.get(key, '')}" for key, value in OMM.items()
    )


def as_xml() -> str:
    def part(name: str, *keys: str) -> str:
        return f"<{name}>{''.join(f'<{key}>{OMM[key]}</{key}>' for key in keys)}</{name}>"

    names, elements, parameters = tuple(OMM)[:6], tuple(OMM)[6:13], tuple(OMM)[13:]
    data = part("meanElements", *elements) + part("tleParameters", *parameters)
    segment = f"<segment>{part('metadata', *names)}<data>{data}</data></segment>"
    return f'<?xml version="1.0" encoding="UTF-8"?><ndm><omm><body>{segment}</body></omm></ndm>'


def as_csv(*messages: dict[str, Any]) -> str:
    rows = [",".join(OMM), *(",".join(map(str, message.values())) for message in messages or (OMM,))]
    return "\r\n".join(rows)


@pytest.mark.parametrize("message", [OMM, json.dumps(OMM), json.dumps([OMM]), as_kvn(), as_xml(), as_csv()])
def test_a_message_is_the_same_orbit_as_its_tle(message: Any) -> None:
    by_lines, by_message = oo.Sgp4(LINE1, LINE2), oo.Sgp4.from_omm(message)
    assert by_message.satellite == by_lines.satellite == 5
    assert by_message.epoch == by_lines.epoch == "2000-06-27T18:50:19.733568Z"
    for got, want in zip(by_message.state(3600.0), by_lines.state(3600.0), strict=True):
        np.testing.assert_allclose(got, want, rtol=1e-12)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"BSTAR": None}, "has no entry BSTAR"),
        ({"EPOCH": "yesterday"}, "EPOCH is"),
        ({"EPOCH": "00-06-27T18:50:19.733568"}, "EPOCH is"),
        ({"MEAN_MOTION": "fast"}, "MEAN_MOTION is"),
        ({"ECCENTRICITY": 1.2}, "eccentricity of the element set is 1.2"),
        ({"MEAN_ELEMENT_THEORY": "DSST"}, "MEAN_ELEMENT_THEORY"),
        ({"REF_FRAME": "EME2000"}, "REF_FRAME"),
        ({"INCLINATION": float("nan")}, "INCLINATION"),
    ],
)
def test_invalid_messages_are_rejected(change: dict[str, Any], says: str) -> None:
    with pytest.raises(ElementSetError, match=says):
        oo.Sgp4.from_omm(OMM | change)


@pytest.mark.parametrize(
    "text",
    [
        "", "hello", "{", "<a>", "<a/>", "[]", "[1]", json.dumps([OMM, OMM]), as_kvn() * 2, as_csv(OMM, OMM),
        as_csv().splitlines()[0], as_xml().replace("tleParameters", "parameters"), "a,b\n" + "x" * 200_000,
        as_xml().replace("UTF-8", "UTF-88"),
        as_xml().replace("<ndm>", "<!DOCTYPE ndm [<!ENTITY a 'b'>]><ndm>"),
    ],
)  # fmt: skip
def test_texts_other_than_messages_are_rejected(text: str) -> None:
    with pytest.raises(ElementSetError):
        oo.Sgp4.from_omm(text)


def test_sgp4_shows_its_elements() -> None:
    orbit = oo.Sgp4(LINE1, LINE2)
    assert orbit.axes == "TEME" and "SGP4's own" in orbit.velocity_source
    assert orbit.mu == 3.986008e14
    assert abs(orbit.period - 86400.0 / 10.82419157) < 1e-9
    assert sum(orbit.julian_date) == pytest.approx(2451723.28495062, abs=1e-8)
    r, v = orbit.state(np.arange(5.0))
    rotation, rate = orbit.lvlh(np.arange(5.0))
    assert r.shape == v.shape == rate.shape == (5, 3) and rotation.shape == (5, 3, 3)
    np.testing.assert_allclose(rotation[:, :, 0], r / np.linalg.norm(r, axis=1)[:, None], atol=1e-15)


def test_an_epoch_in_december_before_2000_is_written_correctly() -> None:
    orbit = oo.Sgp4.from_omm(OMM | {"EPOCH": "1989-12-24T06:00:00"})
    assert orbit.epoch == "1989-12-24T06:00:00.000000Z"


def test_bad_lines_name_line_and_column() -> None:
    with pytest.raises(ElementSetError, match="check_checksum=False") as caught:
        oo.Sgp4(LINE1, LINE2.replace("34.2682", "34.2683"))
    assert (caught.value.line, caught.value.column) == (2, 69)
    assert (caught.value.got, caught.value.expected) == (7, 8)
    with pytest.raises(ElementSetError, match="line 1 of the TLE, column 21") as caught:
        oo.Sgp4(LINE1.replace("179.7849", "x79.7849"), LINE2, check_checksum=False)
    assert caught.value.column == 21
    with pytest.raises(ElementSetError, match="68 columns"):
        oo.Sgp4(LINE1[:-1], LINE2)
    bad: Any = "wgs85"
    with pytest.raises(InputError, match="wgs72"):
        oo.Sgp4(LINE1, LINE2, gravity=bad)


def test_the_error_of_a_decayed_orbit_has_code_time_and_distance() -> None:
    with pytest.raises(Sgp4Error, match="decayed") as caught:
        oo.Sgp4(*DECAYING).state(3600.0)
    assert (caught.value.code, caught.value.time) == (6, 3600.0)
    assert caught.value.got < 6.4e6
    again = pickle.loads(pickle.dumps(caught.value))
    assert (again.code, again.time, again.got) == (6, 3600.0, caught.value.got)


def test_a_path_passes_through_its_points_and_attitudes() -> None:
    half = np.pi / 8 * TIMES
    attitudes = np.stack([0 * half, 0 * half, np.sin(half), np.cos(half)], axis=1)
    path = oo.CustomPath(TIMES, POINTS, attitudes=attitudes)
    r, _ = path.state(TIMES)
    np.testing.assert_array_equal(r, POINTS)
    assert path.span == (0.0, 4.0) and path.has_attitudes and path.mu is None
    rotation, rate = path.frame(TIMES)
    np.testing.assert_allclose(rotation[:, 0, 0], np.cos(2.0 * half), atol=1e-15)
    np.testing.assert_allclose(rate[:, 2], np.pi / 4, rtol=0.03)  # the spline of four points
    lvlh, _ = path.lvlh(1.0)
    np.testing.assert_allclose(
        lvlh[:, 0], [1.0, 0.0, 0.0], atol=1e-5
    )  # of the state, independent of the attitudes


@pytest.mark.parametrize(
    ("times", "positions", "rest", "error", "says"),
    [
        (TIMES[::-1], POINTS, {}, PathError, "times must increase"),
        (TIMES[[0, 1, 1, 3]], POINTS, {}, PathError, "remove duplicates"),
        (TIMES[:1], POINTS[:1], {}, PathError, "at least 2"),
        (TIMES, POINTS[:3], {}, PathError, "one per time"),
        (TIMES, POINTS[:, :2], {}, ShapeError, r"expected \(T, 3\)"),
        (TIMES, POINTS * np.nan, {}, PathError, "finite"),
        (TIMES, POINTS, {"accelerations": POINTS}, PathError, "without velocities"),
        (TIMES, POINTS, {"attitudes": np.ones((4, 4))}, PathError, "norm 2"),
        (TIMES, POINTS, {"ends": "hold"}, InputError, "'coast'"),
        (TIMES, POINTS, {"mu": -1.0}, OrbitError, "greater than zero"),
        ("soon", POINTS, {}, TypeError, "text"),
    ],
)
def test_invalid_points_of_a_path_are_rejected(
    times: Any, positions: Any, rest: dict[str, Any], error: type[Exception], says: str
) -> None:
    with pytest.raises(error, match=says) as caught:
        oo.CustomPath(times, positions, **rest)
    assert isinstance(caught.value, OnOrbitError)


def test_times_outside_the_path_are_rejected_or_extrapolated() -> None:
    with pytest.raises(PathError, match='ends="coast"') as caught:
        oo.CustomPath(TIMES, POINTS).state([1.0, 4.5])
    assert (caught.value.time, caught.value.start, caught.value.end) == (4.5, 0.0, 4.0)
    coasting = oo.CustomPath(TIMES, POINTS, ends="coast")
    (r, v), (end, v_end) = coasting.state(6.0), coasting.state(4.0)
    np.testing.assert_array_equal(v, v_end)
    np.testing.assert_allclose(r, end + 2.0 * v_end, rtol=1e-15)


def test_a_fixed_frame_does_not_move() -> None:
    frame = oo.FixedFrame(position=[1.0, 2.0, 3.0], attitude=[0.0, 0.0, np.sin(0.5), np.cos(0.5)])
    r, v = frame.state([0.0, 9.0])
    np.testing.assert_array_equal(r, [[1.0, 2.0, 3.0]] * 2)
    assert not v.any() and frame.mu is None
    rotation, rate = frame.frame(5.0)
    np.testing.assert_allclose(rotation[:2, 0], [np.cos(1.0), np.sin(1.0)], atol=1e-15)
    assert not rate.any()
    with pytest.raises(OrbitError, match="the local orbital frame is undefined"):
        frame.lvlh(0.0)
    with pytest.raises(InputError, match="norm 2"):
        oo.FixedFrame(attitude=[0.0, 0.0, 0.0, 2.0])


def test_the_frame_of_an_orbit_without_attitudes_is_lvlh() -> None:
    orbit = oo.Kepler(semi_major_axis=7e6)
    for got, want in zip(orbit.frame([0.0, 50.0]), orbit.lvlh([0.0, 50.0]), strict=True):
        np.testing.assert_array_equal(got, want)


@pytest.mark.parametrize(
    "orbit",
    [
        oo.Kepler(semi_major_axis=7e6, eccentricity=0.2, mean_anomaly=1.0, raan=0.3),
        oo.Kepler.from_state([7e6, 0.0, 1e5], [0.0, 7.6e3, 10.0], mu=3.9e14),
        oo.Sgp4(LINE1, LINE2, gravity="wgs84"),
        oo.Sgp4.from_omm(OMM),
        oo.Sgp4.from_omm(OMM, propagator="reference"),
        oo.Sgp4(LINE1, LINE2, propagator="reference"),
        oo.Sgp4(Satrec.twoline2rv(LINE1, LINE2)),
        oo.Sgp4(Satrec.twoline2rv(LINE1, LINE2), propagator="reference"),
        oo.CustomPath(TIMES, POINTS, mu=4e14, ends="coast"),
        oo.FixedFrame(position=[1.0, 2.0, 3.0]),
    ],
    ids=lambda orbit: type(orbit).__name__,
)
def test_pickled_orbits_are_restored_bit_by_bit(orbit: oo.Orbit) -> None:
    again = pickle.loads(pickle.dumps(orbit))
    assert type(again) is type(orbit) and again.mu == orbit.mu
    for got, want in zip(again.state([0.0, 3.0]), orbit.state([0.0, 3.0]), strict=True):
        np.testing.assert_array_equal(got, want)
