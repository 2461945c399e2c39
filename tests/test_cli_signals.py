"""SIGTERM and SIGHUP end a command like Ctrl-C; it reports which results are complete and how to resume."""

from __future__ import annotations

import _thread
import json
import os
import pty
import select
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from commands import SPIN, onorbit

import onorbit_rs as oo
from onorbit_rs.cli.signals import ending_signals
from onorbit_rs.common.progress import Progress
from onorbit_rs.scenario import load

pytestmark = pytest.mark.skipif(os.name != "posix", reason="sends SIGTERM and SIGHUP")


ANNOUNCES_START = """
import contextlib, pathlib
from onorbit_rs import cli
from onorbit_rs.simulation import finish
from onorbit_rs.common import progress
from onorbit_rs.simulation import run

real = run.progress_bar

@contextlib.contextmanager
def bar(*given, **options):
    with real(*given, **options) as drawn:
        def move(t, duration):
            pathlib.Path("in_the_loop").touch()
            if drawn.move is not None:
                drawn.move(t, duration)
        yield progress.Progress(move, drawn.tell)

run.progress_bar = bar
finish.write_pictures = lambda *_, **__: None
cli.main()
"""
"""A command without figures that writes a file once its simulation loop runs."""


def run_in_the_background(tmp_path: Path, duration: str, **streams: Any) -> subprocess.Popen[str]:
    """Starts a run with a long checkpoint interval, so that only the checkpoint at its stop is written."""
    file = tmp_path / "mine.yaml"
    file.write_text(SPIN.replace("duration: 0.1 s", f"duration: {duration}, record_every: 1000"))
    command = [sys.executable, "-c", ANNOUNCES_START, "run", str(file), "--out", str(tmp_path / "out")]
    return subprocess.Popen(
        [*command, "--checkpoint-every", "1000"], stdout=subprocess.PIPE, text=True, cwd=tmp_path, **streams
    )


def wait_until_it_runs(tmp_path: Path, run: subprocess.Popen[str]) -> None:
    deadline = time.monotonic() + 60.0
    while not (tmp_path / "in_the_loop").exists():
        assert run.poll() is None and time.monotonic() < deadline
        time.sleep(0.02)


@pytest.fixture
def hangups_are_heard() -> Iterator[None]:
    """Restores SIGHUP: under ``nohup`` the tests, and their child processes, would ignore it."""
    before = signal.signal(signal.SIGHUP, signal.SIG_DFL)
    yield
    signal.signal(signal.SIGHUP, before)


def test_sigterm_writes_a_last_checkpoint_and_says_how_to_resume(tmp_path: Path) -> None:
    with run_in_the_background(tmp_path, "100 h", stderr=subprocess.PIPE) as run:
        wait_until_it_runs(tmp_path, run)
        run.send_signal(signal.SIGTERM)
        run.send_signal(signal.SIGTERM)  # the output begun after the first signal continues
        _, stderr = run.communicate(timeout=60)
    out = tmp_path / "out"
    assert run.returncode == 143, stderr
    assert stderr.startswith("onorbit: stopped by SIGTERM at t = ") and len(stderr.splitlines()) == 1
    assert f"continue with: onorbit resume {out}" in stderr
    record = json.loads((out / "checkpoint" / "state.json").read_text())
    with np.load(out / "trace.npz") as stored:
        rows = record["columns"]["time"]["rows"]
        assert 0 < rows in (len(stored["time"]) - 1, len(stored["time"]))  # the time of the stop
    assert json.loads((out / "summary.json").read_text())["status"] == "interrupted"


def test_a_closed_terminal_leaves_a_last_checkpoint(tmp_path: Path, hangups_are_heard: None) -> None:
    """Neither the progress bar nor messages can be printed."""
    ours, theirs = pty.openpty()
    run = run_in_the_background(tmp_path, "100 h", stderr=theirs, stdin=theirs, start_new_session=True)
    os.close(theirs)
    stopped = threading.Event()
    reader = threading.Thread(target=read_all, args=(ours, stopped))
    reader.start()
    with run:
        wait_until_it_runs(tmp_path, run)
        stopped.set()
        reader.join()
        os.close(ours)  # from here on, all output fails
        run.send_signal(signal.SIGHUP)
        run.communicate(timeout=60)
    assert run.returncode == 129
    assert (tmp_path / "out" / "checkpoint" / "state.json").is_file()
    assert (tmp_path / "out" / "trace.npz").is_file()


