"""A failed certificate is reported on the terminal in red, in the summary and by the exit code.

``test_scenario_bundled`` checks that every bundled scenario passes.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from commands import onorbit

import onorbit_rs as oo
from onorbit_rs.scenario import load

RED, GREEN = "\x1b[31m", "\x1b[32m"
BROKEN: dict[str, tuple[str, dict[str, Any], str, str]] = {
    "energy": ("free_tumble", {"duration": 10.0, "time_step": 0.1}, "energy_balance_error_rel", "0.1 s"),
    "attitude": ("kepler_orbit", {"time_step": 400.0}, "attitude_consistency", "400 s"),
    "step": ("kepler_orbit", {"time_step": 100.0}, "attitude_step_doubling_rad", "100 s"),
    "orbit": ("sgp4_orbit", {"time_step": 300.0}, "energy_balance_error_rel", "300 s"),
    "tolerance": (
        "free_tumble", {"duration": 10.0, "integrator": "dormand_prince", "tolerance": 1e-3},
        "center_of_mass_error_rel", "a smaller tolerance",
    ),
}  # fmt: skip


@pytest.fixture(autouse=True)
def in_colour(monkeypatch: pytest.MonkeyPatch) -> None:
    """Turns on colours as on a terminal."""
    monkeypatch.delenv("NO_COLOR", raising=False)
    monkeypatch.setenv("FORCE_COLOR", "1")


def written(folder: Path, name: str, change: dict[str, Any]) -> Path:
    data = load(name).resolved()
    data["simulation"] |= change
    file = folder / "mine.yaml"
    file.write_text(json.dumps(data))  # JSON is YAML
    return file


@pytest.mark.parametrize("what", BROKEN)
def test_a_failed_certificate_is_reported_everywhere(what: str, tmp_path: Path) -> None:
    name, change, check, way_out = BROKEN[what]
    done = onorbit("run", written(tmp_path, name, change))
    assert done.returncode == 1
    assert f"{RED}certificate FAILED" in done.stdout and check in done.stdout
    assert f"{RED}BROKEN" in done.stdout and "certificate passed" not in done.stdout
    (line,) = done.stderr.splitlines()
    assert line.startswith("onorbit: the certificate failed (") and check in line
    assert line.endswith(way_out)


@pytest.mark.usefixtures("no_pictures")
def test_results_of_a_failed_run_are_kept_with_its_verdict(tmp_path: Path) -> None:
    name, change, check, _ = BROKEN["energy"]
    out = tmp_path / "out"
    assert onorbit("run", written(tmp_path, name, change), "--out", out).returncode == 1
    summary = json.loads((out / "summary.json").read_text())
    assert summary["certificate_passed"] is False and check in summary["certificate_failures"]
    assert summary["status"] == "complete" and (out / "trace.npz").is_file()


def test_a_quiet_run_reports_the_failure_too(tmp_path: Path) -> None:
    name, change, *_ = BROKEN["energy"]
    done = onorbit("run", written(tmp_path, name, change), "--quiet")
    assert (done.returncode, done.stdout) == (1, "")
    assert "the certificate failed" in done.stderr


def test_the_same_run_with_its_normal_step_passes(tmp_path: Path) -> None:
    done = onorbit("run", written(tmp_path, "free_tumble", {"duration": 10.0}))
    assert (done.returncode, done.stderr) == (0, "")
    assert f"{GREEN}certificate passed" in done.stdout


def test_the_summary_names_every_check_that_failed() -> None:
    name, change, *_ = BROKEN["attitude"]
    data = load(name).resolved()
    data["simulation"] |= change
    result = oo.run(data, quiet=True)
    failed = {check for check, _, _, passed in result.trace.certificate() if not passed}
    assert failed and set(result.summary["certificate_failures"].split(", ")) == failed
    assert result.summary["certificate_passed"] is False
    for check, value, gate, passed in result.trace.certificate():
        assert result.summary[check] == value
        assert passed is (value is not None and value <= gate)


@pytest.mark.parametrize("time_step", [1.0, 0.1])
def test_quantities_at_rest_are_not_judged_by_their_rounding_errors(time_step: float) -> None:
    """The gravity gradient has no effect on a spherically symmetric body: its energy is rounding only."""
    model = oo.Model.rigid_body(100.0, np.diag([10.0, 10.0, 10.0]))
    orbit = oo.Kepler(semi_major_axis=6778e3, eccentricity=0.0, inclination=0.5)
    at_rest = oo.Simulation(
        model, model.neutral(), np.zeros(6), orbit=orbit, environment=[oo.GravityGradient()],
        time_step=time_step,
    )  # fmt: skip
    assert all(passed for *_, passed in at_rest.run(600.0).certificate())


SLIDER = """<robot name="slider">
  <link name="bus"><inertial><mass value="10"/>
    <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="rod"><inertial><mass value="1"/>
    <inertia ixx=".1" iyy=".1" izz=".1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="s" type="prismatic"><parent link="bus"/><child link="rod"/><axis xyz="{axis}"/>
    <limit lower="-5" upper="5" effort="9" velocity="9"/></joint>
</robot>"""


@pytest.mark.parametrize("axis", ["0 1 0", "0 1 1", "1 2 3", "0.3 0.5 0.2"])
@pytest.mark.parametrize("time_step", [1e-2, 1e-4])
def test_a_slider_through_the_centre_of_mass_rotates_nothing(
    axis: str, time_step: float, tmp_path: Path
) -> None:
    file = tmp_path / "slider.urdf"
    file.write_text(SLIDER.format(axis=axis))
    model = oo.Model.from_urdf(file)
    v = np.zeros(7)
    v[6] = 0.1
    trace = oo.Simulation(model, model.neutral(), v, time_step=time_step).run(2.0)
    assert all(passed for *_, passed in trace.certificate())
