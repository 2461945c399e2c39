"""Locks permit one writer per folder; two writers once mixed the files of two runs."""

from __future__ import annotations

import json
import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from commands import SPIN, refusal

import onorbit_rs as oo
from onorbit_rs.common.files import exists
from onorbit_rs.exceptions import NotFoundError, OutputFolderError, OutputInUseError
from onorbit_rs.output import CheckpointWriter, lock
from onorbit_rs.output.folder import OutputFolder
from onorbit_rs.output.lock import LOCK, FolderLock, owner_of

HOLDS = """
import sys, time
from onorbit_rs.output.folder import OutputFolder
folder = OutputFolder.claim(sys.argv[1])
path = folder.temporary("trace.npz")
path.write_bytes(b"half")
print("locked", flush=True)
time.sleep(60)
"""


WAITS = """
import pathlib, sys, time
from onorbit_rs.simulation import finish
from onorbit_rs.cli import main

def wait(*_, **__):
    deadline = time.monotonic() + 60.0
    while not pathlib.Path("go").exists() and time.monotonic() < deadline:
        time.sleep(0.02)

finish.write_pictures = wait
main(sys.argv[1:])
"""
"""A command that keeps its folder locked, after writing the trace, until a file exists."""


@pytest.fixture
def holder(tmp_path: Path) -> Any:
    """Starts another process that writes the folder."""
    process = subprocess.Popen(
        [sys.executable, "-c", HOLDS, str(tmp_path / "out")], stdout=subprocess.PIPE, text=True
    )
    assert process.stdout is not None and process.stdout.readline() == "locked\n"
    yield process
    process.kill()
    process.communicate()


def test_a_second_command_names_the_writing_process_until_it_is_killed(tmp_path: Path, holder: Any) -> None:
    (tmp_path / "mine.yaml").write_text(SPIN)
    for force in ((), ("--force",)):
        said = refusal("run", tmp_path / "mine.yaml", "--out", tmp_path / "out", *force)
        assert f"out is in use by process {holder.pid} on " in said and "(-c " in said and "since 20" in said
    with pytest.raises(OutputInUseError) as caught:
        OutputFolder.claim(tmp_path / "out")
    assert isinstance(caught.value, BlockingIOError) and caught.value.pid == holder.pid
    assert caught.value.command.startswith("-c ") and caught.value.since.startswith("20")
    with pytest.raises(NotFoundError, match=rf"process {holder.pid} on .* is writing it"):
        oo.compare(tmp_path / "out")
    out = tmp_path / "out"  # the lock ends with its process, and partial files are removed
    assert owner_of(out) is not None and list(out.glob(".partial-*"))
    holder.kill()
    holder.wait()
    assert owner_of(out) is None and (out / LOCK).is_file()
    with OutputFolder.claim(out):
        assert [file.name for file in out.iterdir()] == [LOCK]
    assert not list(out.iterdir())


def test_two_simultaneous_runs_leave_the_first_one_complete(tmp_path: Path) -> None:
    """Once both ended with exit code 0, with the numbers of one in the folder of the other."""
    for name, rate in (("a", 0.1), ("b", 0.7)):
        text = SPIN.replace("0.1, 0.2, 0.3", f"0, 0, {rate}")
        (tmp_path / f"{name}.yaml").write_text(text)

    def started(name: str, *options: str) -> subprocess.Popen[str]:
        command = [sys.executable, "-c", WAITS, "run", f"{name}.yaml", "-q", "--out", "out", *options]
        return subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.PIPE, text=True)

    with started("a") as first:
        deadline = time.monotonic() + 60.0
        while owner_of(tmp_path / "out") is None:
            assert first.poll() is None and time.monotonic() < deadline
            time.sleep(0.05)
        with started("b", "--force") as second:
            said = second.communicate(timeout=60)[1]
        assert second.returncode == 2 and f"out is in use by process {first.pid} on " in said
        (tmp_path / "go").touch()
        said = first.communicate(timeout=60)[1]
    assert (first.returncode, said) == (0, "")
    again = oo.run(tmp_path / "a.yaml", quiet=True)
    assert oo.compare(tmp_path / "out", again, tolerance=1e-300).agrees


def test_two_threads_exclude_each_other_like_two_processes(tmp_path: Path) -> None:
    results: list[str] = []
    with OutputFolder.claim(tmp_path):

        def second() -> None:
            try:
                OutputFolder.claim(tmp_path).close()
            except OutputInUseError as error:
                results.append(f"{error.pid}")

        thread = threading.Thread(target=second)
        thread.start()
        thread.join()
    assert results == [str(os.getpid())]
    OutputFolder.claim(tmp_path).close()


@pytest.mark.skipif(not hasattr(os, "fork"), reason="the system has no fork")
def test_a_forked_child_does_not_keep_the_lock(tmp_path: Path) -> None:
    """A pool of workers that outlived its parent once kept the lock."""
    held = FolderLock(tmp_path)
    child = os.fork()
    if child == 0:
        held.release()  # it does not own the inherited lock
        time.sleep(30)
        os._exit(0)
    try:
        assert owner_of(tmp_path) is not None and exists(tmp_path / LOCK)
        os.close(held._descriptor)  # as at the end of the parent
        lock._held.discard(held._descriptor)
        FolderLock(tmp_path).release()
    finally:
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)


