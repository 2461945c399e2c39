"""Effects without a target, or with numbers in the wrong unit, are rejected with a fix."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs import relative
from onorbit_rs.exceptions import (
    DtypeError,
    EarthError,
    EffectError,
    InputError,
    NotFoundError,
    OnOrbitError,
    OrbitError,
    ReadError,
    ScenarioError,
)
from onorbit_rs.scenario import load
from onorbit_rs.scenario.build import build

AIR = oo.ConstantAtmosphere(1e-12)
EARTH = oo.Earth("2024-03-01T12:00:00 UTC")
ORBIT = oo.Kepler(semi_major_axis=6778e3, inclination=0.9)
BALL = oo.Cannonball(1.0)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: oo.Drag(AIR, surfaces={}), "no body has a surface"),
        (lambda: oo.Plates([], np.zeros((0, 3)), np.zeros((0, 3))), "no plates are given"),
        (lambda: oo.Cannonball(1.0, reflectivity=3.0), "from 0 to 2"),
        (lambda: oo.HarrisPriester(lag=30.0), "30° is 0.524"),
        (lambda: AIR.density(400e3, 45.0), "latitude is 45"),
        (lambda: oo.RadiationPressure(earth_radius=6378.0), "metres, not kilometres"),
        (lambda: oo.Nrlmsise00(f107=999.9, f107a=150.0, ap=4.0), "marks a gap"),
        (lambda: oo.Nrlmsise00(f107=150.0, f107a=1e4, ap=4.0), "f107a is 10000"),
    ],
)
def test_invalid_drag_and_radiation_pressure(make: Any, message: str) -> None:
    with pytest.raises(EffectError, match=message):
        make()


def test_values_just_inside_the_limits_are_accepted() -> None:
    oo.Cannonball(1.0, reflectivity=2.0)
    oo.HarrisPriester(lag=-np.pi)
    oo.RadiationPressure(flux=0.0, surfaces=BALL)
    assert AIR.density(400e3, np.pi / 2) == 1e-12


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"secular_j2": True, "radius": 6378.0}, "metres, not kilometres"),
        ({"secular_j2": True, "j2": 5.0}, "from -0.1 to 0.1"),
        ({"j2": 1e-3}, "without secular_j2=True"),
        ({"radius": 6378e3}, "without secular_j2=True"),
    ],
)
def test_invalid_flattening(given: dict[str, Any], message: str) -> None:
    with pytest.raises(OrbitError, match=message):
        oo.Kepler(semi_major_axis=7e6, **given)


@pytest.mark.parametrize("convert", [relative.to_lvlh, relative.from_lvlh])
def test_local_coordinates_of_empty_input(convert: Any) -> None:
    with pytest.raises(OrbitError, match="r is NaN"):
        convert(ORBIT, 0.0, [np.nan, 0.0, 0.0], [0.0, 0.0, 0.0])
    with pytest.raises(OrbitError, match="v is inf"):
        convert(ORBIT, [0.0, 1.0], np.zeros((2, 3)), [[0.0, 0.0, 0.0], [0.0, np.inf, 0.0]])


def test_arguments_that_must_be_lists_are_named() -> None:
    robot = oo.Model.rigid_body(1.0, np.eye(3).tolist())
    with pytest.raises(DtypeError, match="orbits is of type Kepler; expected a list of orbits"):
        oo.propagate(ORBIT, [0.0])  # type: ignore[arg-type]
    with pytest.raises(DtypeError, match="orbits contains an entry of type str"):
        oo.propagate([ORBIT, "j2"], [0.0])  # type: ignore[list-item]
    with pytest.raises(DtypeError, match="environment is of type str; expected a list of effects"):
        oo.Simulation(robot, robot.neutral(), np.zeros(6), environment="j2", time_step=1.0)  # type: ignore[arg-type]
    with pytest.raises(DtypeError, match="environment is of type GravityGradient"):
        oo.Numerical([7e6, 0, 0], [0, 7.5e3, 0], environment=oo.GravityGradient())  # type: ignore[arg-type]
    out = (np.zeros((1, 1, 3)),) * 3
    with pytest.raises(InputError, match="out is not a pair"):
        oo.propagate([ORBIT], [0.0], out=out)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="threads is -1; it must be at least 1; omit it"):
        oo.propagate([ORBIT], [0.0], threads=-1)


def test_missing_tables_are_reported_without_the_message_of_the_system(tmp_path: Path) -> None:
    for what, read in (
        ("space weather table", lambda path: oo.Nrlmsise00(table=path)),
        ("Earth-orientation table", lambda path: oo.Earth("2024-03-01T12:00:00 UTC", eop=path)),
    ):
        with pytest.raises(NotFoundError, match=rf"none\.csv: there is no such {what}; check the path$"):
            read(tmp_path / "none.csv")
        with pytest.raises(
            ReadError, match=rf"the {what} .* cannot be read: it is a folder; give the path of a file$"
        ):
            read(tmp_path)


def test_messages_name_the_file(tmp_path: Path) -> None:
    weather, eop = tmp_path / "sw.csv", tmp_path / "eop.csv"
    weather.write_text("DATE,AP_AVG,F10.7_OBS,F10.7_OBS_CENTER81\n2024-02-29,12,150,139\n2024-03-01,12,1\n")
    with pytest.raises(
        EffectError, match=r"sw\.csv: space weather, line 3: the row has 3 fields, but the header"
    ):
        oo.Nrlmsise00(table=weather)
    weather.write_text(weather.read_text().replace("12,1\n", "12,151,140\n"))
    with pytest.raises(EffectError, match=r"2024-03-02 is outside the table .*sw\.csv, which"):
        oo.Nrlmsise00(table=weather).density(400e3, t=86_400.0, earth=EARTH)
    eop.write_text("mjd,x_arcsec,y_arcsec,ut1_minus_utc_s\n60370,0,x,0\n")
    with pytest.raises(EarthError, match=r"eop\.csv: .*line 2"):
        oo.Earth("2024-03-01T12:00:00 UTC", eop=eop)


HALF = """<robot name="half">
<link name="base"><inertial><mass value="5"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
<visual><geometry><box size="1 1 1"/></geometry></visual></link>
<link name="arm"><inertial><mass value="1"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="j" type="revolute"><parent link="base"/><child link="arm"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>"""


def test_bodies_without_faces_are_named(tmp_path: Path) -> None:
    (tmp_path / "half.urdf").write_text(HALF)
    robot = oo.Model.from_urdf(tmp_path / "half.urdf")

    def simulation(effect: oo.Effect) -> None:
        oo.Simulation(
            robot, robot.neutral(), np.zeros(robot.nv), orbit=ORBIT, earth=EARTH, environment=[effect],
            time_step=1.0,
        )  # fmt: skip

    with pytest.warns(UserWarning, match="drag does not act on bodies without visual geometry: arm"):
        simulation(oo.Drag(AIR))
    simulation(oo.Drag(AIR, surfaces={"base": oo.Faces()}))  # intended: no warning


SCENARIO: dict[str, Any] = {
    "robot": "humanoid_torso", "epoch": "2024-03-01T12:00:00 UTC",
    "orbit": {"kind": "kepler", "semi_major_axis": "6778 km"},
    "simulation": {"duration": 0.01, "time_step": 0.01},
}  # fmt: skip


@pytest.mark.parametrize(
    ("effect", "without", "error", "message"),
    [
        ({"surfaces": {"kind": "cannonball", "area": 2}}, None, EffectError, r"in YAML bodies: \{torso"),
        ({"bodies": {"torsso": "faces"}}, None, OnOrbitError, "torso"),
        ({}, "epoch", EffectError, "in YAML, give an epoch"),
        ({"bodies": {}}, None, ScenarioError, "has 0 entries; give at least one"),
    ],
)
@pytest.mark.parametrize("kind", ["drag", "radiation_pressure"])
def test_errors_in_yaml_name_the_effect(
    kind: str, effect: Any, without: Any, error: Any, message: str
) -> None:
    given = {key: value for key, value in SCENARIO.items() if key != without}
    with pytest.raises(error, match=rf"environment\[1\].*{message}"):
        build(load(given | {"environment": ["gravity_gradient", {"kind": kind} | effect]}))


@pytest.mark.parametrize("never", ["never", np.inf])
def test_rereferencing_can_be_turned_off(never: Any) -> None:
    scenario = load(SCENARIO | {"simulation": SCENARIO["simulation"] | {"rereference_beyond": never}})
    build(scenario).simulation.run(0.01)
    assert load(scenario.resolved()).simulation.rereference_beyond == "never"
    with pytest.raises(ScenarioError, match=r"0\.5 m is too short; give at least 1 m, or 'never'"):
        load(SCENARIO | {"simulation": SCENARIO["simulation"] | {"rereference_beyond": 0.5}})


def test_a_flux_has_a_unit() -> None:
    light = {"kind": "radiation_pressure", "flux": "1.4 kW/m^2"}
    part: Any = load(SCENARIO | {"environment": [light]}).environment[0]
    assert part.flux == pytest.approx(1400.0)
    with pytest.raises(ScenarioError, match="flux"):
        load(SCENARIO | {"environment": [light | {"flux": "1361 W"}]})
