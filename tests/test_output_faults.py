"""Disk faults while a folder is written: full or read-only disks, and kills at any instant."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from commands import SPIN, onorbit
from soak.kills import kill_campaign

import onorbit_rs as oo
from onorbit_rs.exceptions import OutputFolderError, OutputNotWritableError
from onorbit_rs.output import checkpoint as checkpoints
from onorbit_rs.output.folder import OutputFolder
from onorbit_rs.scenario import load
from onorbit_rs.simulation.live import _Saver

pytestmark = pytest.mark.usefixtures("no_pictures")


def tumbling(duration: float = 4.0) -> dict[str, Any]:
    data = load("free_tumble").resolved()
    data["simulation"] = {"duration": duration, "time_step": 1e-4}
    return data


@pytest.fixture
def small_disk(tmp_path: Path) -> Any:
    """Mounts a disk of 256 KiB."""
    disk = tmp_path / "disk"
    disk.mkdir()
    mounted = os.geteuid() == 0 and sys.platform == "linux" and subprocess.run(
        ["mount", "-t", "tmpfs", "-o", "size=256k", "tmpfs", str(disk)], capture_output=True, check=False
    ).returncode == 0  # fmt: skip
    if not mounted:
        pytest.skip("mounting a small disk requires root on Linux; other tests use RLIMIT_FSIZE instead")
    yield disk
    subprocess.run(["umount", "-l", str(disk)], check=True)


def test_a_checkpoint_that_cannot_be_written_warns_once_and_the_run_continues(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A failure once ended the whole run. The missing rows are written with the next checkpoint."""
    calls = {"failed": 0, "written": 0}
    append = checkpoints._append

    def full_at_times(file: Path, content: bytes, *, after: int, sync: bool) -> None:
        if file.name == "q.f64" and calls["failed"] < 1:
            calls["failed"] += 1
            append(file, content[:100], after=after, sync=sync)
            raise OSError(28, "No space left on device")
        calls["written"] += 1
        append(file, content, after=after, sync=sync)

    monkeypatch.setattr(checkpoints, "_append", full_at_times)
    kept = []
    discard = OutputFolder.discard_checkpoint

    def keep(folder: OutputFolder) -> None:
        if (folder.path / "checkpoint").exists():
            kept.append(shutil.copytree(folder.path, tmp_path / "kept"))
        discard(folder)

    monkeypatch.setattr(OutputFolder, "discard_checkpoint", keep)
    data = tumbling(60.0)  # long enough for several checkpoints on any machine
    data["simulation"]["record_every"] = 100
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        whole = oo.run(data, tmp_path / "out", quiet=True, checkpoint_every=0.0)
    assert calls["failed"] == 1 and calls["written"] > 1 and len(kept) == 1
    (said,) = {str(warning.message) for warning in caught if "checkpoint" in str(warning.message)}
    assert "No space left on device; the run continues and will try again later" in said
    monkeypatch.setattr(OutputFolder, "discard_checkpoint", discard)
    again = oo.resume(kept[0], quiet=True)
    for name in whole.trace.columns():
        assert (
            np.asarray(getattr(again.trace, name)).tobytes()
            == np.asarray(getattr(whole.trace, name)).tobytes()
        )


def test_a_full_disk_leaves_no_partial_file_and_is_reported(small_disk: Path) -> None:
    (small_disk / "mine.yaml").write_text(SPIN.replace("duration: 0.1 s", "duration: 20 s"))
    done = onorbit("run", "mine.yaml", "--out", "out", "-q", cwd=small_disk)
    assert done.returncode == 2 and "No space left on device" in done.stderr, done
    assert {file.name for file in (small_disk / "out").rglob("*")} == {"scenario.yaml", "manifest.json"}
    assert "no run in this folder" in onorbit("show", small_disk / "out").stderr
    (small_disk / "mine.yaml").write_text(SPIN)
    assert onorbit("run", "mine.yaml", "--out", "out", "-q", "--force", cwd=small_disk).returncode == 0
    assert oo.compare(small_disk / "out", small_disk / "out").agrees


def test_a_full_disk_loses_checkpoints_but_not_the_run(small_disk: Path) -> None:
    with OutputFolder.claim(small_disk / "out") as folder:
        writer = checkpoints.CheckpointWriter(folder, "digest")
        rows = np.random.default_rng(14).normal(size=(4000, 3))
        engine = json.dumps({"version": "any"})
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            kept = [writer(oo.Checkpoint(engine, {"q": rows})) for _ in range(4)]
        assert kept == [True, True, False, False] and len(caught) == 1
        found = checkpoints.read_checkpoint(folder.path, "digest")
        assert found.written["q"].rows == 8000 and len(found.written) == 1
        assert np.array_equal(found.checkpoint.columns["q"][:], np.vstack([rows, rows]))


