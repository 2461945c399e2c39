"""Tracking errors of PID controllers of joint rates: summary, labels, figures and viewer."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from test_figures import labels
from test_scenario_controllers import crane, run

from onorbit_rs import figures, viewer
from onorbit_rs.cli.summary import print_summary
from onorbit_rs.report.numbers import row
from onorbit_rs.scenario.build import build
from onorbit_rs.scenario.load import check
from onorbit_rs.viewer.series import series_of
from onorbit_rs.viewer.trace_rows import TraceRows

PATH = {"kind": "joint_waypoints", "points": [{"slide": 0.3, "turn": 0.3}], "times": [0.3]}
RATES = {"kind": "joint_pid", "interface": "velocity", "p": 2.0}


def test_errors_of_rates_have_the_units_of_rates(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    listed = {"name": "arm", "reference": PATH} | RATES
    several = run(crane(tmp_path, controllers=[listed]))
    errors = np.abs(several.trace.tracking["arm"]).max(axis=0)
    alone = run(crane(tmp_path, controller=RATES, reference=PATH))
    for summary, owner in ((several.summary, "_arm"), (alone.summary, "")):
        found = {key: value for key, value in summary.items() if "joint" in key and "error" in key}
        assert found == {
            f"tracking{owner}_joint_rate_error_max_rad_s": errors[0],
            f"tracking{owner}_joint_rate_error_max_m_s": errors[1],
        }
    print_summary(several.summary, None)
    lines = capsys.readouterr().out.splitlines()
    assert any(line.startswith("arm: joint rate error, largest") and "rad/s" in line for line in lines)
    found = row("tracking_arm_joint_rate_error_max_m_s", 4.2e-5)
    assert (found.name, found.unit) == ("arm: prismatic joint rate error, largest", "µm/s")


def test_efforts_have_no_errors(tmp_path: Path) -> None:
    effort = {"kind": "joint_pid", "interface": "effort"}
    path = PATH | {"points": [{"slide": 0.0, "turn": 0.01}]}
    for parts in ({"controllers": [{"name": "arm", "reference": path} | effort]},
                  {"controller": effort, "reference": path}):  # fmt: skip
        assert not any("error_max" in key for key in run(crane(tmp_path, **parts)).summary)


def test_figures_and_viewer_show_the_units_of_rates(tmp_path: Path) -> None:
    data = crane(tmp_path, controllers=[{"name": "arm", "reference": PATH} | RATES])
    made = run(data)
    scenario = made.scenario
    subject = figures.subject_of(made.trace, scenario, made.model, None, None)
    (drawing,) = (one for one in figures.drawings(subject) if one.name == "joint_errors")
    assert drawing.caption == "Desired minus obtained rates of the joints."
    assert all("joint rate error" in label for label in labels(drawing.draw()) if "time" not in label)
    setting = viewer.Setting.of(build(check(data, None, {})))
    (plot,) = (one for one in series_of(TraceRows.of_trace(made.trace), setting) if "tracking" in one.path)
    assert (plot.title, plot.unit) == ("arm: joint rate errors", "rad/s or m/s")
