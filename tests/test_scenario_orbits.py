"""All kinds of orbits in a scenario: reading, errors with file and line, resolved scenarios."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

import onorbit_rs as oo
from onorbit_rs.exceptions import (
    ElementSetError,
    NotFoundError,
    OnOrbitError,
    PathError,
    ReadError,
    ScenarioError,
)
from onorbit_rs.scenario import load
from onorbit_rs.scenario.build import build

LINE1 = "1 00005U 58002B   00179.78495062  .00000023  00000-0  28098-4 0  4753"
LINE2 = "2 00005  34.2682 348.7242 1859667 331.7664  19.3264 10.82419157413667"
CSV = "t,x,y,z,vx,vy,vz\n0,7e6,0,0,0,7500,0\n\n10,7e6,75000,0,0,7500,0\n20,7e6,150000,0,0,7500,0\n"


def scenario(orbit: Any, **parts: Any) -> dict[str, Any]:
    body = {"rigid_body": {"mass": 10.0, "inertia": [1.0, 2.0, 2.5]}}
    return {"robot": body, "orbit": orbit, "simulation": {"duration": 1.0, "time_step": 0.1}} | parts


def written(folder: Path, orbit: Any, **parts: Any) -> Path:
    file = folder / "mine.yaml"
    file.write_text(yaml.safe_dump(scenario(orbit, **parts), sort_keys=False))
    return file


def orbit_of(source: Any) -> oo.Orbit:
    made = build(load(source)).orbit
    assert made is not None
    return made


@pytest.mark.parametrize("key", ["lines", "tle", "tle_file"])
def test_an_element_set_can_be_written_in_three_ways(key: str, tmp_path: Path) -> None:
    text = f"VANGUARD 1\n{LINE1}\n{LINE2}\n"
    (tmp_path / "set.txt").write_text(text)
    ways = {
        "lines": {"line1": LINE1, "line2": LINE2},
        "tle": {"tle": text},
        "tle_file": {"tle_file": "set.txt"},
    }
    made = orbit_of(written(tmp_path, {"kind": "sgp4"} | ways[key]))
    np.testing.assert_array_equal(made.state(60.0)[0], oo.Sgp4(LINE1, LINE2).state(60.0)[0])


OTHER = (
    "1 06251U 62025E   06176.82412014  .00008885  00000-0  12808-3 0  3985",
    "2 06251  58.0579  54.0425 0030035 139.1568 221.1854 15.56387291  6774",
)


@pytest.mark.parametrize("satellite", ["delta 1 deb", "6251", 6251])
def test_one_of_several_sets_is_chosen_by_name_or_number(satellite: Any, tmp_path: Path) -> None:
    text = f"0 VANGUARD 1\n{LINE1}\n{LINE2}\nDELTA 1 DEB   \n{OTHER[0]}\n{OTHER[1]}\n"
    (tmp_path / "all.tle").write_text(text)
    made = orbit_of(written(tmp_path, {"kind": "sgp4", "tle_file": "all.tle", "satellite": satellite}))
    np.testing.assert_array_equal(made.state(60.0)[0], oo.Sgp4(*OTHER).state(60.0)[0])
    for other, says in [("VANGARD", "did you mean 'VANGUARD 1'"), (None, "with 'satellite'")]:
        with pytest.raises(ElementSetError, match=says):
            orbit_of(written(tmp_path, {"kind": "sgp4", "tle_file": "all.tle", "satellite": other}))
    with pytest.raises(ElementSetError, match="contains 2 element sets"):
        orbit_of(scenario({"kind": "sgp4", "tle": text * 2, "satellite": satellite}))


def test_one_of_several_messages_is_chosen_by_name(tmp_path: Path) -> None:
    keys = (
        "OBJECT_NAME,EPOCH,MEAN_MOTION,ECCENTRICITY,INCLINATION,RA_OF_ASC_NODE,ARG_OF_PERICENTER,MEAN_ANOMALY"
    )
    rows = "2000-06-27T18:50:19.733568,10.82419157,.1859667,34.2682,348.7242,331.7664,19.3264"
    text = f"{keys},NORAD_CAT_ID,BSTAR\nVANGUARD 1,{rows},5,.28098E-4\nOTHER,{rows},7,0\n"
    (tmp_path / "all.csv").write_text(text)
    orbit = {"kind": "sgp4", "omm_file": "all.csv", "satellite": "vanguard 1", "propagator": "reference"}
    made = orbit_of(written(tmp_path, orbit))
    np.testing.assert_allclose(made.state(60.0)[0], oo.Sgp4(LINE1, LINE2).state(60.0)[0], rtol=1e-13)
    with pytest.raises(
        ElementSetError,
        match="2 messages; give a single message, or select one in a scenario with",
    ):
        orbit_of(written(tmp_path, {"kind": "sgp4", "omm_file": "all.csv"}))


def test_points_have_units_or_come_from_a_file_beside_the_scenario(tmp_path: Path) -> None:
    (tmp_path / "path.csv").write_text(CSV)
    carried = {"gravity_mode": "carried"}  # a straight line is inconsistent with gravity
    from_file = orbit_of(
        written(tmp_path, {"kind": "custom_path", "file": "path.csv", "mu": oo.MU_EARTH} | carried)
    )
    inline = orbit_of(
        scenario(
            {
                "kind": "custom_path",
                "times": [0, "10 s", 20],
                "positions": [["7000 km", 0, 0], ["7000 km", "75 km", 0], ["7000 km", "150 km", 0]],
                "velocities": [[0, "7.5 km/s", 0]] * 3,
                "mu": "398600.4418 km^3/s^2",
                **carried,
            }
        )
    )
    np.testing.assert_allclose(from_file.state(13.0)[0], inline.state(13.0)[0], rtol=1e-15)


@pytest.mark.parametrize(
    ("text", "error", "says"),
    [
        (CSV.replace("vx", "ux"), ReadError, "path.csv:1: unknown column 'ux'"),
        (CSV.replace("vx", "x"), ReadError, "path.csv:1: column 'x' occurs more than once"),
        (CSV.replace(",vz", ""), ReadError, "path.csv:1: the header lacks vz; give the columns vx, vy, vz"),
        (CSV.replace("75000,0,0", "75000,zero,0"), ReadError, "path.csv:4: .zero. is not a number"),
        (
            CSV.replace("10,7e6,75000,0,0,7500,0", "10,7e6"),
            ReadError,
            "path.csv:4: the number of cells is 2; it must be 7",
        ),
        ("", ReadError, "path.csv:1: the header lacks t; give the columns t"),
        ("t,x,y,z\n", PathError, "at least 2"),
        (CSV.replace("20,7e6", "5,7e6"), PathError, "times must increase"),
    ],
)
def test_an_invalid_point_file_is_reported_with_its_line(
    text: str, error: type[OnOrbitError], says: str, tmp_path: Path
) -> None:
    (tmp_path / "path.csv").write_text(text)
    with pytest.raises(error, match=says) as caught:
        orbit_of(written(tmp_path, {"kind": "custom_path", "file": "path.csv"}))
    assert "mine.yaml:" in str(caught.value)


@pytest.mark.parametrize(
    ("orbit", "error", "says"),
    [
        ({"kind": "sgp4", "line1": LINE1}, ScenarioError, "both 'line1' and 'line2'"),
        ({"kind": "sgp4"}, ScenarioError, "give one element set"),
        ({"kind": "sgp4", "tle": LINE1}, ElementSetError, "contains 1 line;"),
        ({"kind": "sgp4", "tle_file": "none.txt"}, NotFoundError, "none.txt"),
        ({"kind": "sgp4", "line1": LINE1, "line2": LINE2 + "7"}, ElementSetError, "70 columns"),
        ({"kind": "sgp4", "line1": LINE1, "line2": LINE2, "gravity": "wgs27"}, ScenarioError, "'wgs72'"),
        ({"kind": "sgp4", "line1": LINE1, "line2": LINE2, "satellite": "5"}, ScenarioError, "one satellite"),
        ({"kind": "sgp4", "line1": LINE1, "line2": LINE2, "propagator": "own"}, ScenarioError, "reference"),
        ({"kind": "sgp44"}, ScenarioError, "did you mean 'sgp4'"),
        ({"kind": "custom_path", "times": [0, 1]}, ScenarioError, "'times' and 'positions'"),
        (
            {"kind": "custom_path", "file": "a.csv", "times": [0]},
            ScenarioError,
            "omit 'file', or omit 'times'",
        ),
        ({"kind": "custom_path", "times": [0, 0], "positions": [[0, 0, 0]] * 2}, PathError, "increase"),
        ({"kind": "custom_path", "times": [0, "1 m"], "positions": [[0, 0, 0]] * 2}, ScenarioError, "a time"),
        ({"kind": "fixed_frame", "gravity_mode": "free"}, ScenarioError, "'carried'"),
        ({"kind": "fixed_frame", "mu": -1}, ScenarioError, "it must be above zero"),
    ],
)
def test_invalid_orbits_are_reported_with_their_place(
    orbit: Any, error: type[OnOrbitError], says: str, tmp_path: Path
) -> None:
    with pytest.raises(error, match=says) as caught:
        orbit_of(written(tmp_path, orbit))
    assert "mine.yaml:" in str(caught.value)


def test_a_path_too_short_for_the_run_is_reported_before_the_run(tmp_path: Path) -> None:
    orbit = {"kind": "custom_path", "times": [0.05, 9.0], "positions": [[0, 0, 0], [1, 0, 0]]}
    with pytest.raises(PathError, match=r"mine\.yaml:.*give points that cover this time"):
        orbit_of(written(tmp_path, orbit))


@pytest.mark.parametrize("kind", ["custom_path", "fixed_frame", "sgp4", "standing"])
def test_the_resolved_scenario_of_a_run_contains_its_orbit(kind: str, tmp_path: Path) -> None:
    (tmp_path / "path.csv").write_text(CSV)
    (tmp_path / "set.txt").write_text(f"{LINE1}\n{LINE2}\n")
    orbits: dict[str, Any] = {
        "custom_path": {"kind": "custom_path", "file": "path.csv", "mu": oo.MU_EARTH, "gravity_mode": True},
        "fixed_frame": "fixed_frame",
        "sgp4": {"kind": "sgp4", "tle_file": "set.txt", "gravity_mode": "carried"},
        "standing": {"kind": "fixed_frame", "position": ["7000 km", 0, 0], "mu": oo.MU_EARTH},
    }
    first = oo.run(written(tmp_path, orbits[kind]), out=tmp_path / "out", quiet=True)
    again = oo.run(tmp_path / "out" / "scenario.yaml", quiet=True)
    np.testing.assert_array_equal(first.trace.q, again.trace.q)
    assert first.summary["certificate_passed"], first.summary["certificate_failures"]
    assert first.summary["inertial_axes"] == ("TEME" if kind == "sgp4" else "GCRF")
    assert ("SGP4's own" in first.summary["velocity_eci_source"]) == (kind == "sgp4")
    assert first.summary.get("gravity_mode") == {"sgp4": "carried", "fixed_frame": None}.get(kind, "true")
    assert ("reference_residual_max_m_s2" in first.summary) == (kind == "sgp4")
    assert (tmp_path / "out" / "run.rrd").stat().st_size > 1000


def test_an_initial_state_relative_to_the_path_rotates_with_it() -> None:
    orbit = {
        "kind": "custom_path", "times": [0, 1, 2], "positions": [[0, 0, 0], [1, 0, 0], [2, 0, 0]],
        "attitudes": [[0, 0, np.sin(t / 4), np.cos(t / 4)] for t in (0, 1, 2)],
    }  # fmt: skip
    made = build(load(scenario(orbit, initial={"frame": "path"})))
    np.testing.assert_allclose(made.v[3:6], [0.0, 0.0, 0.5], atol=2e-2)  # a spline of three points
    np.testing.assert_allclose(made.v[3:6], made.orbit.frame(0.0)[1] if made.orbit else 0.0, atol=1e-15)
