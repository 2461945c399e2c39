"""A whole run: its return value, its files, and running its resolved scenario again."""

from __future__ import annotations

import inspect
import json
import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.exceptions import OutputFolderError, OutputNotEmptyError, RunInterrupted, SimulationError
from onorbit_rs.output.names import NAMES
from onorbit_rs.output.summary import summarize
from onorbit_rs.scenario import load
from onorbit_rs.simulation import finish


def short_reach(**simulation: Any) -> dict[str, Any]:
    data = load("humanoid_reach").resolved()
    data["simulation"] |= {"duration": 0.5, "time_step": 2e-3} | simulation
    return data


@pytest.fixture(scope="module")
def reach(tmp_path_factory: pytest.TempPathFactory) -> oo.Run:
    return oo.run(short_reach(), out=tmp_path_factory.mktemp("run") / "out", quiet=True)


def test_the_folder_holds_the_documented_files(reach: oo.Run) -> None:
    assert reach.out is not None
    names = {str(file.relative_to(reach.out)) for file in reach.out.rglob("*") if file.is_file()}
    assert {"summary.json", "trace.npz", "run.rrd", "scenario.yaml"} <= names
    assert {f"figures/{name}.png" for name in (
        "fig4_desired_trajectory", "fig5_obtained_trajectory", "fig6_tracking_errors", "fig7_joint_torques",
        "manipulability", "base_motion", "base_reaction", "ledger",
    )} <= names  # fmt: skip
    assert not any("partial" in name for name in names)


def test_every_status_that_is_written_is_documented() -> None:
    written = set(
        re.findall(
            r'"(\w+)"', "".join(re.findall(r"(?:_write_rows\(|status = ).*", inspect.getsource(finish)))
        )
    )
    assert written >= {"failed", "diverged", "interrupted"}
    for status in written | {"complete"}:
        assert f"``{status}``" in str(summarize.__doc__), status


def test_the_trace_file_equals_the_trace(reach: oo.Run) -> None:
    assert reach.out is not None
    with np.load(reach.out / "trace.npz") as stored:
        assert set(stored.files) == {*reach.trace.columns(), *NAMES}
        for name in reach.trace.columns():
            np.testing.assert_array_equal(stored[name], getattr(reach.trace, name))


def test_the_summary_is_flat_and_has_the_documented_entries(reach: oo.Run) -> None:
    assert reach.out is not None
    summary = json.loads((reach.out / "summary.json").read_text())
    assert summary == reach.summary
    assert not any(isinstance(value, (dict, list)) for value in summary.values())
    for key in (
        "tracking_position_error_max_m", "tracking_attitude_error_max_rad", "joint_torque_max_nm",
        "base_rotation_max_rad", "linear_momentum_drift_rel", "angular_momentum_drift_rel",
        "energy_balance_error_rel", "simulated_s", "wall_s", "real_time_factor",
    ):  # fmt: skip
        assert math.isfinite(summary[key]), key
    assert summary["simulated_s"] == pytest.approx(0.5, abs=1e-12)
    assert summary["real_time_factor"] == pytest.approx(0.5 / summary["wall_s"], rel=1e-12)
    assert summary["onorbit_rs_version"] and summary["instruction_set"]
    error = np.linalg.norm(reach.trace.position_error, axis=1).max()
    assert summary["tracking_position_error_max_m"] == error


def test_the_resolved_scenario_gives_the_same_bits(reach: oo.Run) -> None:
    assert reach.out is not None
    again = oo.run(reach.out / "scenario.yaml", quiet=True)
    np.testing.assert_array_equal(again.trace.q, reach.trace.q)
    np.testing.assert_array_equal(again.trace.tau, reach.trace.tau)


def test_a_robot_file_beside_the_yaml_is_found_from_its_resolved_scenario(tmp_path: Path) -> None:
    (tmp_path / "here").mkdir()
    urdf = Path(oo.robots.path("humanoid_torso")).read_text()
    (tmp_path / "here" / "mine.urdf").write_text(urdf)
    data = short_reach() | {"robot": "mine.urdf"}
    file = tmp_path / "here" / "mine.yaml"
    file.write_text(json.dumps(data))  # JSON is YAML
    first = oo.run(file, out=tmp_path / "out", quiet=True)
    again = oo.run(tmp_path / "out" / "scenario.yaml", quiet=True)
    np.testing.assert_array_equal(again.trace.q, first.trace.q)


def test_without_out_nothing_is_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    result = oo.run(short_reach(duration=0.02), quiet=True)
    assert result.out is None and not list(tmp_path.iterdir())


def test_a_folder_in_use_is_rejected_before_the_run(tmp_path: Path) -> None:
    (tmp_path / "mine.txt").write_text("precious")
    with pytest.raises(OutputNotEmptyError):
        oo.run(
            short_reach(duration=1e5, record_every=1000), out=tmp_path, quiet=True
        )  # the run would take minutes