def _race(folder: str, counter: Any, wins: Any) -> None:
    for _ in range(30):
        try:
            taken = FolderLock(Path(folder))
        except OutputInUseError:
            continue
        with counter.get_lock():
            counter.value += 1
            wins.value += counter.value == 1
        with counter.get_lock():
            counter.value -= 1
        taken.release()


def test_a_lock_whose_file_is_removed_and_recreated_has_one_owner(tmp_path: Path) -> None:
    context = multiprocessing.get_context("spawn")
    counter, wins = context.Value("i", 0), context.Value("i", 0)
    workers = [context.Process(target=_race, args=(str(tmp_path), counter, wins)) for _ in range(2)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join(60)
        assert worker.exitcode == 0
    assert counter.value == 0 and wins.value >= 15, "two owners held the lock at the same time"
    assert not list(tmp_path.iterdir())


def test_a_lock_that_is_a_symbolic_link_is_not_written_through(tmp_path: Path) -> None:
    precious = tmp_path / "precious.txt"
    precious.write_text("precious")
    for plant in ("symlink_to", "hardlink_to"):
        out = tmp_path / plant
        out.mkdir()
        getattr(out / LOCK, plant)(precious)
        with pytest.raises(OutputFolderError, match="cannot be written"):
            OutputFolder.claim(out)
        assert precious.read_text() == "precious"


def test_the_text_of_an_unknown_lock_is_escaped(tmp_path: Path) -> None:
    for said in ("", "nonsense", "[" * 10_000, json.dumps({"pid": "x"})):
        (tmp_path / LOCK).write_text(said)
        OutputFolder.claim(tmp_path).close()
    assert "\x1b" not in str(lock.Owner(1, "host", "rm \x1b[31m", "today", ""))


def test_a_folder_that_cannot_be_locked_is_written_with_a_warning(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Some network file systems have no locks."""

    def refused(descriptor: int, *, is_shared: bool) -> None:
        raise OSError(38, "Function not implemented")

    monkeypatch.setattr(lock, "_lock", refused)
    with pytest.warns(UserWarning, match="cannot be locked"):
        OutputFolder.claim(tmp_path).close()


def test_a_lock_whose_file_was_removed_by_hand_is_recreated(tmp_path: Path) -> None:
    """A second command could once start, and both wrote the folder."""
    with OutputFolder.claim(tmp_path) as folder:
        (tmp_path / LOCK).unlink()
        with (
            pytest.warns(UserWarning, match=f"{LOCK} was removed during the run"),
            folder.writing("scenario.yaml") as path,
        ):
            path.write_text("mine")
        assert owner_of(tmp_path) is not None
        with pytest.raises(OutputInUseError):
            OutputFolder.claim(tmp_path, force=True)
        with folder.writing("summary.json") as path:
            path.write_text("mine")
    assert not (tmp_path / LOCK).exists()


def test_a_process_that_lost_the_lock_writes_nothing(tmp_path: Path) -> None:
    with OutputFolder.claim(tmp_path) as first:
        with first.writing("scenario.yaml") as path:
            path.write_text("first")
        (tmp_path / LOCK).unlink()
        with OutputFolder.claim(tmp_path, force=True) as second:
            with second.writing("scenario.yaml") as path:
                path.write_text("the second")
            _writes_nothing(first, "is in use by process")
        assert not (tmp_path / LOCK).exists()
        _writes_nothing(first, "now contains files of another run")
    assert (tmp_path / "scenario.yaml").read_text() == "the second"
    assert {file.name for file in tmp_path.iterdir()} == {"scenario.yaml", "manifest.json"}


def _writes_nothing(folder: OutputFolder, why: str) -> None:
    checkpoint = CheckpointWriter(folder, "digest")
    for write in (
        lambda: folder.writing("summary.json").__enter__(),
        lambda: checkpoint(oo.Checkpoint("{}", {"q": np.zeros((1, 3))})),
        folder.discard,
    ):
        with pytest.raises(OutputInUseError, match=why):
            write()
    folder.discard_checkpoint()


def test_a_run_that_lost_the_lock_stops_at_the_next_checkpoint(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It could not save its results at the end."""
    others: list[OutputFolder] = []
    write = CheckpointWriter._write

    def taken(writer: CheckpointWriter, checkpoint: oo.Checkpoint) -> None:
        if not others:
            (tmp_path / LOCK).unlink()
            others.append(OutputFolder.claim(tmp_path, force=True))
        write(writer, checkpoint)

    monkeypatch.setattr(CheckpointWriter, "_write", taken)
    body = {"mass": 1.0, "inertia": [1.0, 2.0, 3.0]}
    spin = {
        "robot": {"rigid_body": body},
        "simulation": {"duration": 1e5, "time_step": 1e-3, "record_every": 10**6},
    }
    with pytest.raises(OutputInUseError, match="is in use by process"):
        oo.run(spin, tmp_path, quiet=True, checkpoint_every=0.0)
    others[0].close()
    assert not list(tmp_path.iterdir())
