"""``--force`` removes only files written by a run, and nothing is written through symbolic links."""

from __future__ import annotations

import os
import shutil
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from commands import SPIN, onorbit, refusal
from matplotlib.figure import Figure

import onorbit_rs as oo
from onorbit_rs import figures
from onorbit_rs.exceptions import OutputFolderError, OutputNotEmptyError, ReadError
from onorbit_rs.output.folder import OutputFolder
from onorbit_rs.output.manifest import MANIFEST, RESULTS
from onorbit_rs.output.read import read_summary
from onorbit_rs.output.sealed import sealed, unsealed
from onorbit_rs.report import write_report

PRECIOUS = "precious"


@pytest.fixture(scope="module")
def run_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return _spin(tmp_path_factory.mktemp("force"))


def _spin(where: Path, *more: str) -> Path:
    (where / "mine.yaml").write_text(SPIN)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("onorbit_rs.simulation.finish.write_pictures", _write_a_figure)
        done = onorbit("run", "mine.yaml", "--out", "out", *more, cwd=where)
    assert done.returncode == 0, done.stderr
    return where / "out"


def _write_a_figure(folder: OutputFolder, *_: Any, **__: Any) -> None:
    with folder.replacing() as files, files.writing("figures/ledger.png") as path:
        path.write_bytes(b"a figure")


@pytest.fixture
def copy(run_folder: Path, tmp_path: Path) -> Path:
    shutil.copy(run_folder.parent / "mine.yaml", tmp_path)
    return Path(shutil.copytree(run_folder, tmp_path / "out"))


def test_force_removes_no_picture_from_a_folder_without_a_run(tmp_path: Path) -> None:
    pictures = tmp_path / "out" / "figures"
    pictures.mkdir(parents=True)
    (pictures / "holiday.png").write_text(PRECIOUS)
    for _ in range(2):
        _spin(tmp_path, "--force")
    assert (pictures / "holiday.png").read_text() == PRECIOUS
    assert (pictures / "ledger.png").is_file()