def test_an_invalid_scenario_creates_no_folder(tmp_path: Path) -> None:
    data = short_reach() | {"tool": "toll"}
    with pytest.raises(oo.exceptions.FrameError, match="tool"):
        oo.run(data, out=tmp_path / "out", quiet=True)
    assert not (tmp_path / "out").exists()


def diverging() -> dict[str, Any]:
    """Returns a scenario with an extreme wrench that makes the state overflow within a few steps."""
    data = load("free_tumble").resolved()
    data["environment"] = [
        {"kind": "body_wrench", "body": "torso", "force": [0, 0, 0], "torque": [1e9, 1e9, 0]}
    ]
    data["simulation"] = {"duration": 10.0, "time_step": 0.1}
    return data


def test_a_diverged_run_keeps_its_trace(tmp_path: Path) -> None:
    with pytest.raises(SimulationError, match="the trace up to this time is in") as caught:
        oo.run(diverging(), out=tmp_path / "out", quiet=True)
    assert isinstance(caught.value, ArithmeticError)
    assert 0.0 < caught.value.time < 10.0
    with np.load(tmp_path / "out" / "trace.npz") as stored:
        assert len(stored["time"]) > 0 and np.all(np.isfinite(stored["q"]))
    assert json.loads((tmp_path / "out" / "summary.json").read_text())["status"] == "diverged"


def test_an_interrupted_run_keeps_its_trace(tmp_path: Path) -> None:
    import _thread
    import threading

    timer = threading.Timer(0.5, _thread.interrupt_main)
    timer.start()
    with pytest.raises(RunInterrupted, match="stopped by Ctrl-C at t = ") as caught:
        oo.run(short_reach(duration=36_000.0, record_every=1000), out=tmp_path / "out", quiet=True)
    assert isinstance(caught.value, KeyboardInterrupt)
    with np.load(tmp_path / "out" / "trace.npz") as stored:
        assert 0.0 < stored["time"][-1] < 36_000.0
    assert json.loads((tmp_path / "out" / "summary.json").read_text())["status"] == "interrupted"


def raising(tmp_path: Path, what: str, when: str = "t > 0.005") -> dict[str, Any]:
    """Returns a scenario whose controller raises at a given time."""
    (tmp_path / "mine.py").write_text(f"""
import pathlib
import numpy as np
import onorbit_rs
class Raises(onorbit_rs.Controller):
    def update(self, t, state):
        if {when}:
            raise {what}
        return np.zeros(len(state.joints))
""")
    control = {"kind": "python", "file": str(tmp_path / "mine.py"), "class": "Raises"}
    return short_reach() | {"controller": control}


def test_an_error_before_the_first_row_is_re_raised_unchanged(tmp_path: Path) -> None:
    """The error occurs in the run, not in the trial step before the folder is created."""
    begun = f"pathlib.Path({str(tmp_path / 'out')!r}).exists()"
    with pytest.raises(RuntimeError, match="mine"):
        oo.run(raising(tmp_path, "RuntimeError('mine')", begun), out=tmp_path / "out", quiet=True)
    assert {file.name for file in (tmp_path / "out").iterdir()} == {"scenario.yaml", "manifest.json"}


@pytest.mark.parametrize("end", ["RuntimeError", "RunInterrupted", "SimulationError"])
def test_a_full_disk_does_not_hide_another_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, end: str
) -> None:
    def full(*_: Any, **__: Any) -> None:
        raise OutputFolderError("cannot write trace.npz: No space left on device")

    monkeypatch.setattr(finish, "write_trace", full)
    what = {"RuntimeError": "RuntimeError('mine')", "RunInterrupted": "KeyboardInterrupt"}.get(end)
    scenario = diverging() if what is None else raising(tmp_path, what)
    with pytest.raises(BaseException) as caught:
        oo.run(scenario, out=tmp_path / "out", quiet=True)
    own = caught.value
    assert type(own).__name__ == end
    notes = getattr(own, "__notes__", [])
    assert "cannot write trace.npz: No space left" in "; ".join([str(own), *notes])
    assert "rows recorded so far are in" not in str(notes) and "up to this time is in" not in str(own)


def test_the_trace_names_its_joints_and_bodies(tmp_path: Path) -> None:
    run = oo.run("humanoid_reach", tmp_path / "out", quiet=True, figures=False, recording=False,
                 changes={"simulation.duration": "20 ms"})  # fmt: skip
    with np.load(tmp_path / "out" / "trace.npz") as stored:
        assert list(stored["joint_names"]) == list(run.model.joint_names)
        assert list(stored["body_names"]) == list(run.model.body_names)
        assert stored["tau"].shape[1] == len(stored["joint_names"]) > 0
