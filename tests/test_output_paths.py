"""The resolved scenario of a run contains the absolute paths of all files."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

import onorbit_rs as oo
from onorbit_rs.output import scenario_digest, with_absolute_paths
from onorbit_rs.scenario import load

GFC = """product_type gravity_field
modelname two
earth_gravity_constant 3.986004415E+14
radius 6378136.3
max_degree 2
norm fully_normalized
key L M C S
end_of_head
gfc 0 0 1.0 0.0
gfc 1 0 0.0 0.0
gfc 1 1 0.0 0.0
gfc 2 0 -4.84165e-04 0.0
gfc 2 1 0.0 0.0
gfc 2 2 2.4e-06 -1.4e-06
"""
EOP = "mjd,x_arcsec,y_arcsec,ut1_minus_utc_s\n" + "".join(
    f"{day},0.1,0.2,-0.01\n" for day in range(60_365, 60_380)
)
WEATHER = "DATE,F10.7_OBS,F10.7_OBS_CENTER81,AP_AVG\n" + "".join(
    f"2024-03-{day:02d},150.0,150.0,12\n" for day in range(1, 5)
)
FILES = {"two.gfc": GFC, "eop.csv": EOP, "weather.csv": WEATHER}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    here = tmp_path / "here"
    here.mkdir()
    for name, text in FILES.items():
        (here / name).write_text(text)
    air = {"kind": "nrlmsise00", "table": "weather.csv", "three_hourly": False}
    data: dict[str, Any] = {
        "robot": "humanoid_torso", "epoch": "2024-03-02T12:00:00 UTC", "earth": {"eop": "eop.csv"},
        "orbit": {"kind": "kepler", "semi_major_axis": "6778 km"},
        "environment": [{"kind": "gravity_field", "model": "two.gfc"}, {"kind": "drag", "atmosphere": air}],
        "simulation": {"duration": 0.01, "time_step": 0.01},
    }  # fmt: skip
    (here / "mine.yaml").write_text(json.dumps(data))
    return here


def test_a_resolved_scenario_with_tables_runs_from_another_folder(folder: Path, tmp_path: Path) -> None:
    first = oo.run(folder / "mine.yaml", out=tmp_path / "out", quiet=True)
    again = oo.run(tmp_path / "out" / "scenario.yaml", quiet=True)
    assert again.trace.v.tobytes() == first.trace.v.tobytes()


@pytest.mark.parametrize("name", FILES)
def test_a_changed_file_changes_the_digest_of_the_scenario(folder: Path, name: str) -> None:
    def digest() -> str:
        return scenario_digest(with_absolute_paths(load(folder / "mine.yaml")))

    before = digest()
    assert digest() == before
    (folder / name).write_text(FILES[name] + "\n")
    assert digest() != before


def test_only_file_names_become_absolute_paths(folder: Path) -> None:
    data = json.loads((folder / "mine.yaml").read_text())
    data["environment"][0]["model"] = "egm2008"
    data["earth"] = {"ephemeris": "de440.bsp"}
    (folder / "mine.yaml").write_text(json.dumps(data))
    scenario = load(folder / "mine.yaml")
    resolved, as_given = with_absolute_paths(scenario), scenario.resolved()
    assert resolved["environment"][0]["model"] == "egm2008"
    assert resolved["earth"]["ephemeris"] == str(folder / "de440.bsp")
    assert as_given["earth"]["ephemeris"] == "de440.bsp"