def test_signal_handlers_are_restored_and_ignored_signals_stay_ignored() -> None:
    before = signal.getsignal(signal.SIGTERM), signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with ending_signals():
            assert signal.getsignal(signal.SIGHUP) == signal.SIG_IGN  # nohup
            with pytest.raises(KeyboardInterrupt, match="SIGTERM"):
                signal.raise_signal(signal.SIGTERM)
            signal.raise_signal(signal.SIGTERM)  # a second signal at once does not interrupt the output
        assert signal.getsignal(signal.SIGTERM) == before[0]
    finally:
        signal.signal(signal.SIGHUP, before[1])


def test_other_threads_do_not_change_signal_handlers() -> None:
    seen: list[Any] = []

    def elsewhere() -> None:
        with ending_signals():
            seen.append(signal.getsignal(signal.SIGTERM))

    thread = threading.Thread(target=elsewhere)
    thread.start()
    thread.join()
    assert seen == [signal.getsignal(signal.SIGTERM)] == [signal.SIG_DFL]


def interrupted_while(monkeypatch: pytest.MonkeyPatch, step: str) -> None:
    def pressed(*_: Any, **__: Any) -> None:
        _thread.interrupt_main()
        time.sleep(1.0)

    monkeypatch.setattr(f"onorbit_rs.simulation.finish.{step}", pressed)


def test_ctrl_c_while_figures_are_drawn_reports_the_complete_files(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    interrupted_while(monkeypatch, "write_pictures")
    (tmp_path / "mine.yaml").write_text(SPIN)
    done = onorbit("run", "mine.yaml", "--out", "out", cwd=tmp_path)
    assert done.returncode == 130 and len(done.stderr.splitlines()) == 1
    assert "trace and summary in out are complete" in done.stderr and "--force" not in done.stderr
    command = done.stderr.split("draw the figures with: onorbit ")[1].split()
    with np.load(tmp_path / "out" / "trace.npz") as stored:
        assert len(stored["time"]) == 11
    assert json.loads((tmp_path / "out" / "summary.json").read_text())["status"] == "complete"
    monkeypatch.undo()
    assert onorbit(*command, cwd=tmp_path).returncode == 0
    assert list((tmp_path / "out" / "figures").glob("*.pdf"))


def test_ctrl_c_while_the_trace_is_written_reports_that_it_is_incomplete(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    interrupted_while(monkeypatch, "write_trace")
    (tmp_path / "mine.yaml").write_text(SPIN)
    done = onorbit("run", "mine.yaml", "--out", "out", cwd=tmp_path)
    assert done.returncode == 130
    assert "the results in out are incomplete; repeat the run with --force" in done.stderr


def test_a_second_ctrl_c_stops_drawing_the_figures_of_an_interrupted_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    interrupted_while(monkeypatch, "write_pictures")
    data = load("humanoid_reach").resolved()
    data["simulation"] |= {"duration": 1000.0, "time_step": 1e-4, "record_every": 100}

    @contextmanager
    def pressed(*_: Any, **__: Any) -> Iterator[Progress]:
        yield Progress(lambda t, duration: _thread.interrupt_main())

    monkeypatch.setattr("onorbit_rs.simulation.run.progress_bar", pressed)
    with pytest.raises(
        oo.exceptions.RunInterrupted, match=r"onorbit resume .*draw them with: onorbit report"
    ):
        oo.run(data, tmp_path / "out", quiet=True)
    assert (tmp_path / "out" / "checkpoint" / "state.json").is_file()


def read_all(terminal: int, stopped: threading.Event) -> None:
    """Reads the terminal, since writing blocks if nobody reads."""
    while not stopped.is_set():
        if select.select([terminal], [], [], 0.05)[0]:
            os.read(terminal, 65536)
