"""Campaigns: the same bits for any number of workers, continued campaigns, failing cases, folders, tables."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq
import pytest
import yaml
from campaign_files import BODY, campaign_of, reach, same, spin, write
from commands import onorbit

import onorbit_rs as oo
from onorbit_rs.campaigns.bundled import CAMPAIGNS
from onorbit_rs.campaigns.load import load_campaign
from onorbit_rs.campaigns.nominal import check_nominal
from onorbit_rs.campaigns.plan import plan_of
from onorbit_rs.exceptions import (
    DtypeError,
    InputError,
    NotFoundError,
    OutputFolderError,
    OutputInUseError,
    OutputNotEmptyError,
)
from onorbit_rs.simulation import finish

pytestmark = pytest.mark.usefixtures("no_campaign_report")


def test_every_number_of_workers_gives_the_same_table(tmp_path: Path) -> None:
    campaign = spin()
    alone = oo.campaign(campaign, workers=1)
    for workers in (2, 5):
        found = oo.campaign(campaign, tmp_path / str(workers), workers=workers)
        assert same(found).equals(same(alone))
    assert alone.column_names[:4] == ["case", "status", "success", "error"]
    assert alone["case"].to_pylist() == list(range(8))
    assert set(alone["status"].to_pylist()) == {"complete"}


def test_a_missing_pyarrow_is_found_before_the_first_case(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    monkeypatch.setattr("onorbit_rs.campaigns.run._run", lambda *_, **__: pytest.fail("a case has run"))
    with pytest.raises(InputError, match="pip install"):
        oo.campaign(spin())


def test_a_case_alone_has_the_numbers_of_the_campaign(tmp_path: Path) -> None:
    campaign = campaign_of(
        reach(), {"initial.joints": {"add": {"normal": [0, "1 deg"]}}}, sampling="latin_hypercube"
    )
    table = oo.campaign(campaign, tmp_path / "campaign")
    for case in (0, 5):
        run = oo.campaign_case(campaign, case)
        row = table.slice(case, 1).to_pylist()[0]
        numbers = {key: value for key, value in run.summary.items() if isinstance(value, (int, float))}
        assert len(numbers) > 20
        for name, value in numbers.items():
            if name not in ("wall_s", "real_time_factor"):
                assert row[name] == value, name
        joints = [row[f"initial.joints.arm_joint_{i}"] for i in range(1, 8)]
        assert np.array_equal(run.trace.q[0, 7:], joints)
    other = oo.campaign_case(campaign, 1).summary["base_rotation_max_rad"]
    assert other != table["base_rotation_max_rad"][0].as_py()  # control


def test_the_files_are_read_by_other_libraries(tmp_path: Path) -> None:
    table = oo.campaign(spin(), tmp_path)
    assert pq.read_table(tmp_path / "cases.parquet").equals(table)
    polars = pytest.importorskip("polars", reason="polars is not installed")
    frame = polars.read_parquet(tmp_path / "cases.parquet")
    assert frame["robot.rigid_body.mass"].to_list() == table["robot.rigid_body.mass"].to_pylist()


def test_the_files_are_read_by_pandas(tmp_path: Path) -> None:
    pandas = pytest.importorskip("pandas", reason="pandas is not installed")
    table = oo.campaign(spin(), tmp_path)
    frame = pandas.read_parquet(tmp_path / "cases.parquet")
    assert frame["certificate_passed"].all()
    assert list(frame.columns) == table.column_names


def test_the_resolved_campaign_repeats_the_campaign(tmp_path: Path) -> None:
    table = oo.campaign(spin(), tmp_path / "a")
    again = oo.campaign(tmp_path / "a" / "campaign.yaml", tmp_path / "b")
    assert same(again).equals(same(table))
    continued = oo.campaign(tmp_path / "a" / "campaign.yaml", tmp_path / "a")
    assert continued.equals(table), "nothing is run again, so that even the measured times are equal"


def test_a_stopped_campaign_continues_to_the_same_table(tmp_path: Path, monkeypatch: Any) -> None:
    campaign = spin(cases=12)
    whole = oo.campaign(campaign, tmp_path / "whole")
    monkeypatch.setattr("onorbit_rs.campaigns.storage._EVERY_S", 0.0)
    runs = []
    import onorbit_rs.campaigns.on_threads as engine

    original = engine.run_case

    def counted(plan: Any, case: int, check: Any) -> Any:
        runs.append(case)
        if len(runs) == 6:
            raise KeyboardInterrupt
        return original(plan, case, check)

    monkeypatch.setattr(engine, "run_case", counted)
    with pytest.raises(KeyboardInterrupt, match="5 of 12 cases are kept"):
        oo.campaign(campaign, tmp_path / "stopped", workers=1)
    assert not (tmp_path / "stopped" / "cases.parquet").exists()
    found = oo.campaign(campaign, tmp_path / "stopped", workers=1)
    assert same(found).equals(same(whole))
    assert sorted(runs) == [*range(6), *range(5, 12)], "no case that was kept is run again"


def test_more_random_cases_continue_a_campaign(tmp_path: Path) -> None:
    few = oo.campaign(spin(cases=4), tmp_path)
    more = oo.campaign(spin(cases=4), tmp_path, cases=6)
    assert more.slice(0, 4).equals(few)
    assert oo.campaign(spin(cases=4), tmp_path).equals(few)
    with pytest.raises(OutputNotEmptyError, match="another campaign"):
        oo.campaign(spin(cases=6, sampling="latin_hypercube"), tmp_path)


def test_many_parts_are_merged(tmp_path: Path, monkeypatch: Any) -> None:
    monkeypatch.setattr("onorbit_rs.campaigns.storage._EVERY_S", 0.0)
    monkeypatch.setattr("onorbit_rs.campaigns.storage._MOST_PARTS", 3)
    keep = {"columns": ["v"], "every": "10 ms"}
    table = oo.campaign(spin(cases=10, keep=keep), tmp_path)
    assert table["case"].to_pylist() == list(range(10))
    assert len(list((tmp_path / "cases").glob("*.json"))) <= 5
    columns = pq.read_table(tmp_path / "columns.parquet")
    assert columns["case"].to_pylist() == [case for case in range(10) for _ in range(3)]


def test_kept_columns_have_the_rows_of_the_run(tmp_path: Path) -> None:
    keep = {"columns": ["v", "kinetic_energy"], "every": "5 ms"}
    oo.campaign(spin(cases=3, keep=keep), tmp_path)
    columns = pq.read_table(tmp_path / "columns.parquet")
    names = ["case", "time", *(f"v[{i}]" for i in range(6)), "kinetic_energy"]
    assert columns.column_names == names
    trace = oo.campaign_case(spin(cases=3), 2).trace
    rows = columns.filter(np.array(columns["case"].to_pylist()) == 2)
    assert np.array_equal(rows["time"].to_numpy(), trace.time[::5])
    assert np.array_equal(rows["v[4]"].to_numpy(), trace.v[::5, 4])
    with pytest.raises(InputError, match=r"no column 'kinetik_energy'; did you mean 'kinetic_energy'"):
        oo.campaign(spin(keep={"columns": ["kinetik_energy"]}))


@pytest.mark.usefixtures("no_campaign_report")
def test_no_columns_are_written_if_all_cases_fail(tmp_path: Path) -> None:
    vary = {"simulation.time_step": {"set": {"choice": [0.5]}}}  # longer than the duration
    table = oo.campaign(campaign_of(BODY, vary, 2, keep={"columns": ["v"]}), tmp_path)
    assert table["status"].to_pylist() == ["failed", "failed"]
    assert not (tmp_path / "columns.parquet").exists()


def test_a_case_that_raises_is_kept_and_the_campaign_goes_on(tmp_path: Path) -> None:
    vary = {"orbit.eccentricity": {"add": {"uniform": [-0.001, 0.001]}}}
    orbit = {"kind": "kepler", "semi_major_axis": "7000 km", "eccentricity": 0.0}
    with pytest.raises(oo.exceptions.ScenarioError, match="must be zero or above"):
        oo.campaign(campaign_of(BODY | {"orbit": orbit}, vary))  # a bound that no case may have
    vary = {"simulation.time_step": {"set": {"choice": [1e-3, 0.5]}}}
    table = oo.campaign(campaign_of(BODY, vary), tmp_path)
    steps = table["simulation.time_step"].to_pylist()
    assert {*steps} == {1e-3, 0.5}
    for status, step, error in zip(
        table["status"].to_pylist(), steps, table["error"].to_pylist(), strict=True
    ):
        assert status == ("complete" if step == 1e-3 else "failed")
        assert (error is None) == (status == "complete")
        if error:
            assert error.startswith("ScenarioError: ")
            assert "time_step 0.5 s exceeds the duration" in error
    assert json.loads(onorbit("campaign", str(tmp_path / "campaign.yaml"), "--json").stdout)["cases"] == 8


def test_a_diverged_case_keeps_the_numbers_before_the_divergence() -> None:
    vary = {"controller.kp": {"set": {"choice": [100.0, 1e9]}}}
    scenario = reach(0.5)
    scenario["simulation"] |= {"time_step": 0.01}
    table = oo.campaign(campaign_of(scenario, vary))
    rows = {row["controller.kp"]: row for row in table.to_pylist()}
    assert rows[100.0]["status"] == "complete"
    assert rows[1e9]["status"] in ("diverged", "failed")
    assert rows[1e9]["error"]
    assert not rows[1e9]["success"]


def test_success_is_a_condition_on_the_columns(tmp_path: Path) -> None:
    table = oo.campaign(spin())
    rotation = sorted(table["base_rotation_max_rad"].to_pylist())
    middle = 0.5 * (rotation[3] + rotation[4])
    success = {"base_rotation_max_rad": {"at_most": middle}}
    found = oo.campaign(spin(success=success), tmp_path)
    expected = [value <= middle for value in found["base_rotation_max_rad"].to_pylist()]
    assert found["success"].to_pylist() == expected
    assert sum(expected) == 4
    again = oo.campaign(spin(success={"base_rotation_max_rad": {"below": 0.0}}), tmp_path)
    assert not any(again["success"].to_pylist()), "another condition needs no new runs"
    assert again["wall_s"].equals(found["wall_s"])
    with pytest.raises(InputError, match="did you mean 'base_rotation_max_rad'"):
        oo.campaign(spin(success={"base_rotation_max": {"at_most": 1}}))


@pytest.mark.parametrize(
    ("wrong", "right"),
    [
        ("events.gasp.time_s", "events.grasp.time_s"),
        ("events.grasp.tme_s", "events.grasp.time_s"),
        ("latches.grasp.nearst_m", "latches.grasp.nearest_m"),
        ("systems.servicer.joint_torque_max", "systems.servicer.joint_torque_max_nm"),
    ],
)
def test_a_misspelt_condition_is_found_before_any_case_runs(
    wrong: str, right: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    started = []
    monkeypatch.setattr(
        "onorbit_rs.campaigns.on_threads.run_case", lambda plan, case, _: started.append(case)
    )
    campaign = yaml.safe_load(CAMPAIGNS.path("capture_campaign").read_text(encoding="utf-8"))
    campaign["campaign"]["success"] = {
        right: {"at_least": 0},
        "certificate.grasp/energy_error_rel.value": {"at_most": 1},
    }
    loaded = load_campaign(campaign)
    check_nominal(plan_of(loaded), loaded)  # neither the grasp nor its balance exists after one step
    campaign["campaign"]["success"] = {wrong: {"at_least": 0}}
    with pytest.raises(InputError, match=f"no column '{wrong}'; did you mean '{right}'"):
        oo.campaign(campaign)
    assert not started


def test_folders_of_others_are_not_touched(tmp_path: Path) -> None:
    (tmp_path / "mine.txt").write_text("mine")
    for force in (False, True):
        with pytest.raises(OutputNotEmptyError, match="contains files, but no campaign"):
            oo.campaign(spin(), tmp_path, force=force)
    assert [file.name for file in tmp_path.iterdir()] == ["mine.txt"]
    out = tmp_path / "campaign"
    oo.campaign(spin(), out)
    with pytest.raises(OutputNotEmptyError, match="contains another campaign"):
        oo.campaign(
            spin() | {"name": "other"} | campaign_of(BODY, spin()["campaign"]["vary"], 9, seed=2), out
        )
    other = campaign_of(BODY, {"initial.position": {"set": {"uniform": [0, 1]}}}, 3)
    table = oo.campaign(other, out, force=True)
    assert pq.read_table(out / "cases.parquet").num_rows == table.num_rows == 3


def test_a_folder_in_use_is_refused(tmp_path: Path) -> None:
    from onorbit_rs.output.lock import FolderLock

    oo.campaign(spin(), tmp_path)
    lock = FolderLock(tmp_path)
    try:
        with pytest.raises(OutputInUseError):
            oo.campaign(spin(), tmp_path)
    finally:
        lock.release()


def full_table() -> None:
    raise OutputFolderError("cannot write cases.parquet: No space left on device", path="cases.parquet")


def test_a_full_disk_loses_nothing(tmp_path: Path, monkeypatch: Any) -> None:
    import errno

    import onorbit_rs.campaigns.storage as storage

    whole = oo.campaign(spin(cases=12), tmp_path / "whole")
    monkeypatch.setattr(storage, "_EVERY_S", 0.0)
    original, written = storage.CampaignFolder._write_part, []

    def full(self: Any, number: int, outcomes: Any) -> None:
        written.append(number)
        if len(written) > 4:
            raise OutputFolderError(f"cannot write: {errno.ENOSPC}", path="part")
        original(self, number, outcomes)

    with monkeypatch.context() as patched, pytest.raises(OutputFolderError, match="4 of 12 cases are kept"):
        patched.setattr(storage.CampaignFolder, "_write_part", full)
        oo.campaign(spin(cases=12), tmp_path / "full", workers=1)
    assert same(oo.campaign(spin(cases=12), tmp_path / "full")).equals(same(whole))
    with monkeypatch.context() as patched, pytest.raises(OutputFolderError, match="12 of 12 cases are kept"):
        patched.setattr("onorbit_rs.campaigns.run.write_cases", lambda *_: full_table())
        oo.campaign(spin(cases=12), tmp_path / "full")


def test_a_damaged_part_is_reported(tmp_path: Path) -> None:
    oo.campaign(spin(), tmp_path)
    part = next((tmp_path / "cases").glob("part-*.json"))
    part.write_text("[[")
    with pytest.raises(oo.exceptions.ReadError, match="remove it, and run the campaign again"):
        oo.campaign(spin(), tmp_path)
    part.unlink()
    assert oo.campaign(spin(), tmp_path).num_rows == 8


@pytest.mark.parametrize(
    ("options", "error", "words"),
    [
        ({"workers": 0}, InputError, "at least 1"),
        ({"workers": True}, DtypeError, "positive integer"),
        ({"cluster": "nonsense"}, InputError, "with its port, such as tcp://10.0.0.1:8786, or 'local'"),
        ({"cases": -1}, oo.exceptions.ScenarioError, "below the minimum"),
    ],
)
def test_invalid_arguments_are_refused(options: dict[str, Any], error: type, words: str) -> None:
    with pytest.raises(error, match=words):
        oo.campaign(spin(), **options)


def test_a_case_that_does_not_exist_is_refused() -> None:
    for case in (-1, 8):
        with pytest.raises(InputError, match="give a number from 0 to 7"):
            oo.campaign_case(spin(), case)
    with pytest.raises(NotFoundError):
        oo.campaign_case("nowhere", 1)
    with pytest.raises(
        NotFoundError, match="'free_tumble' is a scenario, not a campaign; run it with 'onorbit run'"
    ):
        oo.campaign("free_tumble")


def test_the_command_writes_the_files_and_the_folder_of_a_case(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file, out = write(spin(), tmp_path / "spin.yaml"), tmp_path / "out"
    done = onorbit("campaign", str(file), "--out", str(out), "--cases", "5", "--workers", "2")
    assert done.returncode == 0, done.stderr
    assert "success: 5 of 5, 100.0% (95 % confidence: 56.6% to 100.0%)" in done.stdout
    assert {"cases.parquet", "campaign.yaml"} <= {path.name for path in out.iterdir()}
    assert "next:" not in done.stdout
    strict = write(spin(success={"base_rotation_max_rad": {"below": 0}}), tmp_path / "strict.yaml")
    for options, said in (([], ""), (["--cases", "5"], " --cases 5")):
        failing = onorbit("campaign", str(strict), *options)
        assert f"next: onorbit campaign {strict}{said} --case 0 --out DIR" in failing.stdout
    alone = onorbit("campaign", str(file), "--case", "2", "--out", str(tmp_path / "case"), "--json")
    assert alone.returncode == 0, alone.stderr
    assert (tmp_path / "case" / "run.rrd").exists()
    assert any((tmp_path / "case" / "figures").iterdir())
    row = pq.read_table(out / "cases.parquet").slice(2, 1).to_pylist()[0]
    summary = json.loads((tmp_path / "case" / "summary.json").read_text())
    assert summary["base_rotation_max_rad"] == row["base_rotation_max_rad"]
    monkeypatch.setattr(finish, "write_pictures", lambda *_, **__: None)  # they take most of the time
    inside = onorbit("campaign", str(file), "--case", "2", "--out", str(out), "-q")
    assert inside.returncode == 0, inside.stderr
    assert (out / "case_2" / "summary.json").exists()
    wrong = onorbit("campaign", str(file), "--case", "8")
    assert wrong.returncode == 2
    assert "give a number from 0 to 7" in wrong.stderr
