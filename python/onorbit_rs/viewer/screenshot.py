"""A picture of a recording without a screen, from a viewer that listens to this machine alone.

``onorbit show out --picture picture.png --at 1``

Needs a Vulkan driver; Debian's ``mesa-vulkan-drivers`` and ``libegl1`` draw in software.
"""

from __future__ import annotations

import subprocess
import time
from pathlib import Path

from rerun.experimental import ViewerClient

from onorbit_rs.exceptions import NotFoundError, ViewerError
from onorbit_rs.viewer.rows import TIMELINE
from onorbit_rs.viewer.screen import command_of, environment, free_port, listens, reason, url_of

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
    ViewerError
        The viewer did not start; says why.
    """
    if not recording.is_file():
        raise NotFoundError(f"no such recording: {recording}", path=str(recording), kind="recording")
    port = free_port()
    command = [
        *command_of(port),
        "--headless",
        "--hide-welcome-screen",
        *("--window-size", f"{width}x{height}", str(recording.resolve())),
    ]
    with subprocess.Popen(
        command, env=environment(), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
    ) as viewer:
        try:
            client = _connect(port, viewer)
            time.sleep(SETTLE_S)
            _go_to(client, at_s)
            time.sleep(SETTLE_S)
            picture.write_bytes(client.take_screenshot())
        finally:
            viewer.kill()
    return picture


def _go_to(client: ViewerClient, at_s: float, patience_s: float = 60.0) -> None:
    """Move to a time, once the recording has been read."""
    deadline = time.monotonic() + patience_s
    while True:
        try:
            client.set_time(TIMELINE, duration=at_s, play_state="paused")
            return
        except OSError as error:  # no recording yet
            if time.monotonic() > deadline:
                raise ViewerError(
                    f"the viewer does not show the recording: {error}", reason=str(error)
                ) from error
            time.sleep(0.2)


def _connect(port: int, viewer: subprocess.Popen[str], patience_s: float = 30.0) -> ViewerClient:
    """A client of the viewer, once it listens."""
    deadline = time.monotonic() + patience_s
    while time.monotonic() < deadline and viewer.poll() is None:
        if listens(port):
            return ViewerClient.connect(url_of(port))
        time.sleep(0.1)
    viewer.kill()
    why = reason(viewer.stderr.read() if viewer.stderr else "")
    raise ViewerError(
        f"the headless viewer did not start: {why}; it needs a Vulkan driver "
        "(Debian: mesa-vulkan-drivers and libegl1)",
        reason=why,
    )