def test_a_read_only_folder_is_rejected_for_writing_but_readable(tmp_path: Path) -> None:
    (tmp_path / "mine.yaml").write_text(SPIN)
    out = tmp_path / "out"
    oo.run(tmp_path / "mine.yaml", out, quiet=True)
    mounted = os.geteuid() == 0 and sys.platform == "linux"
    if mounted:
        mount = ["mount", "--bind", str(out), str(out)]
        mounted = subprocess.run(mount, capture_output=True, check=False).returncode == 0
        remount = ["mount", "-o", "remount,bind,ro", str(out)]
        mounted = mounted and subprocess.run(remount, capture_output=True, check=False).returncode == 0
    else:
        out.chmod(0o500)
    if os.geteuid() == 0 and not mounted:
        pytest.skip("root may write to all folders, and nothing can be mounted here")
    try:
        for ask in (
            lambda: oo.run(SPIN_DATA, out, force=True),
            lambda: oo.resume(out),
            lambda: OutputFolder(out),
        ):
            with pytest.raises(OutputNotWritableError, match="cannot be written"):
                ask()
        assert oo.compare(out, out).agrees and onorbit("show", out, "--no-viewer").returncode == 0
        done = onorbit("report", out)
        assert done.returncode == 2 and "cannot be written" in done.stderr
    finally:
        if mounted:
            subprocess.run(["umount", "-l", str(out)], check=True)
        else:
            out.chmod(0o700)


SPIN_DATA = {
    "robot": {"rigid_body": {"mass": 1.0, "inertia": [1.0, 1.0, 1.0]}},
    "simulation": {"duration": 0.1},
}


def test_a_reader_never_sees_a_mixture_of_two_runs(tmp_path: Path) -> None:
    """One process repeatedly replaces the run of a folder while another reads it."""
    program = """
import sys, time, onorbit_rs as oo, onorbit_rs.simulation.finish as keeping
keeping.write_pictures = lambda *_, **__: None
body = {"mass": 1.0, "inertia": [1.0, 1.0, 1.0]}
for number in range(30):
    spin = {"robot": {"rigid_body": body}, "initial": {"angular_velocity": [0, 0, 0.1 + 0.01 * number]},
            "name": f"run {number}", "simulation": {"duration": 0.05, "time_step": 0.01}}
    oo.run(spin, sys.argv[1], force=True, quiet=True)
    time.sleep(0.01)  # on a busy machine, the reader would otherwise see few of the runs
"""
    from onorbit_rs.exceptions import OnOrbitError
    from onorbit_rs.output.read import SavedRun

    writer = subprocess.Popen([sys.executable, "-c", program, str(tmp_path / "out")])
    seen, refused = set(), 0
    try:
        while writer.poll() is None:
            try:
                saved = SavedRun(tmp_path / "out")
                summary, scenario, trace = saved.summary(), saved.scenario(), saved.trace()
            except OnOrbitError:
                refused += 1
                continue
            number = int(summary["scenario"].split()[1])
            assert scenario.name == f"run {number}"
            assert np.asarray(trace.v)[0, 5] == pytest.approx(0.1 + 0.01 * number, abs=1e-12)
            seen.add(number)
    finally:
        writer.kill()
        writer.wait()
    assert writer.returncode == 0
    assert len(seen) > 3, f"{refused} refused"


def test_runs_killed_at_random_instants_resume_with_the_same_bits(tmp_path: Path) -> None:
    """A short version of the kills of ``make soak``."""
    found = kill_campaign(tmp_path, kills=2, seed=14, duration=1.0)
    assert found.kills == 2 and found.wrong == [], found
    assert found.same_bits >= 1


def test_a_limit_of_file_sizes_is_an_error_of_the_folder(tmp_path: Path) -> None:
    said = r"cannot write .*summary\.json: File too large"
    with (
        pytest.raises(OutputFolderError, match=said),
        OutputFolder.claim(tmp_path) as folder,
        folder.writing("summary.json"),
    ):
        raise OSError(27, "File too large")
    assert not list(tmp_path.iterdir())


def test_rows_that_a_watched_run_could_not_write_are_written_later() -> None:
    """The viewer receives every row once; rows are not lost if the writer fails."""

    class Stepper:
        rows = 0

        def checkpoint(self, since: int) -> oo.Checkpoint:
            self.rows += 1
            return oo.Checkpoint("{}", {"time": np.arange(float(since), self.rows)[:, None]})

    written: list[list[float]] = []
    answers = iter([False, False, True, True])

    def writer(checkpoint: oo.Checkpoint) -> bool:
        written.append(checkpoint.columns["time"].ravel().tolist())
        return next(answers)

    saver, stepper = _Saver(writer, 0.0, 0), Stepper()  # type: ignore[arg-type]
    for _ in range(4):
        saver.save_if_due(stepper)  # type: ignore[arg-type]
    assert written == [[0.0], [0.0, 1.0], [0.0, 1.0, 2.0], [3.0]]


@pytest.mark.skipif(not Path("/proc/self/fd").is_dir(), reason="only Linux lists the names of open files")
def test_results_are_on_the_disk_before_the_checkpoint_is_removed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    events: list[str] = []
    fsync = os.fsync

    def observed_fsync(descriptor: int) -> None:
        events.append(Path(f"/proc/self/fd/{descriptor}").readlink().name.rpartition("-")[2])
        fsync(descriptor)

    monkeypatch.setattr(os, "fsync", observed_fsync)
    monkeypatch.setattr(OutputFolder, "discard_checkpoint", lambda folder: events.append("removed"))
    oo.run(tumbling(0.1), tmp_path / "out", quiet=True)
    results = events[events.index("trace.npz") :]
    assert results == ["trace.npz", "summary.json", "manifest.json", "out", "removed"], events
