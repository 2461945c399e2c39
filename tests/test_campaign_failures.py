"""Cases without success that are kept in full: their folders, cases that kill their process, full disks."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from campaign_files import BODY, campaign_of, same, spin
from test_campaign_processes import with_law

import onorbit_rs as oo
from onorbit_rs.campaigns import cases, failures
from onorbit_rs.campaigns.cases import Outcome
from onorbit_rs.campaigns.failure_folders import failure_folder
from onorbit_rs.campaigns.plan import Plan
from onorbit_rs.exceptions import OutputFolderError, OutputNotEmptyError, ReadError
from onorbit_rs.simulation import finish, memory

pytestmark = pytest.mark.usefixtures("no_campaign_report")

FULL = {"failures": "full"}


@pytest.fixture
def in_this_process(monkeypatch: pytest.MonkeyPatch) -> None:
    """Keeps cases in this process and without figures, which take most of the time."""

    @contextmanager
    def one_by_one(plan: Plan, numbers: Sequence[int], workers: int, keep_in: Path) -> Iterator[Any]:
        yield (cases.keep_case(plan, case, failure_folder(keep_in, case)) for case in numbers)

    monkeypatch.setattr(failures, "on_processes", one_by_one)
    monkeypatch.setattr(finish, "write_pictures", lambda *_, **__: None)


def all_fail(number: int = 3, below: float = 0.0) -> dict[str, Any]:
    """Returns a campaign whose cases are complete and, by default, meet no condition of success."""
    return spin(number, success={"base_rotation_max_rad": {"below": below}}, keep=FULL)


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
    assert kept(tmp_path) == ["case_0", "case_1"]
    assert not (tmp_path / "failures" / "case_1" / "reason.txt").exists(), "this folder is not complete"
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
    oo.campaign(all_fail(), tmp_path, force=True)  # the case of this folder fails again
    assert kept(tmp_path) == ["case_0", "case_1", "case_2"]
    assert {"notes.txt", "reason.txt", "trace.npz"} < {file.name for file in mine.parent.iterdir()}


@pytest.mark.usefixtures("in_this_process")
def test_a_campaign_that_cannot_be_replaced_remains(tmp_path: Path) -> None:
    table = oo.campaign(all_fail(), tmp_path)
    manifest = tmp_path / "failures" / "case_1" / "manifest.json"
    before = manifest.read_bytes()
    manifest.write_text("{}")
    other = spin(2)
    other["campaign"]["seed"] = 2
    with pytest.raises(ReadError, match=r"manifest\.json"):
        oo.campaign(other, tmp_path, force=True)
    manifest.write_bytes(before)
    assert same(oo.campaign(all_fail(), tmp_path)).equals(same(table))
    assert kept(tmp_path) == ["case_0", "case_1", "case_2"]


@pytest.mark.usefixtures("in_this_process")
def test_links_among_the_failures_are_not_followed(tmp_path: Path) -> None:
    out, aside = tmp_path / "out", tmp_path / "aside"
    oo.campaign(all_fail(2), out)
    (out / "failures" / "case_1").rename(aside)
    (out / "failures" / "case_1").symlink_to(aside)
    files = sorted(file.name for file in aside.iterdir())
    other = spin(2)
    other["campaign"]["seed"] = 2
    oo.campaign(other, out, force=True)
    assert sorted(file.name for file in aside.iterdir()) == files


@pytest.mark.usefixtures("in_this_process")
def test_other_conditions_of_success_change_the_failures(tmp_path: Path) -> None:
    rotation = oo.campaign(all_fail(), tmp_path)["base_rotation_max_rad"].to_pylist()
    wanted = all_fail(below=max(rotation))
    oo.campaign(wanted, tmp_path)
    worst = f"case_{rotation.index(max(rotation))}"
    assert kept(tmp_path) == [worst], "the others are now successes"
    (tmp_path / "failures" / worst / "reason.txt").write_text("something else\nrun again: E: x\n")
    oo.campaign(wanted, tmp_path)
    text = (tmp_path / "failures" / worst / "reason.txt").read_text()
    assert text == f"base_rotation_max_rad is {max(rotation):.6g}\nrun again: E: x\n"


@pytest.mark.usefixtures("in_this_process")
def test_too_little_space_for_the_rows_is_an_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with monkeypatch.context() as patched:
        patched.setattr(memory, "FITTING", 1.0)
        patched.setattr(memory.shutil, "disk_usage", lambda _: SimpleNamespace(free=10.0))
        with pytest.raises(OutputFolderError, match="delete files to make room"):
            oo.campaign(all_fail(1), tmp_path)
    oo.campaign(all_fail(1), tmp_path)
    assert (tmp_path / "failures" / "case_0" / "trace.npz").exists()


def test_the_working_directory_of_a_law_does_not_move_the_results(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "moving.py").write_text(
        "import os\nimport numpy as np\n"
        "class Law:\n"
        f"    def __init__(self): os.chdir({str(tmp_path / 'elsewhere')!r})\n"
        "    def update(self, t, state): return np.zeros(len(state.joints))\n"
    )
    scenario = with_law(tmp_path)
    scenario["controller"] = {"kind": "python", "file": str(tmp_path / "moving.py"), "class": "Law"}
    vary = {"initial.angular_velocity": {"add": {"normal": [0.0, 0.1]}}}
    success = {"base_rotation_max_rad": {"below": 0.0}}
    monkeypatch.chdir(tmp_path)
    oo.campaign(campaign_of(scenario, vary, 1, keep=FULL, success=success), "out", workers=1)
    assert (tmp_path / "out" / "failures" / "case_0" / "trace.npz").exists()
    assert not list((tmp_path / "elsewhere").iterdir())
