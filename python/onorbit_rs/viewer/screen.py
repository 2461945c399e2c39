"""The viewer on a screen, in a process of its own that listens to this machine alone."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import time
from pathlib import Path

START_PATIENCE_S = 20.0
"""Wall-clock time given to the viewer to start."""

_LOCAL = "127.0.0.1"


def has_screen() -> bool:
    """Whether a window can be opened here."""
    on_linux = sys.platform.startswith("linux")
    return not on_linux or bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


def open_recording(recording: Path) -> None:
    """Open a ``.rrd`` and return at once; the viewer outlives this process."""
    _start("--port", "auto", str(recording))


def open_viewer(*options: str) -> str | None:
    """Start a viewer that waits for rows, and return where it does; None where it does not start."""
    port = free_port()
    viewer = _start("--port", str(port), "--expect-data-soon", *options)
    deadline = time.monotonic() + START_PATIENCE_S
    while time.monotonic() < deadline and viewer.poll() is None:
        if listens(port):
            return url_of(port)
        time.sleep(0.05)
    viewer.kill()
    return None


def url_of(port: int) -> str:
    """What a client connects to."""
    return f"rerun+http://{_LOCAL}:{port}/proxy"


def listens(port: int) -> bool:
    """Whether something does at this port of this machine."""
    with socket.socket() as probe:
        return probe.connect_ex((_LOCAL, port)) == 0


def free_port() -> int:
    """One that nothing listens at."""
    with socket.socket() as probe:
        probe.bind((_LOCAL, 0))
        return int(probe.getsockname()[1])


def _start(*arguments: str) -> subprocess.Popen[bytes]:
    command = [sys.executable, "-m", "rerun_cli", "--bind", _LOCAL, *arguments]
    return subprocess.Popen(
        command, start_new_session=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