@pytest.mark.parametrize("name", RESULTS)
def test_force_replaces_only_files_written_by_a_run(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_text(PRECIOUS)
    with pytest.raises(
        OutputNotEmptyError, match=f"{name}: it already exists, and manifest.json does not list it"
    ):
        OutputFolder.claim(tmp_path, force=True)
    assert [file.name for file in tmp_path.iterdir()] == [name] and (tmp_path / name).read_text() == PRECIOUS


@pytest.mark.parametrize("name", ["figures", "checkpoint"])
def test_force_follows_no_symbolic_link_to_a_folder(copy: Path, tmp_path: Path, name: str) -> None:
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    for file in ("ledger.png", "state.json", "q.f64"):
        (elsewhere / file).write_text(PRECIOUS)
    shutil.rmtree(copy / name, ignore_errors=True)
    (copy / name).symlink_to(elsewhere)
    said = refusal("run", "mine.yaml", "--out", "out", "--force", cwd=tmp_path)
    assert f"{name}: it is a symbolic link, which no run creates" in said
    assert {file.read_text() for file in elsewhere.iterdir()} == {PRECIOUS}
    assert (copy / "summary.json").is_file(), "nothing may be removed after a rejection"


@pytest.mark.parametrize("name", ["trace.npz", "summary.json", "report.html"])
def test_force_neither_follows_nor_removes_a_link_in_place_of_a_file(
    copy: Path, tmp_path: Path, name: str
) -> None:
    precious = tmp_path / "precious"
    precious.write_text(PRECIOUS)
    (copy / name).unlink(missing_ok=True)
    (copy / name).symlink_to(precious)
    said = refusal("run", "mine.yaml", "--out", "out", "--force", cwd=tmp_path)
    assert f"{name}: it is a symbolic link, which no run creates" in said
    assert precious.read_text() == PRECIOUS and (copy / name).is_symlink()


def test_an_existing_temporary_file_is_not_written_through(tmp_path: Path) -> None:
    precious, out = tmp_path / "precious", tmp_path / "out"
    precious.write_text(PRECIOUS)
    out.mkdir()
    for name in RESULTS:
        (out / f".partial-{name}").symlink_to(precious)
    _spin(tmp_path, "--force")
    assert precious.read_text() == PRECIOUS
    assert all((out / f".partial-{name}").is_symlink() for name in RESULTS)


@pytest.mark.usefixtures("no_pictures")
def test_links_created_during_a_run_are_rejected_at_its_end(tmp_path: Path) -> None:
    precious, out = tmp_path / "precious", tmp_path / "out"
    precious.write_text(PRECIOUS)
    with OutputFolder.claim(out) as folder:
        (out / "figures").symlink_to(tmp_path)
        (out / "trace.npz").symlink_to(precious)
        for name in ("trace.npz", "figures/precious.png"):
            with pytest.raises(OutputFolderError), folder.writing(name) as path:
                path.write_text("new")
        with pytest.raises(OSError, match="must be a folder"):
            (out / "checkpoint").symlink_to(tmp_path)
            folder.expect_checkpoint(("state.json",))
    assert precious.read_text() == PRECIOUS
    assert {file.name for file in tmp_path.iterdir()} == {"precious", "out"}


def test_a_report_replaces_only_files_written_by_a_run(copy: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    drawing = SimpleNamespace(name="ledger", caption="nothing", draw=Figure)
    monkeypatch.setattr(figures, "drawings", lambda subject: [drawing])
    for name in ("report.html", "figures/ledger.pdf"):
        (copy / name).write_text(PRECIOUS)
        with pytest.raises(OutputNotEmptyError, match=f"{name}: it already exists"):
            write_report(copy, pdf=True)
        assert (copy / name).read_text() == PRECIOUS and not list(copy.glob(".*"))
        (copy / name).unlink()
    for pdf in (True, False):
        write_report(copy, pdf=pdf)  # an earlier report is replaced
    assert (copy / "figures" / "ledger.pdf").is_file()
    assert oo.compare(copy, copy).agrees


def test_an_untrusted_manifest_cannot_name_files_outside_the_folder(copy: Path, tmp_path: Path) -> None:
    precious = tmp_path / "precious.png"
    precious.write_text(PRECIOUS)
    record: dict[str, Any] = unsealed((copy / MANIFEST).read_bytes())
    entry = record["files"]["trace.npz"]
    for name in (
        "../precious.png",
        str(precious),
        "figures/../../precious.png",
        "mine.txt",
        "figures/a\0.png",
    ):
        (copy / MANIFEST).write_bytes(sealed(record | {"files": {name: entry}}))
        with pytest.raises(ReadError, match="not a file of a run"):
            OutputFolder.claim(copy, force=True)
    for name in ("../state.json", "x/../../y.f64", 3):
        (copy / MANIFEST).write_bytes(sealed(record | {"checkpoint": [name]}))
        with pytest.raises(ReadError, match="not part of a checkpoint"):
            OutputFolder.claim(copy, force=True)
    assert precious.read_text() == PRECIOUS and (copy / "trace.npz").is_file()


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no named pipes here")
def test_a_pipe_in_place_of_a_file_does_not_hang(tmp_path: Path) -> None:
    for name in ("summary.json", MANIFEST):
        out = tmp_path / name
        out.mkdir()
        os.mkfifo(out / name)
        with pytest.raises(ReadError, match="it is a pipe or a device, but must be a regular file"):
            read_summary(out)
    with pytest.raises(
        OutputNotEmptyError, match=r"summary\.json: it is a pipe or a device, which no run creates"
    ):
        OutputFolder.claim(tmp_path / "summary.json", force=True)


def test_a_summary_that_is_a_broken_link_is_not_reported_as_missing(copy: Path) -> None:
    """A folder with a broken link was once reported to hold no run."""
    (copy / "summary.json").unlink()
    (copy / "summary.json").symlink_to("nowhere")
    for read in (read_summary, oo.compare):
        with pytest.raises(
            ReadError, match=r"summary\.json: it is a symbolic link whose target does not exist"
        ):
            read(copy)


def test_an_unknown_file_in_the_checkpoint_is_named(copy: Path) -> None:
    (copy / "checkpoint").mkdir()
    (copy / "checkpoint" / "mine.txt").write_text(PRECIOUS)
    with pytest.raises(
        OutputNotEmptyError, match=r"checkpoint.mine\.txt: it already exists, and manifest.json does not"
    ):
        OutputFolder.claim(copy, force=True)


@pytest.mark.usefixtures("no_pictures")
def test_force_replaces_edited_files_of_a_run(copy: Path, tmp_path: Path) -> None:
    (copy / "trace.npz").write_bytes(b"edited")
    oo.run(tmp_path / "mine.yaml", copy, force=True, quiet=True)
    assert oo.compare(copy, copy).agrees


def test_a_figure_edited_by_the_user_is_not_replaced(copy: Path, tmp_path: Path) -> None:
    """``--force`` once removed it, although its checksum differs from the manifest."""
    figure = copy / "figures" / "ledger.png"
    figure.write_bytes(b"a figure with arrows")
    said = refusal("run", "mine.yaml", "--out", "out", "--force", cwd=tmp_path)
    assert "ledger.png: the figure was edited after it was drawn; move the figure out" in said
    assert figure.read_bytes() == b"a figure with arrows"
    assert oo.compare(copy, copy).agrees, "nothing may be removed after a rejection"
    with (
        OutputFolder(copy) as folder,
        pytest.raises(OutputNotEmptyError, match="was edited"),
        folder.writing("figures/ledger.png"),
    ):
        pass
    figure.rename(tmp_path / "mine.png")
    _spin(tmp_path, "--force")
    assert figure.read_bytes() == b"a figure"


def test_resuming_rejects_an_edited_figure_before_it_continues(copy: Path) -> None:
    (copy / "figures" / "ledger.png").write_bytes(b"a figure with arrows")
    with pytest.raises(OutputNotEmptyError, match=r"ledger\.png: the figure was edited"):
        oo.resume(copy, quiet=True)


def test_a_figure_left_by_a_kill_does_not_count_as_edited(copy: Path) -> None:
    """The run was killed between writing the manifest and renaming its temporary files."""
    folder = OutputFolder(copy)
    with folder.replacing() as files:
        with files.writing("figures/ledger.png") as path:
            path.write_bytes(b"another figure")
        files._rename, files.discard = (lambda: None), (lambda: None)  # type: ignore[method-assign]
    left = {file.name: file.read_bytes() for file in copy.iterdir() if file.name.startswith(".")}
    folder.close()
    for name, content in left.items():
        (copy / name).write_bytes(content)
    OutputFolder.claim(copy, force=True).close()
    assert not (copy / "figures" / "ledger.png").exists()
