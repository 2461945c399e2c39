"""The viewer's process: it listens only on this machine, and its start failures are explained."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from results import listed

import onorbit_rs as oo
from onorbit_rs.exceptions import ViewerError
from onorbit_rs.scenario import load
from onorbit_rs.viewer import screen

on_linux = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="only Linux has DISPLAY")
HELP = "save a picture with: onorbit show"


@pytest.fixture
def broken_display(monkeypatch: pytest.MonkeyPatch) -> None:
    """Sets a DISPLAY at which no server answers."""
    monkeypatch.setenv("DISPLAY", ":7777")
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Returns the folder of a run with a recording that is not opened."""
    out = tmp_path_factory.mktemp("show")
    (out / "summary.json").write_text(json.dumps(oo.run(short(), quiet=True).summary))
    (out / "run.rrd").touch()
    return listed(out)


def short() -> dict[str, Any]:
    data = load("humanoid_reach").resolved()
    data["simulation"] |= {"duration": 0.1}
    return data


def onorbit(*arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
    known = {name: text for name, text in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
    command = [sys.executable, "-m", "onorbit_rs", *arguments]
    return subprocess.run(command, env=known | environment, capture_output=True, text=True, check=False)


@on_linux
@pytest.mark.usefixtures("broken_display")
def test_a_broken_display_raises_an_error_with_the_reason(folder: Path) -> None:
    with pytest.raises(ViewerError, match="the viewer did not start: ") as caught:
        screen.open_recording(folder / "run.rrd")
    assert caught.value.reason and "/" not in caught.value.reason  # no location in the viewer's code
    assert isinstance(caught.value, RuntimeError)
    with pytest.raises(ViewerError):
        screen.open_viewer()


@on_linux
def test_show_reports_it_in_one_line_with_a_fix(folder: Path) -> None:
    done = onorbit("show", str(folder), DISPLAY=":7777")
    assert done.returncode == 2
    (line,) = done.stderr.splitlines()
    assert line.startswith("onorbit: the viewer did not start: ") and f"{HELP} {folder} --picture" in line


@on_linux
def test_show_without_a_screen_suggests_a_fix(folder: Path) -> None:
    done = onorbit("show", str(folder))
    assert done.returncode == 0 and not done.stderr
    assert "no display is available; " in done.stdout and HELP in done.stdout


@on_linux
@pytest.mark.usefixtures("broken_display")
def test_a_run_continues_without_a_viewer_that_does_not_start() -> None:
    with pytest.warns(
        UserWarning, match="the viewer did not start: .*; the run continues without the viewer"
    ):
        assert oo.run(short(), quiet=True, view=True).trace.is_complete


def test_the_viewer_listens_only_on_this_machine(monkeypatch: pytest.MonkeyPatch) -> None:
    commands = []

    class Process:
        def poll(self) -> int:
            return 1

        def kill(self) -> None: ...

        def wait(self) -> None: ...

    def popen(command: list[str], **_: object) -> Process:
        commands.append(command)
        return Process()

    monkeypatch.setattr(screen.subprocess, "Popen", popen)
    for start in (screen.open_viewer, lambda: screen.open_recording(Path("run.rrd"))):
        with pytest.raises(ViewerError, match="did not start: it printed no reason"):  # it exited at once
            start()
    assert len(commands) == 2
    for command in commands:
        assert Path(command[0]).is_file()
        assert command[command.index("--bind") + 1] == "127.0.0.1"
    assert screen.url_of(9876) == "rerun+http://127.0.0.1:9876/proxy"


def viewer_that_hangs(monkeypatch: pytest.MonkeyPatch) -> list[subprocess.Popen[bytes]]:
    """Replaces the viewer by a program that does not respond; the list receives its process."""
    started = []
    popen = subprocess.Popen

    def start(command: list[str], **options: Any) -> subprocess.Popen[bytes]:
        started.append(popen([sys.executable, "-c", "import time; time.sleep(60)"], **options))
        return started[0]

    monkeypatch.setattr(screen.subprocess, "Popen", start)
    return started


def test_waiting_for_a_viewer_that_hangs_is_limited(monkeypatch: pytest.MonkeyPatch) -> None:
    started = viewer_that_hangs(monkeypatch)
    monkeypatch.setattr(screen, "START_PATIENCE_S", 0.2)
    with pytest.raises(
        ViewerError, match=r"did not start: it did not respond within 0\.2 s; check that 'rerun' opens"
    ):
        screen.open_viewer()
    assert started[0].returncode is not None  # terminated, and not a zombie


def test_ctrl_c_terminates_the_viewer(monkeypatch: pytest.MonkeyPatch) -> None:
    started = viewer_that_hangs(monkeypatch)

    def ctrl_c(port: int) -> bool:
        raise KeyboardInterrupt

    monkeypatch.setattr(screen, "listens", ctrl_c)
    with pytest.raises(KeyboardInterrupt):
        screen.open_viewer()
    assert started[0].returncode is not None


GONE = """
import os, socket, threading, time
from onorbit_rs.viewer import screen
import rerun as rr

def hang_up():
    while True:
        peer, _ = server.accept()
        peer.recv(100)
        peer.close()

server = socket.create_server(("127.0.0.1", 0))
threading.Thread(target=hang_up, daemon=True).start()
recording = rr.RecordingStream("onorbit", send_properties=False)
recording.connect_grpc(screen.url_of(server.getsockname()[1]))
recording.log("a", rr.Scalars([1.0]))
try:
    recording.flush(timeout_sec=5.0)
except Exception:
    print("said", flush=True)
time.sleep(1.0)  # the log is printed by another thread
os._exit(0)  # to disconnect would be to wait for nobody
"""


def test_rerun_prints_no_log() -> None:
    both = [
        subprocess.Popen(
            [sys.executable, "-c", GONE],
            env={name: text for name, text in os.environ.items() if name != "RUST_LOG"} | log,
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        )
        for log in ({}, {"RUST_LOG": "error"})
    ]  # fmt: skip
    quiet, loud = (process.communicate() for process in both)
    assert quiet == ("said\n", "")
    assert loud[0] == "said\n" and "ERROR" in loud[1]  # it can be turned on
