"""Gravity fields through the public API, against independent numbers."""

from __future__ import annotations

import json
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.exceptions import GravityError, NotFoundError, ReadError
from onorbit_rs.tools.validation import fields as typed
from onorbit_rs.tools.validation import gravity
from onorbit_rs.tools.validation.case import table
from onorbit_rs.tools.validation.nasa import MU, TYPICAL, iss

FIXTURE = json.loads((Path(__file__).parent / "fixtures" / "gravity.json").read_text())
ISS = iss()
MODELS = Path(__file__).parents[1] / "crates" / "core" / "src" / "gravity" / "models"


def test_values_and_gradients_agree_with_a_hundred_digits() -> None:
    field = oo.GravityField("egm2008")
    assert (field.degree, field.order, field.mu, field.radius) == (36, 36, MU, 6378136.3)
    r = np.array([case["r"] for case in FIXTURE["values"]])
    for name, got in (("acceleration", field.acceleration(r)), ("gradient", field.gradient(r))):
        for one, case in zip(got, FIXTURE["values"], strict=True):
            expected = np.array(case[name])
            assert np.linalg.norm(one - expected) < 1e-14 * np.linalg.norm(expected)
    assert np.array_equal(field.acceleration(r[0]), field.acceleration(r)[0])
    assert np.array_equal(field.gradient(r[0]), field.gradient(r)[0])


def test_a_field_can_be_pickled() -> None:
    c = np.zeros((4, 4))
    c[2, 0] = -4.8e-4
    c[3, 1] = 2e-6
    fields = [
        oo.GravityField("jgm3", degree=12),
        oo.GravityField.zonal(3),
        oo.GravityField.zonal(j=[1e-3], mu=1e13, radius=2e6),
        oo.GravityField.from_coefficients(c, 0 * c, mu=MU, radius=6.4e6),
    ]
    r = [7e6, 1e6, 2e6]
    for field in fields:
        again = pickle.loads(pickle.dumps(field))
        assert repr(again) == repr(field)
        assert np.array_equal(again.acceleration(r), field.acceleration(r))


def test_a_gfc_file_is_read_and_a_damaged_one_rejected(tmp_path: Path) -> None:
    rows = ["gfc 0 0 1 0", "gfc 2 0 -4.84D-04 0", "gfc 2 1 0 0", "gfc 2 2 2.4D-06 -1.4D-06"]
    head = [
        "product_type gravity_field",
        "modelname tiny",
        f"earth_gravity_constant {MU}",
        "radius 6378136.3",
    ]
    file = tmp_path / "tiny.gfc"

    def write(rows: list[str]) -> Path:
        file.write_text("\n".join([*head, "max_degree 2", "errors no", "end_of_head", *rows]))
        return file

    field = oo.GravityField.from_gfc(write(rows))
    assert (field.name, field.degree, field.order) == ("tiny", 2, 2)
    with pytest.raises(GravityError, match="truncated") as cut:
        oo.GravityField.from_gfc(write(rows[:3]))
    assert cut.value.path == str(file)
    with pytest.raises(GravityError, match=r"tiny.gfc:10: the row is 'gfc 2 1 0'") as row:
        oo.GravityField.from_gfc(write([*rows[:2], "gfc 2 1 0", rows[3]]))
    assert row.value.line == 10


def test_a_field_file_that_cannot_be_read_is_reported(tmp_path: Path) -> None:
    with pytest.raises(NotFoundError, match=r"none\.gfc: there is no such file; check the path$") as missing:
        oo.GravityField.from_gfc(tmp_path / "none.gfc")
    assert missing.value.path == str(tmp_path / "none.gfc")
    with pytest.raises(ReadError, match=r"cannot be read: it is a folder; give the path of a file$"):
        oo.GravityField.from_gfc(tmp_path)
    (tmp_path / "latin.gfc").write_bytes(b"modelname T\xfcbingen")
    with pytest.raises(ReadError, match="not UTF-8"):
        oo.GravityField.from_gfc(tmp_path / "latin.gfc")


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: oo.GravityField("egm08"), "give one of the names egm2008, jgm3, zonal"),
        (lambda: oo.GravityField("egm2008", degree=71), "ends at degree 70"),
        (
            lambda: oo.GravityField("egm2008", degree=8, order=9),
            "order is 9; it must be at most the degree, which is 8",
        ),
        (lambda: oo.GravityField("egm2008", degree=-1), "degree is -1"),
        (lambda: oo.GravityField.zonal(7), "is 7; it must be from 2 to 6"),
        (lambda: oo.GravityField.zonal(j=[1e-3], mu=-1.0, radius=1.0), "mu is -1"),
        (lambda: oo.GravityField.zonal(j=[1e-3]), "all of j, mu and radius"),
        (lambda: oo.GravityField.zonal(2).acceleration([6.2e6, 0, 0]), "below the surface"),
        (lambda: oo.GravityField.zonal(2).acceleration([np.nan, 0, 0]), "finite"),
    ],
)
def test_invalid_fields_are_rejected(make: Any, message: str) -> None:
    with pytest.raises(GravityError, match=message):
        make()


