"""The output folder: rejected before the run if unsuitable or not writable, never partially written."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from results import listed

from onorbit_rs.exceptions import (
    OnOrbitError,
    OutputFolderError,
    OutputNotEmptyError,
    OutputNotWritableError,
)
from onorbit_rs.output.folder import OutputFolder


def test_a_missing_folder_is_created(tmp_path: Path) -> None:
    with OutputFolder.claim(tmp_path / "a" / "b") as folder:
        assert folder.path.is_dir()
    assert not list(folder.path.iterdir())


def test_a_folder_with_files_requires_force(tmp_path: Path) -> None:
    (tmp_path / "mine.txt").write_text("precious")
    with pytest.raises(OutputNotEmptyError, match="--force") as caught:
        OutputFolder.claim(tmp_path)
    assert isinstance(caught.value, OnOrbitError) and isinstance(caught.value, FileExistsError)
    assert caught.value.path == str(tmp_path)


def test_force_replaces_only_a_run(tmp_path: Path) -> None:
    (tmp_path / "figures").mkdir()
    for name in ("summary.json", "run.rrd", "figures/old.png"):
        (tmp_path / name).write_text("old")
    listed(tmp_path)
    for name in ("mine.txt", "figures/mine.txt", "figures/mine.png"):
        (tmp_path / name).write_text("precious")
    OutputFolder.claim(tmp_path, force=True).close()
    left = {str(file.relative_to(tmp_path)) for file in tmp_path.rglob("*") if file.is_file()}
    assert left == {"mine.txt", "figures/mine.txt", "figures/mine.png"}


def test_a_file_in_place_of_the_folder_is_rejected(tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.write_text("")
    with pytest.raises(OutputNotWritableError, match="is a file") as caught:
        OutputFolder.claim(file)
    assert isinstance(caught.value, PermissionError)
    with pytest.raises(OutputNotWritableError, match="cannot be written"):
        OutputFolder.claim(file / "below")


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write to all folders")
def test_a_folder_without_permission_is_rejected(tmp_path: Path) -> None:
    tmp_path.chmod(0o500)
    try:
        with pytest.raises(OutputNotWritableError, match="cannot be written"):
            OutputFolder.claim(tmp_path)
    finally:
        tmp_path.chmod(0o700)


def test_a_read_only_file_system_is_rejected() -> None:
    with pytest.raises(OutputNotWritableError, match="cannot be written"):
        OutputFolder.claim("/proc/onorbit")


def test_a_failed_write_leaves_the_old_file_and_no_partial_one(tmp_path: Path) -> None:
    with OutputFolder.claim(tmp_path) as folder:
        with folder.writing("summary.json") as path:
            path.write_text("old")
        with pytest.raises(OutputFolderError, match="No space left"), folder.writing("summary.json") as path:
            path.write_text("half")
            raise OSError(28, "No space left on device")
    assert {file.name for file in tmp_path.iterdir()} == {"summary.json", "manifest.json"}
    assert (tmp_path / "summary.json").read_text() == "old"


@pytest.mark.skipif(os.name != "posix", reason="only POSIX can limit the size of files")
def test_a_full_disk_ends_the_run_with_one_line(tmp_path: Path) -> None:
    # 400 blocks of 1 KiB: the recording does not fit; rerun's file sink once hung here
    command = f"ulimit -f 400; exec {sys.executable} -m onorbit_rs run kepler_orbit -q -o {tmp_path / 'out'}"
    done = subprocess.run(["bash", "-c", command], capture_output=True, text=True, timeout=100, check=False)
    assert done.returncode == 2, done
    assert done.stderr.startswith("onorbit: cannot write ") and len(done.stderr.splitlines()) == 1


def test_a_name_too_long_and_a_file_named_figures_are_rejected(tmp_path: Path) -> None:
    with pytest.raises(OutputNotWritableError, match="too long"):
        OutputFolder.claim(tmp_path / ("x" * 300))
    (tmp_path / "summary.json").write_text("{}")
    listed(tmp_path)
    (tmp_path / "figures").write_text("precious")
    with pytest.raises(OutputNotEmptyError, match="figures: it already exists"):
        OutputFolder.claim(tmp_path, force=True)
    assert (tmp_path / "summary.json").exists()
