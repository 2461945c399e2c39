"""Drag and radiation pressure in YAML: one-line forms and all settings."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.exceptions import EffectError, NotFoundError, OnOrbitError, ScenarioError
from onorbit_rs.scenario import load
from onorbit_rs.scenario.build import build

ORBIT = {
    "kind": "kepler", "semi_major_axis": "6778 km", "eccentricity": 0.0005, "inclination": "51.6 deg",
    "raan": "30 deg", "argument_of_periapsis": "0 deg", "mean_anomaly": "0 deg",
}  # fmt: skip


SHINY = {"kind": "faces", "specular": 0.7, "diffuse": 0.7}


def air(**atmosphere: Any) -> dict[str, Any]:
    return {"kind": "drag", "atmosphere": atmosphere}


def scenario(*environment: Any, robot: Any = "humanoid_torso", **parts: Any) -> dict[str, Any]:
    return {
        "robot": robot, "orbit": ORBIT, "epoch": "2024-03-01T12:00:00 UTC", "environment": list(environment),
        "simulation": {"duration": 0.01, "time_step": 0.01},
    } | parts  # fmt: skip


def impulse(*environment: Any, **parts: Any) -> Any:
    """Returns the momentum after 10 ms without the contribution of gravity."""
    run = build(load(scenario(*environment, **parts))).simulation.run(0.01)
    without = build(load(scenario(**parts))).simulation.run(0.01)
    return np.array(run.momentum[-1]) - np.array(without.momentum[-1])


def test_the_kind_alone_is_sufficient() -> None:
    drag, light = impulse("drag"), impulse("radiation_pressure")
    # a few tenths of a square metre, 4e-12 kg/m³, 7.2 km/s; 4.6 uPa
    assert 2e-7 < np.linalg.norm(drag[:3]) < 1e-5
    assert 5e-9 < np.linalg.norm(light[:3]) < 5e-8
    assert np.linalg.norm(drag[3:]) > 1e-9


def test_yaml_and_python_give_the_same_effects() -> None:
    plate = {"area": 0.1, "normal": [0, 0, 2], "centroid": ["10 cm", 0, 0]}
    yaml = {
        "kind": "drag", "atmosphere": {"kind": "nrlmsise00", "f107": 150, "f107a": 140, "ap": 12},
        "bodies": {
            "torso": {"kind": "cannonball", "area": "0.2 m^2", "drag_coefficient": 2.0},
            "arm_link_1": {"kind": "plates", "plates": [plate]},
            "arm_link_2": {"kind": "faces", "drag_coefficient": 2.5},
        },
    }  # fmt: skip
    built = build(load(scenario(yaml)))
    robot = built.model
    effect = oo.Drag(
        oo.Nrlmsise00(f107=150.0, f107a=140.0, ap=12.0),
        surfaces={
            "torso": oo.Cannonball(0.2, drag_coefficient=2.0),
            "arm_link_1": oo.Plates([0.1], [[0, 0, 2.0]], [[0.1, 0, 0]]),
            "arm_link_2": oo.Faces(drag_coefficient=2.5),
        },
    )
    sim = oo.Simulation(
        robot, built.q, built.v, orbit=built.orbit, earth=oo.Earth("2024-03-01T12:00:00 UTC"),
        environment=[effect], time_step=0.01,
    )  # fmt: skip
    assert np.array_equal(built.simulation.run(0.01).q, sim.run(0.01).q)


@pytest.mark.parametrize(
    "atmosphere",
    [
        "exponential",
        "harris_priester",
        {"kind": "harris_priester", "exponent": 2, "lag": "25 deg"},
        {"kind": "constant", "density": "2e-12 kg/m^3"},
        {"kind": "exponential", "density": "4e-12 kg/m^3", "altitude": "400 km", "scale_height": "58 km"},
        {"kind": "nrlmsise00", "f107": 150, "f107a": 140, "ap": [12, 12, 12, 12, 12, 12, 12]},
    ],
)
def test_every_atmosphere_slows_the_robot(atmosphere: Any) -> None:
    built = build(load(scenario({"kind": "drag", "atmosphere": atmosphere})))
    assert built.orbit is not None
    velocity = built.orbit.state(0.0)[1]
    push = impulse({"kind": "drag", "atmosphere": atmosphere})[:3]
    assert push @ velocity < -0.9 * np.linalg.norm(push) * np.linalg.norm(velocity)


def test_radiation_pressure_uses_its_settings() -> None:
    body = {"rigid_body": {"mass": 10.0, "inertia": [1.0, 2.0, 2.5]}}
    ball = {"kind": "cannonball", "area": "2 m^2", "reflectivity": 1.5}
    one = impulse({"kind": "radiation_pressure", "surfaces": ball, "shadow": False}, robot=body)
    two = impulse({"kind": "radiation_pressure", "surfaces": ball, "shadow": False, "flux": 2722}, robot=body)
    assert np.linalg.norm(two) == pytest.approx(2 * np.linalg.norm(one), rel=1e-6)
    assert np.linalg.norm(one) == pytest.approx(1361 / 299792458 * 3.0 * 0.01 * 1.018, rel=2e-3)  # 1 March
    huge = {"kind": "radiation_pressure", "surfaces": ball, "earth_radius": "6777 km"}
    assert np.linalg.norm(impulse(huge, robot=body)) <= np.linalg.norm(one)


def test_a_space_weather_table_is_found_beside_the_scenario(tmp_path: Path) -> None:
    (tmp_path / "sw.csv").write_text(
        "DATE,AP_AVG,F10.7_OBS,F10.7_OBS_CENTER81\n2024-02-29,12,150,139\n2024-03-01,12,151,140\n"
    )
    import yaml

    def written(**air: Any) -> Path:
        file = tmp_path / "run.yaml"
        file.write_text(
            yaml.safe_dump(scenario({"kind": "drag", "atmosphere": {"kind": "nrlmsise00"} | air}))
        )
        return file

    from_table = build(load(written(table="sw.csv"))).simulation.run(0.01)
    given = build(load(written(f107=150, f107a=140, ap=12))).simulation.run(0.01)
    assert np.array_equal(from_table.q, given.q)
    with pytest.raises(NotFoundError, match=r"environment\[0\].*none.csv"):
        build(load(written(table="none.csv")))


@pytest.mark.parametrize(
    ("environment", "parts", "error", "message"),
    [
        ({"kind": "drag", "atmosphere": "harris"}, {}, ScenarioError, "harris"),
        (air(kind="nrlmsise00", f107=150), {}, EffectError, "lacks f107a, ap"),
        (air(kind="constant", density=-1), {}, ScenarioError, "zero or above"),
        (air(kind="constant", density="1 kg"), {}, ScenarioError, "density"),
        ({"kind": "drag", "surfaces": {"kind": "cannonball", "area": -2}}, {}, ScenarioError, "or above"),
        ({"kind": "drag", "surfaces": {"kind": "cannonball", "area": 2}}, {}, EffectError, "name the one"),
        ({"kind": "drag", "surfaces": "faces", "bodies": {"torso": "faces"}}, {}, ScenarioError, "both"),
        ({"kind": "drag", "bodies": {"torsso": "faces"}}, {}, OnOrbitError, "torso"),
        ({"kind": "radiation_pressure", "surfaces": SHINY}, {}, EffectError, "more than 1"),
        ("radiation_pressure", {"epoch": None}, EffectError, "epoch"),
        ("drag", {"epoch": None}, EffectError, "rotation of the Earth"),
    ],
)  # fmt: skip
def test_errors_state_the_place_and_a_fix(environment: Any, parts: Any, error: Any, message: str) -> None:
    with pytest.raises(error, match=message) as caught:
        build(load(scenario(environment, **parts)))
    assert isinstance(caught.value, OnOrbitError)