def test_a_field_requires_its_planet_and_its_rotation() -> None:
    orbit = oo.Kepler.from_state(*TYPICAL, mu=MU)
    q, v = ISS.neutral(), np.zeros(6)

    def simulation(field: Any, orbit: Any = orbit, **more: Any) -> Any:
        return oo.Simulation(ISS, q, v, orbit=orbit, environment=[field], **more)

    with pytest.raises(GravityError, match="give an 'earth'"):
        simulation(oo.GravityField("egm2008"))
    simulation(oo.GravityField.zonal())
    simulation(oo.GravityField("egm2008"), earth=oo.Earth(rotation="about_z"))
    with pytest.raises(GravityError, match="mu of the orbit is") as other:
        simulation(oo.GravityField.zonal(j=[1e-3], mu=4.9e12, radius=1.7e6))
    assert (other.value.got, other.value.expected) == (MU, 4.9e12)
    with pytest.raises(oo.exceptions.OrbitError, match="requires an orbit"):
        simulation(oo.GravityField.zonal(), orbit=None)
    with pytest.raises(GravityError, match=r"^3 gravity fields are given: .*, .*, .*; give only one"):
        oo.Simulation(ISS, q, v, orbit=orbit, environment=[oo.GravityField.zonal()] * 3)


def test_gmat_distinguishes_permanent_tide_and_polar_motion() -> None:
    """GMAT's JGM-3 is free of the permanent tide, ICGEM's (bundled) has it: C20 differs by 4.17e-9.

    Negative controls to ``onorbit_rs.tools.validation.gravity``: with the tide, without the pole's motion,
    about the pole of J2000.
    """
    still = oo.Earth("2000-01-01T12:00:00 TAI", ut1_minus_utc=0.3554)
    for expected, degree, order in ((gravity.GMAT_12, 12, 12), (gravity.GMAT_J2, 2, 0)):

        def off(field: oo.GravityField, earth: oo.Earth, expected: Any = expected) -> float:
            return float(np.linalg.norm(gravity.after_a_day(field, earth) - expected))

        tide_free = typed.field("jgm3", degree, order)
        assert off(oo.GravityField("jgm3", degree=degree, order=order), gravity.earth_2000()) > 10.0
        assert off(tide_free, still) > 1.5
        assert off(tide_free, oo.Earth(rotation="about_z")) > 80.0


def test_the_table_of_jgm3_equals_the_bundled_one_except_for_the_tide() -> None:
    rows = [line.split()[1:] for line in (MODELS / "jgm3.gfc").read_text().splitlines() if line[:4] == "gfc "]
    bundled = {(int(n), int(m)): (float(c), float(s)) for n, m, c, s, *_ in rows if 2 <= int(n) <= 12}
    ours = {(int(row["n"]), int(row["m"])): (float(row["C"]), float(row["S"])) for row in table("jgm3")}
    assert len(ours) == 13 * 14 // 2 - 3
    differing = {nm for nm in ours if ours[nm] != bundled[nm]}
    assert differing == {(2, 0)}
    assert ours[2, 0][0] - bundled[2, 0][0] == pytest.approx(4.17e-9, rel=2e-3)


def test_the_scenario_builds_the_field(tmp_path: Path) -> None:
    text = """
robot: {rigid_body: {mass: 100, inertia: [[1, 0, 0], [0, 2, 0], [0, 0, 3]]}}
orbit: {kind: kepler, semi_major_axis: 7000 km, inclination: 50 deg}
epoch: 2024-03-01T12:00:00 UTC
environment:
  - {kind: gravity_field, model: MODEL, degree: 12}
  - gravity_gradient
simulation: {duration: 10 s, time_step: 1 s}
"""
    file = tmp_path / "field.yaml"

    def moved(model: str, degree: str = "12") -> Any:
        file.write_text(text.replace("MODEL", model).replace("degree: 12", f"degree: {degree}"))
        return oo.run(file, out=None).trace.position_eci[-1]

    egm, jgm, zonal = moved("egm2008"), moved("jgm3"), moved("zonal", "2")
    assert 1e-7 < np.linalg.norm(egm - jgm) < 1e-4
    assert 1e-4 < np.linalg.norm(egm - zonal) < 1e-1
    with pytest.raises(GravityError, match=r"field.yaml:6: environment\[0\]: degree 80") as error:
        moved("egm2008", "80")
    assert error.value.name == "degree"
    with pytest.raises(GravityError, match="no gravity model is named"):
        moved("egm08")
    with pytest.raises(oo.exceptions.ScenarioError, match="degree: 1 is below the minimum, 2"):
        moved("egm2008", "1")
