"""Comparison of two runs: differences, the time of divergence, and notes."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from commands import onorbit
from results import listed

import onorbit_rs as oo
from onorbit_rs.exceptions import CompareError, DtypeError, InputError, NotFoundError, ReadError
from onorbit_rs.figures import differences
from onorbit_rs.scenario import load
from onorbit_rs.tools.comparison.alignment import aligned_rows
from onorbit_rs.tools.comparison.quantities import _length
from onorbit_rs.tools.comparison.recorded import Recorded


@pytest.fixture(autouse=True)
def without_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("onorbit_rs.simulation.finish.write_pictures", lambda *_, **__: None)


def scenario(name: str = "humanoid_reach", **simulation: Any) -> dict[str, Any]:
    data = load(name).resolved()
    data["simulation"] |= {"duration": 0.5, "time_step": 0.002} | simulation
    return data


def spin(rate: float, duration: float = 10.0, **simulation: Any) -> dict[str, Any]:
    """Returns a sphere that rotates about z at this rate and moves along x at twice the rate."""
    return {
        "robot": {"rigid_body": {"mass": 2.0, "inertia": [[3, 0, 0], [0, 3, 0], [0, 0, 3]]}},
        "initial": {"linear_velocity": [2.0 * rate, 0, 0], "angular_velocity": [0, 0, rate]},
        "simulation": {"duration": duration, "time_step": 0.1} | simulation,
    }


def test_differences_are_those_of_the_closed_form() -> None:
    """Rates of 0.1 and 0.11 rad/s differ by 0.1 rad and 0.2 m after 10 s and diverge beyond 0.01 rad."""
    compared = oo.compare(spin(0.1), spin(0.11), tolerance=0.0105)
    attitude, position = compared["base attitude"], compared["base position"]
    np.testing.assert_allclose(attitude.values, 0.01 * compared.time, atol=1e-12)
    np.testing.assert_allclose(position.values, 0.02 * compared.time, atol=1e-12)
    assert attitude.largest == attitude.final == pytest.approx(0.1)
    assert attitude.largest_at == 10.0
    assert attitude.parts_at == pytest.approx(1.1)
    # the tolerance is relative to the largest position, 2.2 m
    assert position.allowed == pytest.approx(0.0105 * 2.2)
    assert position.parts_at == pytest.approx(1.2)
    assert compared["linear momentum"].largest == pytest.approx(2.0 * 0.02)
    assert compared["angular momentum"].largest == pytest.approx(3.0 * 0.01)
    # ½ m v² + ½ I w²
    assert compared["kinetic energy"].largest == pytest.approx((4.0 + 1.5) * (0.11**2 - 0.1**2))
    assert not compared.agrees
    assert compared.parts_at == 0.0  # the momentum differs from the start
    assert "joints" not in [difference.name for difference in compared.differences]


def test_a_run_agrees_with_itself_and_with_its_folder(tmp_path: Path) -> None:
    run = oo.run(scenario(), tmp_path / "out")
    compared = oo.compare(run, str(tmp_path / "out"), tolerance=1e-300)
    assert compared.agrees
    assert compared.parts_at is None
    assert compared.notes == ()
    assert {difference.largest for difference in compared.differences} == {0.0}
    assert len(compared.differences) == 11


def orbiting(radius: float, **simulation: Any) -> dict[str, Any]:
    orbit = {"kind": "kepler", "semi_major_axis": radius, "inclination": 1.7}
    data = spin(0.1, 100.0, **({"time_step": 1.0} | simulation)) | {"orbit": orbit}
    return data | {"initial": {"angular_velocity": [0.01, 0.02, 0.0]}}


def test_runs_on_different_orbits_diverge_despite_equal_motion_in_w() -> None:
    compared = oo.compare(orbiting(7.0e6), orbiting(9.0e6))
    assert compared["base position"].largest < 1e-3
    assert compared["inertial position"].values[0] == pytest.approx(2.0e6)
    assert not compared.agrees
    assert "orbit.semi_major_axis differs: 7000000 and 9000000" in compared.notes


def test_orbits_two_metres_apart_diverge_regardless_of_their_radius() -> None:
    """A millionth of 7000 km is 7 m, but the robots are at their references, where 1 µm is relevant."""
    compared = oo.compare(orbiting(7.0e6), orbiting(7.0e6 + 2.0))
    position = compared["inertial position"]
    assert position.values[0] == pytest.approx(2.0)
    assert position.parts_at == 0.0
    assert position.allowed == pytest.approx(1.1e-6, rel=0.02)  # plus the rounding of the orbit
    assert not compared.agrees


def test_a_tilt_below_rounding_is_not_a_divergence() -> None:
    """At 7000 km, 1e-15 rad are 7 nm, eight units in the last place."""
    tilted = orbiting(7.0e6)
    tilted["orbit"]["inclination"] += 1e-15
    compared = oo.compare(orbiting(7.0e6), tilted)
    assert 0.0 < compared["inertial position"].largest < 1e-7
    assert compared.agrees


def test_an_orbit_is_interpolated_with_its_curvature() -> None:
    """A chord of 20 s deviates by 400 m from the arc, the cubic by `h⁴ n⁴ r / 384 < 1 cm`."""
    compared = oo.compare(orbiting(7.0e6, record_every=7), orbiting(7.0e6, record_every=20))
    assert any("interpolated" in note for note in compared.notes)
    assert 1e-3 < compared["inertial position"].largest < 0.01
    assert compared["inertial position"].parts_at is None  # the error of the cubic is not a divergence
    compared = oo.compare(orbiting(7.0e6, record_every=7), orbiting(7.0e6 + 0.1, record_every=20))
    assert compared["inertial position"].parts_at is not None  # negative control: 10 cm are more


def test_settings_that_differ_are_noted_and_many_are_counted() -> None:
    a, b = scenario(), scenario()
    b["controller"]["kp"] = 99.0
    b["environment"] = []
    b["simulation"]["time_step"] = 0.001
    notes = oo.compare(a, b).notes
    assert any(note.startswith("controller.kp differs: ") and note.endswith(" and 99") for note in notes)
    assert "time_step differs: 0.002 and 0.001" in notes
    settings = scenario(), scenario()
    for one in settings:
        one["environment"] = []
    del settings[1]["orbit"]
    assert "orbit differs: kepler and none" in oo.compare(*settings).notes


def test_different_gains_first_affect_the_torque() -> None:
    other = scenario()
    other["controller"]["kp"] = 99.0
    compared = oo.compare(scenario(), other, tolerance=1e-9)
    parted = {difference.name: difference.parts_at for difference in compared.differences}
    assert min(parted, key=lambda name: np.inf if parted[name] is None else parted[name]) == "joint torques"


def test_control_a_finer_step_is_the_same_motion_at_common_instants() -> None:
    """Every second row of the finer run is compared without interpolation."""
    settings: dict[str, Any] = {"control_period": 0.002}
    compared = oo.compare(scenario(**settings), scenario(**settings, time_step=0.001))
    assert compared.notes == ("time_step differs: 0.002 and 0.001",)
    assert len(compared.time) == 251
    assert compared["base attitude"].largest < 1e-10


def test_rows_are_interpolated_with_a_note() -> None:
    """Steps of 0.1 and 0.13 s share one instant in thirteen; linear motion is interpolated exactly."""
    compared = oo.compare(spin(0.1), spin(0.1, time_step=0.13))
    assert compared.agrees
    assert compared["base attitude"].largest < 1e-12
    assert len(compared.time) == 101
    assert any("interpolated" in note for note in compared.notes)


def test_torques_are_held_between_rows() -> None:
    settings: dict[str, Any] = {"control_period": 0.01, "duration": 0.4}
    a, b = scenario(**settings, time_step=0.002), scenario(**settings, time_step=0.0033)
    compared = oo.compare(a, b, tolerance=1e-3)
    assert any("interpolated" in note for note in compared.notes)
    assert compared["joint torques"].largest < 1e-6


def test_runs_of_different_length_are_compared_until_the_shorter_ends() -> None:
    compared = oo.compare(spin(0.1), spin(0.1, duration=4.0))
    assert compared.agrees
    assert compared.time[-1] == 4.0
    assert any("ends at 10 s" in note and "until 4 s" in note for note in compared.notes)


def test_a_quantity_that_one_run_lacks_is_noted() -> None:
    data = load("free_tumble").resolved()
    data["simulation"] |= {"duration": 0.1}
    bare = {name: value for name, value in data.items() if name != "tool"}
    compared = oo.compare(data, bare)
    assert compared.agrees
    assert [note.split(":")[0] for note in compared.notes] == ["tool position", "tool attitude"]


def test_another_robot_is_noted_and_other_joints_are_rejected() -> None:
    heavy = spin(0.1)
    heavy["robot"] = {"rigid_body": {"mass": 3.0, "inertia": [[3, 0, 0], [0, 3, 0], [0, 0, 3]]}}
    compared = oo.compare(spin(0.1), heavy)
    assert compared["base position"].largest < 1e-15
    assert compared["linear momentum"].parts_at == 0.0
    assert any("robots differ" in note for note in compared.notes)
    with pytest.raises(CompareError, match=r"0 joints, but .* has 7"):
        oo.compare(spin(0.1), scenario())


def hinged(folder: Path, *joints: str, mass: float = 1.0) -> dict[str, Any]:
    """Returns a scenario of a base with one link per joint."""
    moments = "<inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/>"
    body = f"<inertial><mass value='{mass}'/>{moments}</inertial>"
    links = [f"<link name='{name}'>{body}</link>" for name in ("base", *(f"of_{joint}" for joint in joints))]
    hinges = [
        f"<joint name='{joint}' type='continuous'><parent link='base'/><child link='of_{joint}'/></joint>"
        for joint in joints
    ]
    file = folder / f"{'_'.join(joints)}_{mass}.urdf"
    file.write_text(f"<robot name='hinged'>{''.join(links + hinges)}</robot>")
    return spin(0.1, duration=0.5) | {"robot": {"urdf": str(file)}}


def test_joints_with_other_names_or_another_order_are_rejected(tmp_path: Path) -> None:
    one, other = hinged(tmp_path, "j"), hinged(tmp_path, "k")
    with pytest.raises(CompareError, match=r"joints differ: j in .*, and k in .*; only runs of") as refused:
        oo.compare(one, other)
    assert (refused.value.got, refused.value.expected) == (["k"], ["j"])
    oo.run(other, tmp_path / "out")
    with pytest.raises(CompareError, match=r"joints differ: j in .*, and k in .*;"):
        oo.compare(one, tmp_path / "out")
    with pytest.raises(CompareError, match=r"joints differ: j, k in .*, and k, j in .*;"):
        oo.compare(hinged(tmp_path, "j", "k"), hinged(tmp_path, "k", "j"))
    heavy = oo.compare(one, hinged(tmp_path, "j", mass=2.0))
    assert [note.split(":")[0] for note in heavy.notes] == ["the robots differ"]


def test_a_folder_whose_robot_file_is_missing_is_compared_with_a_note(tmp_path: Path) -> None:
    one, other = hinged(tmp_path, "j"), hinged(tmp_path, "j", mass=2.0)
    oo.run(other, tmp_path / "out")
    Path(other["robot"]["urdf"]).unlink()
    compared = oo.compare(one, tmp_path / "out")
    assert any("cannot check whether the joints of both robots are equal" in note for note in compared.notes)


def test_the_row_after_an_impact_is_compared() -> None:
    time = np.array([0.0, 1.0, 1.0, 2.0])
    columns = {"time": time, "q": np.eye(4, 7, 3), "tau": np.array([[0.0], [1], [2], [3]])}
    run = Recorded("bounce", columns, load("humanoid_reach"))
    rows, _, instants, _ = aligned_rows(run, run)
    assert instants.tolist() == [0.0, 1.0, 2.0]
    assert rows["tau"].ravel().tolist() == [0.0, 2.0, 3.0]


@pytest.mark.parametrize(
    "tolerance", [0.0, -1.0, float("nan"), float("inf"), True, "1", pytest.param(10**400, id="vast")]
)
def test_an_invalid_tolerance_is_rejected(tolerance: Any) -> None:
    with pytest.raises(InputError, match="tolerance is"):
        oo.compare(spin(0.1), spin(0.1), tolerance=tolerance)


@pytest.mark.parametrize("one", [np.int64(1), np.float32(1.0), Fraction(1)])
def test_every_number_type_is_accepted_for_tolerance_and_checkpoint_interval(one: Any) -> None:
    run = oo.run(spin(0.1), quiet=True, checkpoint_every=one)
    compared = oo.compare(run, run, tolerance=one)
    assert json.loads(json.dumps(compared.as_dict()))["tolerance"] == 1.0


def test_an_unknown_quantity_is_reported_with_the_available_ones() -> None:
    with pytest.raises(
        CompareError, match="'attitude' is not a compared quantity; available: base position, base"
    ):
        oo.compare(spin(0.1), spin(0.1))["attitude"]


def test_a_diverged_run_differs_and_converts_to_plain_data(tmp_path: Path) -> None:
    run = oo.run(spin(0.1), tmp_path / "out")
    broken = dict(np.load(tmp_path / "out" / "trace.npz"))
    broken["q"] = np.where(np.arange(101)[:, None] < 50, broken["q"], np.nan)
    np.savez(tmp_path / "out" / "trace.npz", **broken)
    listed(tmp_path / "out")
    compared = oo.compare(run, tmp_path / "out")
    assert compared["base position"].parts_at == pytest.approx(5.0)
    text = json.dumps(compared.as_dict(), allow_nan=False)
    assert json.loads(text)["differences"][0]["largest"] is None


@pytest.mark.parametrize(
    ("ours", "theirs", "parts_at"),
    [
        (1e200, 2e200, 5.0),  # squares overflow
        (1.5e308, -1.5e308, 5.0),  # the difference overflows
        (np.inf, np.inf, 5.0),
        (np.inf, 0.0, 5.0),
        (1e200, 1e200, None),
        (1e200, 1.0000001e200, None),
    ],
)
def test_runs_that_overflowed_do_not_agree(
    ours: float, theirs: float, parts_at: float | None, tmp_path: Path
) -> None:
    """Their lengths are infinite, and the tolerance once was, too."""
    for name, value in (("a", ours), ("b", theirs)):
        oo.run(spin(0.1), tmp_path / name)
        broken = dict(np.load(tmp_path / name / "trace.npz"))
        for column in ("q", "momentum"):
            broken[column][50:, :3] = value
        broken["kinetic_energy"][50:] = value
        np.savez(tmp_path / name / "trace.npz", **broken)
        listed(tmp_path / name)
    compared = oo.compare(tmp_path / "a", tmp_path / "b")
    assert np.isfinite([one.allowed for one in compared.differences]).all()
    for measure in ("base position", "linear momentum", "kinetic energy"):
        assert compared[measure].parts_at == (None if parts_at is None else pytest.approx(parts_at)), measure
    json.dumps(compared.as_dict(), allow_nan=False)
    assert differences(compared).axes


def test_lengths_are_those_of_numpy_and_do_not_overflow() -> None:
    rows = np.random.default_rng(1).normal(size=(50, 3))
    np.testing.assert_array_equal(_length(rows), np.linalg.norm(rows, axis=1))
    for size in (2.0**1020, 2.0**-1060):
        np.testing.assert_allclose(_length(rows[:5] * size) / size, _length(rows[:5]), rtol=1e-4)
    assert _length(np.zeros((2, 3))).tolist() == [0.0, 0.0]
    assert not np.isfinite(_length(np.array([[np.inf, 0, 0], [0, np.nan, 0]]))).any()


def test_an_argument_that_is_not_a_run_is_rejected_with_its_type() -> None:
    trace = oo.run(spin(0.1)).trace
    for kind, source in (("Trace", trace), ("int", 3), ("list", [])):
        with pytest.raises(DtypeError, match=f"a value of type {kind} cannot be compared; give the folder"):
            oo.compare(source)  # type: ignore[arg-type]


def test_a_comparison_prints_the_text_of_the_command() -> None:
    lines = str(oo.compare(spin(0.1), spin(0.11), tolerance=0.0105)).splitlines()
    assert lines[0] == "scenario (native) against scenario (native)"
    assert lines[1].split("  ")[-1] == "unit"
    assert lines[2].split() == ["base", "position", "2.0e-01", "10", "2.0e-01", "2.3e-02", "1.2", "m"]
    assert lines[-1] == "the runs diverge at t = 0 s by more than 0.0105; 101 rows from 0 to 10 s"
    assert "the runs agree within 1e-06 over 101 rows" in str(oo.compare(spin(0.1), spin(0.1)))


def test_folders_without_a_run_are_rejected(tmp_path: Path) -> None:
    with pytest.raises(NotFoundError, match="no trace in this folder"):
        oo.compare(tmp_path, tmp_path)
    oo.run(spin(0.1), tmp_path / "out")
    for spoilt in (b"", b"no zip"):
        (tmp_path / "out" / "trace.npz").write_bytes(spoilt)
        listed(tmp_path / "out")
        with pytest.raises(ReadError, match="cannot read"):
            oo.compare(tmp_path / "out", tmp_path / "out")


def test_the_figure_has_a_panel_per_quantity_and_marks_the_divergence() -> None:
    compared = oo.compare(spin(0.1), spin(0.11), tolerance=0.0105)
    panels = [axes for axes in differences(compared).axes if axes.get_visible()]
    assert [axes.get_title(loc="left") for axes in panels] == [one.name for one in compared.differences]
    dots = [line for line in panels[1].lines if line.get_marker() == "o"]
    assert [float(dot.get_xdata()[0]) for dot in dots] == [pytest.approx(1.1)]  # type: ignore[index]
    same = differences(oo.compare(spin(0.1), spin(0.1)))
    assert not any(line.get_marker() == "o" for axes in same.axes for line in axes.lines)


def test_the_command_reports_whether_and_when_runs_diverge(tmp_path: Path) -> None:
    files = []
    for rate in (0.1, 0.11):
        files.append(tmp_path / f"{rate}.yaml")
        files[-1].write_text(json.dumps(spin(rate)))
    picture = tmp_path / "apart.png"
    done = onorbit("compare", files[0], files[1], "--out", picture)
    assert done.returncode == 1, done.stderr
    assert "the runs diverge at t = 0 s by more than 1e-06" in done.stdout
    assert "base attitude" in done.stdout
    assert picture.read_bytes()[:4] == b"\x89PNG"
    same = onorbit("compare", files[0], files[0], "--tolerance", "1e-12")
    assert same.returncode == 0
    assert "the runs agree within 1e-12 over 101 rows from 0 to 10 s" in same.stdout
    as_json = onorbit("compare", files[0], files[1], "--json")
    assert as_json.returncode == 1
    data = json.loads(as_json.stdout)
    assert not data["agrees"]
    assert data["differences"][1]["name"] == "base attitude"
    assert data["differences"][1]["largest"] == pytest.approx(0.1)


def test_the_command_reports_errors_in_one_line(tmp_path: Path) -> None:
    file = tmp_path / "ball.yaml"
    file.write_text(json.dumps(spin(0.1)))
    for arguments in (
        ("no_such_scenario", file),
        (file, tmp_path),
        (file, file, "--tolerance", "0"),
        (file, file, "--out", tmp_path / "none" / "apart.png"),
        (file, file, "--out", tmp_path / "apart.xyz"),
        (file, "humanoid_reach"),
    ):
        done = onorbit("compare", *arguments)
        assert done.returncode == 2, done
        assert len(done.stderr.splitlines()) == 1, done.stderr
        assert "Traceback" not in done.stderr


def test_without_a_second_run_the_other_engine_is_compared(tmp_path: Path) -> None:
    pytest.importorskip("mujoco", reason="MuJoCo is not installed: pip install 'onorbit-rs[mujoco]'")
    file = tmp_path / "reach.yaml"
    file.write_text(json.dumps(scenario()))
    done = onorbit("compare", file, "--tolerance", "1e-10")
    assert done.returncode == 0, done
    assert "humanoid_reach (mujoco) against humanoid_reach (native)" in done.stdout
