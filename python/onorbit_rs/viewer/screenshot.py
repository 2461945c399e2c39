"""A picture of a recording without a screen, from a viewer that listens to this machine alone.

``onorbit show out --picture picture.png --at 1``

Needs a Vulkan driver; Debian's ``mesa-vulkan-drivers`` and ``libegl1`` draw in software.
"""

from __future__ import annotations

import os
import socket
import subprocess
import time
from pathlib import Path

import rerun_cli  # type: ignore[import-untyped]  # ships no types
from rerun.experimental import ViewerClient

from onorbit_rs.exceptions import NotFoundError, OnOrbitError

SETTLE_S = 3.0
"""Wall-clock time given to the viewer to load fonts and draw, before and after moving in time."""


def take_screenshot(
    recording: Path, picture: Path, *, at_s: float = 0.0, width: int = 1920, height: int = 1080
) -> Path:
    """Open a ``.rrd`` headless, go to a time and save what the viewer shows.

    Parameters
    ----------
    recording : Path
        A ``run.rrd``.
    picture : Path
        The PNG to write.
    at_s : float
        Time of simulation, s.
    width, height : int
        Of the window, pixels.

    Raises
    ------
    NotFoundError
        No such recording.
    OnOrbitError
        The viewer did not start; says what it printed.
    """
    if not recording.is_file():
        raise NotFoundError(f"no such recording: {recording}", path=str(recording), kind="recording")
    port = _free_port()
    command = [
        *(str(Path(rerun_cli.__file__).with_name("rerun")), "--headless", "--hide-welcome-screen"),
        *("--bind", "127.0.0.1", "--port", str(port), "--window-size", f"{width}x{height}"),
        str(recording.resolve()),
    ]
    environment = os.environ | {"RERUN_APP_ONLY": "true", "RUST_LOG": "error"}
    with subprocess.Popen(
        command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
    ) as viewer:
        try:
            client = _connect(port, viewer)
            time.sleep(SETTLE_S)
            client.set_time("simulation_time", duration=at_s, play_state="paused")
            time.sleep(SETTLE_S)
            picture.write_bytes(client.take_screenshot())
        finally:
            viewer.kill()
    return picture


def _connect(port: int, viewer: subprocess.Popen[str], patience_s: float = 30.0) -> ViewerClient:
    """A client of the viewer, once it listens."""
    deadline = time.monotonic() + patience_s
    while time.monotonic() < deadline and viewer.poll() is None:
        with socket.socket() as probe:
            if probe.connect_ex(("127.0.0.1", port)) == 0:
                return ViewerClient.connect(f"rerun+http://127.0.0.1:{port}/proxy")
        time.sleep(0.1)
    viewer.kill()
    printed = (viewer.stderr.read() if viewer.stderr else "").strip().splitlines()
    raise OnOrbitError(
        f"the headless viewer did not start: {printed[-1] if printed else 'it printed nothing'}"
    )


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])
