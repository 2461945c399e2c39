"""Cases without success that are kept in full: their folders, cases that kill their process, full disks."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from campaign_files import BODY, campaign_of, same, spin
from test_campaign_processes import with_law

import onorbit_rs as oo
from onorbit_rs.campaigns import cases, failures
from onorbit_rs.campaigns.cases import Outcome
from onorbit_rs.campaigns.plan import Plan
from onorbit_rs.campaigns.storage import unfinished_failure
from onorbit_rs.exceptions import OutputFolderError, OutputNotEmptyError
from onorbit_rs.simulation import finish

pytestmark = pytest.mark.usefixtures("no_campaign_report")

FULL = {"failures": "full"}


@pytest.fixture
def in_this_process(monkeypatch: pytest.MonkeyPatch) -> None:
    """Keeps cases in this process and without figures, which take most of the time."""

    @contextmanager
    def one_by_one(plan: Plan, numbers: Sequence[int], workers: int, keep_in: Path) -> Iterator[Any]:
        yield (cases.keep_case(plan, case, unfinished_failure(keep_in, case)) for case in numbers)

    monkeypatch.setattr(failures, "on_processes", one_by_one)
    monkeypatch.setattr(finish, "write_pictures", lambda *_, **__: None)


def all_fail(number: int = 3) -> dict[str, Any]:
    """Returns a campaign whose cases are complete and meet no condition of success."""
    return spin(number, success={"base_rotation_max_rad": {"below": 0.0}}, keep=FULL)


def raising(folder: Path, after: float) -> dict[str, Any]:
    """Returns a campaign of one case whose controller raises an error from the time ``after``, s."""
    (folder / "late.py").write_text(
        "import numpy as np\n"
        "class Law:\n"
        "    def __init__(self, after): self.after = after\n"
        "    def update(self, t, state):\n"
        "        if t >= self.after: raise RuntimeError('no such thing')\n"
        "        return np.zeros(len(state.joints))\n"
    )
    scenario = with_law(folder)
    scenario["controller"] |= {"file": str(folder / "late.py"), "arguments": {"after": after}}
    vary = {"initial.angular_velocity": {"add": {"normal": [0.0, 0.1]}}}
    return campaign_of(scenario, vary, 1, keep=FULL)


def kept(out: Path) -> list[str]:
    return sorted(folder.name for folder in (out / "failures").iterdir())


@pytest.mark.usefixtures("in_this_process")
def test_cases_without_success_are_kept_in_full(tmp_path: Path) -> None:
    rotation = sorted(oo.campaign(spin(4))["base_rotation_max_rad"].to_pylist())
    success = {"base_rotation_max_rad": {"below": rotation[-1]}}
    table = oo.campaign(spin(4, success=success, keep=FULL), tmp_path)
    (bad,) = [row["case"] for row in table.to_pylist() if not row["success"]]
    assert kept(tmp_path) == [f"case_{bad}"], "this case alone"
    folder = tmp_path / "failures" / f"case_{bad}"
    run = oo.read_run(folder)
    assert run.summary["base_rotation_max_rad"] == rotation[-1]
    assert (folder / "reason.txt").read_text() == f"base_rotation_max_rad is {rotation[-1]:.6g}\n"


def test_a_case_that_kills_its_process_does_not_end_the_campaign(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("onorbit_rs.campaigns.pool.MOST_DEATHS", 2)
    vary = {"controller.arguments.crashes": {"set": {"choice": [1.0]}}}
    campaign = campaign_of(with_law(tmp_path), vary, 1, keep=FULL)
    table = oo.campaign(campaign, tmp_path / "out", workers=1)
    assert table["status"].to_pylist() == ["failed"]
    folder = tmp_path / "out" / "failures" / "case_0"
    expected = "the worker process was ended by SIGKILL, 2 times during this case\n"
    assert (folder / "reason.txt").read_text() == expected
    controller = oo.scenario.load(folder / "scenario.yaml").resolved()["controller"]
    assert controller["arguments"] == {"crashes": 1.0}


@pytest.mark.usefixtures("in_this_process")
@pytest.mark.parametrize(("after", "rows"), [(0.0, None), (0.003, 3)])
def test_a_case_that_raises_is_kept_with_its_rows(tmp_path: Path, after: float, rows: int | None) -> None:
    oo.campaign(raising(tmp_path, after), tmp_path / "out", workers=1)
    folder = tmp_path / "out" / "failures" / "case_0"
    assert "RuntimeError: no such thing" in (folder / "reason.txt").read_text()
    assert (folder / "scenario.yaml").exists()
    assert (folder / "trace.npz").exists() == (rows is not None)
    if rows is not None:
        assert len(oo.read_run(folder).to_pandas()) == rows


@pytest.mark.usefixtures("in_this_process")
def test_a_case_with_an_invalid_scenario_is_kept_with_it(tmp_path: Path) -> None:
    vary = {"simulation.time_step": {"set": {"choice": [0.5]}}}
    table = oo.campaign(campaign_of(BODY, vary, 1, keep=FULL), tmp_path)
    folder = tmp_path / "failures" / "case_0"
    assert (folder / "reason.txt").read_text().strip() == table["error"][0].as_py()
    assert "time_step: 0.5" in (folder / "scenario.yaml").read_text()


@pytest.mark.usefixtures("in_this_process")
def test_a_full_disk_is_an_error_and_the_next_call_writes_the_rest(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    written: list[bool] = []
    write_trace = finish.write_trace

    def full(files: Any, *arguments: Any, **more: Any) -> None:
        if written:
            raise OutputFolderError("cannot write trace.npz: No space left on device")
        written.append(True)
        write_trace(files, *arguments, **more)

    with monkeypatch.context() as patched:
        patched.setattr(finish, "write_trace", full)
        with pytest.raises(OutputFolderError, match=r"No space left .* 3 of 3 cases are kept .* continues"):
            oo.campaign(all_fail(), tmp_path)
    assert (tmp_path / "cases.parquet").exists()
    assert kept(tmp_path) == [".partial-case_1", "case_0"]
    oo.campaign(all_fail(), tmp_path)
    assert kept(tmp_path) == ["case_0", "case_1", "case_2"]
    assert all((tmp_path / "failures" / name / "trace.npz").exists() for name in kept(tmp_path))


@pytest.mark.usefixtures("in_this_process")
def test_rows_of_an_error_that_cannot_be_written_are_an_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: Any, **__: Any) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(finish, "write_trace", full)
    with pytest.raises(OutputFolderError, match=r"RuntimeError: no such thing.*No space left"):
        oo.campaign(raising(tmp_path, after=0.003), tmp_path / "out", workers=1)


@pytest.mark.usefixtures("in_this_process")
def test_another_error_of_the_second_run_is_added_to_the_reason(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def other(plan: Plan, case: int, folder: Path) -> Outcome:
        return Outcome(case, "failed", "MemoryError: it is gone", {}, {})

    monkeypatch.setattr(cases, "keep_case", other)
    oo.campaign(all_fail(1), tmp_path)
    text = (tmp_path / "failures" / "case_0" / "reason.txt").read_text()
    assert text.startswith("base_rotation_max_rad is")
    assert text.endswith("\nrun again: MemoryError: it is gone\n")


@pytest.mark.usefixtures("in_this_process")
def test_another_campaign_replaces_the_failures_but_no_file_of_the_user(tmp_path: Path) -> None:
    other = spin(2)
    other["campaign"]["seed"] = 2
    oo.campaign(all_fail(), tmp_path)
    mine = tmp_path / "failures" / "case_1" / "notes.txt"
    mine.write_text("look at this")
    with pytest.raises(OutputNotEmptyError, match="another campaign"):
        oo.campaign(other, tmp_path)
    table = oo.campaign(other, tmp_path, force=True)
    assert same(table).equals(same(oo.campaign(other)))
    assert kept(tmp_path) == ["case_1"]
    assert [file.name for file in mine.parent.iterdir()] == ["notes.txt"]
